//! `lightmesh`: the light mesh method on the command line.
//!
//! `args` (as typed) ▶ `run` (the work) ▶ exit code, in one direction. What a picture of a file is, and the work on it, is in the library:
//! [`lightmesh::request`]. Anything that goes wrong is a `Failure`, which knows its exit code. Results go to standard output; notes, progress and
//! errors go to standard error.
//!
//! It is a library so that other programs can contain the command line ([`run_command`]).

mod args;
#[cfg(feature = "bench")]
mod budget;
mod color;
mod failure;
mod flags;
mod interrupt;
mod memory;
mod output;
mod progress;
mod run;

use std::ffi::OsString;
use std::panic::{self, PanicHookInfo};
use std::sync::Once;

use clap::FromArgMatches;
use clap::builder::Styles;
use lightmesh::request::Order;

use crate::args::{Cli, Command};
use crate::failure::{Failure, INTERRUPTED, UNABLE};

/// Runs the program with these arguments, the first of which is its name; returns the exit code. It takes over the process: signals, the hook for
/// panics, the limit of memory.
pub fn run_command(arguments: impl IntoIterator<Item = impl Into<OsString>>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    lightmesh_files::look_at_output();
    panic::set_hook(Box::new(report_fault));
    color::set(color::asked(arguments.iter().cloned()));
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

/// Reports an error; returns the exit code.
fn failed(failure: &Failure, arguments: &[OsString]) -> u8 {
    match failure {
        Failure::Exceeded(_) => output::complain(&failure.to_string()),
        // The last message, on what is written, says it.
        _ if failure.exit_code() == INTERRUPTED => {}
        _ => match flags::that_mend(failure) {
            flags if flags.is_empty() => output::complain(&format!("error: {failure}")),
            flags => {
                // A flag with a value is what to write instead.
                let variable = |flag: &str| args::variable_of(flag, arguments).filter(|_| !flag.contains(' '));
                let flags: Vec<String> = flags.into_iter().map(|flag| variable(&flag).unwrap_or(flag)).collect();
                output::complain(&format!("error: {failure} ({})", flags.join(", ")));
            }
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
