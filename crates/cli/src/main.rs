//! The program `lightmesh`.

use std::process::ExitCode;

/// Whether standard output is closed can be seen only before the runtime starts.
#[cfg(unix)]
#[ctor::ctor(unsafe)]
fn before_main() {
    lightmesh_files::look_at_output();
}

fn main() -> ExitCode {
    ExitCode::from(lightmesh_cli::run_command(std::env::args_os()))
}
