//! The command line from a user's view: every subcommand and flag, exit codes, and messages.

mod bench;
mod border;
mod color;
mod compare;
mod devices;
mod display;
mod faces;
mod farm;
mod files;
mod film;
mod help;
mod memory;
mod mesh_file;
mod messages;
mod render;
mod report;
mod resume;
mod run;
mod scenes;
mod sky;
mod smooth;
mod sun;

#[cfg(unix)]
mod interrupt;
#[cfg(unix)]
mod movie;
#[cfg(unix)]
mod outputs;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod streams;
