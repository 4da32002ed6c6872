//! One file per subcommand.

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "bench")]
mod bench_compare;
mod compare;
mod completions;
mod export;
pub(crate) mod farm;
mod grid;
mod info;
mod man;
mod open;
mod render;
#[cfg(feature = "bench")]
mod report;
mod serve;

use lightmesh::Scene;

use crate::args::Command;
use crate::failure::Failure;
use crate::output;

/// Runs the subcommand; returns the exit code.
pub(crate) fn run(command: Command) -> Result<u8, Failure> {
    match command {
        Command::Render(args) => return render::run(&args),
        Command::Serve(args) => serve::run(&args),
        Command::Farm(args) => farm::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Grid(args) => grid::run(&args),
        Command::Export(args) => export::run(&args),
        #[cfg(feature = "bench")]
        Command::Bench(args) => bench::run(&args),
        #[cfg(feature = "bench")]
        Command::Report(args) => report::run(&args),
        Command::Schema => output::print(&Scene::file_schema()).map_err(Failure::from),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }?;
    Ok(0)
}
