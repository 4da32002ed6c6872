//! `lightmesh`: the light mesh method on the command line.
//!
//! `args` (as typed) ▶ `run` (the work, here or on a `server`) ▶ exit code, in one direction. What a picture of a file is, and the work on it, is in the library:
//! [`lightmesh::request`]. Anything that goes wrong is a `Failure`, which knows its exit code. Results go to standard output; notes, progress and
//! errors go to standard error.
//!
//! It is a library so that other programs can contain the command line ([`run_command`]).

mod args;
mod budget;
mod color;
mod failure;
mod flags;
mod interrupt;
mod job;
mod memory;
mod output;
mod progress;
mod report;
mod run;
mod server;

use std::ffi::OsString;
use std::panic;

use clap::FromArgMatches;
use clap::builder::Styles;
use lightmesh::request::Order;

use crate::args::{Cli, Command};
use crate::failure::{Failure, UNABLE};
use crate::report::{failed, forget_fault, report_fault};

/// Runs the program with these arguments, the first of which is its name; returns the exit code. It takes over the process: signals, the hook for
/// panics, the limit of memory.
pub fn run_command(arguments: impl IntoIterator<Item = impl Into<OsString>>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    lightmesh_files::look_at_output();
    panic::set_hook(Box::new(report_fault));
    color::set(color::asked(arguments.iter().cloned()));
    forget_fault();
    let result = panic::catch_unwind(|| match parse(&arguments, Styles::plain()) {
        Ok(cli) => start(&cli.command)
            .and_then(|()| run::run(cli.command))
            .unwrap_or_else(|failure| failed(&failure, &arguments)),
        Err(message) => explain(&arguments, &message),
    });
    interrupt::leave_if_requested();
    result.unwrap_or(UNABLE)
}

/// What a line of `lightmesh render` asks for, which begins with the name of the program; if it cannot be read, says why, and returns the exit code.
pub fn parse_render(arguments: impl IntoIterator<Item = impl Into<OsString>>) -> Result<Order, u8> {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    match parse(&arguments, Styles::plain()) {
        Ok(Cli { command: Command::Render(args), .. }) => Ok(args.order()),
        Ok(_) => Err(UNABLE),
        Err(message) => Err(explain(&arguments, &message)),
    }
}

fn parse(arguments: &[OsString], styles: Styles) -> Result<Cli, clap::Error> {
    let matches = args::command().styles(styles).try_get_matches_from(arguments);
    let cli = Cli::from_arg_matches(&matches.map_err(|error| args::naming_variables(error, arguments))?)?;
    color::set(cli.color);
    Ok(cli)
}

/// Prints what the parser says, in colours if these are wanted where it goes; returns the exit code.
fn explain(arguments: &[OsString], message: &clap::Error) -> u8 {
    let is_colored = output::is_usage_colored(message);
    let colored = is_colored.then(|| parse(arguments, Styles::styled()).err()).flatten();
    output::print_usage(colored.as_ref().unwrap_or(message), is_colored);
    message.exit_code() as u8
}

/// Prepares for the ends that may come at any moment.
fn start(command: &Command) -> Result<(), Failure> {
    interrupt::install()?;
    Ok(memory::watch(command.memory_limit())?)
}
