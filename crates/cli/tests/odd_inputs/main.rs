//! Odd inputs: damaged, contradictory, hostile and merely unusual files, each created here and opened by the program itself.
//!
//! Each is a separate trial: with little memory and little time the program must open the file or reject it with one paragraph
//! that names it. What opens must also render. `cargo test -p lightmesh-cli --test odd_inputs -- ply` runs those of one format.

mod files;
mod glb;
mod gltf;
mod grid;
mod input;
mod obj;
mod ply;
mod run;
mod stl;
mod texture;
mod toml;

use std::process::ExitCode;

use libtest_mimic::Arguments;

fn main() -> ExitCode {
    let formats = [
        obj::inputs(),
        ply::inputs(),
        stl::inputs(),
        gltf::inputs(),
        glb::inputs(),
        toml::inputs(),
        texture::inputs(),
        grid::inputs(),
    ];
    let inputs = formats.into_iter().flatten().chain(files::inputs());
    libtest_mimic::run(&Arguments::from_args(), inputs.map(run::trial).collect()).exit_code()
}
