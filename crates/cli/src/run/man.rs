//! `lightmesh man`.

use clap::Command;
use clap_mangen::Man;

use crate::args::{self, ManArgs};
use crate::failure::Failure;
use crate::output::{self, OutputError};

pub(super) fn run(asked: &ManArgs) -> Result<(), Failure> {
    let mut lightmesh = args::command().disable_help_subcommand(true);
    lightmesh.build(); // gives subcommands their full names
    if let Some(directory) = &asked.output {
        let mut pages = Vec::new();
        for command in std::iter::once(&lightmesh).chain(lightmesh.get_subcommands()) {
            let page = Man::new(command.clone());
            pages.push(output::ready(&directory.join(page.get_filename()), text(&page)?.as_bytes())?);
        }
        return Ok(output::publish(pages)?);
    }
    let command = asked.page.as_deref().map_or(Ok(&lightmesh), |name| subcommand(&lightmesh, name))?;
    Ok(output::print(&text(&Man::new(command.clone()))?)?)
}

fn subcommand<'c>(lightmesh: &'c Command, name: &str) -> Result<&'c Command, Failure> {
    lightmesh.find_subcommand(name).ok_or_else(|| Failure::UnknownPage {
        name: name.to_owned(),
        known: lightmesh.get_subcommands().map(|command| command.get_name().to_owned()).collect(),
    })
}

fn text(page: &Man) -> Result<String, OutputError> {
    let mut text = Vec::new();
    page.render(&mut text).map_err(OutputError::Stdout)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
