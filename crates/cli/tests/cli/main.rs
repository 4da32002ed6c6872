//! The command line as a user meets it: every subcommand and flag, exit codes, and the text of messages.

mod bench;
mod compare;
mod devices;
mod help;
mod messages;
mod render;
mod report;
mod run;
mod scenes;

#[cfg(unix)]
mod interrupt;
