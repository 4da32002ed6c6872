//! The program `lightmesh`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(lightmesh_cli::run_command(std::env::args_os()))
}
