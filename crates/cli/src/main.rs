//! `lightmesh`: the light mesh method on the command line.
//!
//! [`args`] (as typed) ▶ [`plan`] (validated) ▶ [`run`] (the work) ▶ exit code, in one direction. Anything that goes wrong is a
//! [`Failure`], which knows its exit code. Results go to standard output; notes, progress and errors go to standard error.

mod args;
mod destination;
mod failure;
mod flags;
mod interrupt;
mod memory;
mod output;
mod plan;
mod progress;
mod report;
mod run;
mod value;

use std::panic::{self, PanicHookInfo};
use std::process::ExitCode;
use std::sync::Once;

use clap::FromArgMatches;

use crate::args::{Cli, Command};
use crate::failure::{Failure, INTERRUPTED, UNABLE};

fn main() -> ExitCode {
    panic::set_hook(Box::new(report_fault));
    let result = panic::catch_unwind(|| match parse() {
        Ok(cli) => start(&cli.command).and_then(|()| run::run(cli.command)).unwrap_or_else(|failure| failed(&failure)),
        Err(message) => {
            output::print_usage(&message);
            message.exit_code() as u8
        }
    });
    interrupt::leave_if_requested();
    ExitCode::from(result.unwrap_or(UNABLE))
}

fn parse() -> Result<Cli, clap::Error> {
    Cli::from_arg_matches(&args::command().try_get_matches()?)
}

/// Prepares for the ends that may come at any moment.
fn start(command: &Command) -> Result<(), Failure> {
    interrupt::install()?;
    Ok(memory::watch(command.reading())?)
}

/// Reports an error; returns the exit code.
fn failed(failure: &Failure) -> u8 {
    match failure {
        Failure::Exceeded(_) => output::complain(&failure.to_string()),
        // The last message, on what is written, says it.
        _ if failure.exit_code() == INTERRUPTED => {}
        _ => match flags::that_mend(failure) {
            flags if flags.is_empty() => output::complain(&format!("error: {failure}")),
            flags => output::complain(&format!("error: {failure} ({})", flags.join(", "))),
        },
    }
    failure.exit_code()
}

/// Reports a bug in the program itself, once, however many threads run into it.
fn report_fault(fault: &PanicHookInfo) {
    static ONCE: Once = Once::new();
    let payload = fault.payload();
    let text = payload.downcast_ref::<&str>().copied().or(payload.downcast_ref::<String>().map(String::as_str));
    let message = text.unwrap_or("no message");
    let place = fault.location().map_or_else(String::new, |place| format!(", {}:{}", place.file(), place.line()));
    let text = format!("error: internal error in lightmesh ({message}){place}; please report it with the command line");
    ONCE.call_once(|| output::complain(&text));
}
