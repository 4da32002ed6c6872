//! One file per subcommand.

mod bench;
mod bench_compare;
mod compare;
mod completions;
mod export;
mod exposure;
mod film;
mod grid;
mod info;
mod man;
mod mesh_file;
mod movie;
mod open;
mod range;
mod render;
mod report;
mod sun;
mod sun_hours;

pub(crate) use exposure::{Metering, exposure};
use lightmesh::Scene;
pub(crate) use movie::MovieError;
pub(crate) use open::read_options;
pub(crate) use render::describe;

use crate::args::Command;
use crate::failure::Failure;
use crate::output;

/// What messages call the construction of an acceleration structure.
const BUILDING: &str = "building the acceleration structure";

/// Runs the subcommand; returns the exit code.
pub(crate) fn run(command: Command) -> Result<u8, Failure> {
    match command {
        Command::Render(args) => render::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Grid(args) => grid::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Schema => output::print(&Scene::file_schema()).map_err(Failure::from),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }?;
    Ok(0)
}
