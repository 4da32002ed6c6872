//! `lightmesh completions`.

use crate::args::{self, CompletionsArgs};
use crate::failure::Failure;
use crate::output;

pub(super) fn run(asked: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(asked.shell, &mut args::command(), "lightmesh", &mut script);
    Ok(output::print(&String::from_utf8_lossy(&script))?)
}
