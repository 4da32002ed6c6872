//! `lightmesh bench`.

use std::path::PathBuf;

use lightmesh::Scene;
use lightmesh_bench::report::Report;
use lightmesh_bench::{Plan, Results, Suite, check_output_folder};
use lightmesh_files::{is_standard_output, publish_on_abort};

use crate::args::{BenchArgs, BenchCommand, SuiteArgs};
use crate::failure::Failure;
use crate::interrupt;
use crate::memory;
use crate::output::{self, Outputs};
use crate::progress::Watcher;

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    match (&args.command, args.run.suite) {
        (Some(BenchCommand::Compare(args)), _) => super::bench_compare::run(args),
        (None, Some(suite)) => measure(suite, &args.run),
        (None, None) => Ok(output::print(&list())?),
    }
}

fn list() -> String {
    Suite::ALL.iter().map(|suite| format!("{:13}{}\n", suite.name(), suite.summary())).collect()
}

fn measure(suite: Suite, args: &SuiteArgs) -> Result<(), Failure> {
    let outputs = outputs(args)?;
    keep_scenes(&outputs, &args.scenes)?;
    let watcher = Watcher::new(args.progress, args.quiet);
    memory::during(format!("suite {}", suite.name()), || interrupt::watched(|| run_and_write(suite, args, &watcher)))
}

fn run_and_write(suite: Suite, args: &SuiteArgs, watcher: &Watcher) -> Result<(), Failure> {
    let _standby = Standby;
    let results = match args.json.clone() {
        Some(path) => lightmesh_bench::run_keeping(suite, &plan(args), watcher, move |results| {
            // If this fails, so will the end of the run, which says why.
            let files = results.ready(&path, false).ok();
            publish_on_abort(files.and_then(|mut files| files.pop()));
        })?,
        None => lightmesh_bench::run(suite, &plan(args), watcher)?,
    };
    let (table, summary) = (results.to_string(), summary(&results, args));
    let mut files = Vec::new();
    if let Some(path) = &args.json {
        files = results.ready(path, args.pictures)?;
    }
    if let Some(folder) = &args.report {
        // Named as in a report on the file.
        let name = args.json.clone().unwrap_or_else(|| PathBuf::from(suite.name()));
        files.extend(Report::new(vec![(name, results)])?.ready(folder)?);
    }
    output::publish(files)?;
    // A program that reads the rows expects nothing else.
    if !args.json.as_ref().is_some_and(is_standard_output) {
        output::print(&table)?;
    }
    watcher.summary(&summary);
    Ok(())
}

/// Results so far, which appear if the program must end. They do not outlive the run, whether it succeeds or fails.
struct Standby;

impl Drop for Standby {
    fn drop(&mut self) {
        publish_on_abort(None);
    }
}

/// Checks that all files can be written.
fn outputs(args: &SuiteArgs) -> Result<Outputs, Failure> {
    let pages = args.report.iter().flat_map(|folder| Report::pages(folder));
    let pages: Vec<PathBuf> = pages.collect();
    let json = args.json.as_deref();
    let mut outputs =
        Outputs::new(std::iter::once(("--json", json)).chain(pages.iter().map(|page| ("--report", Some(&**page)))))?;
    if let Some(path) = json {
        output::check_writable(path)?;
        if args.pictures {
            let folder = Results::pictures_folder(path);
            check_output_folder(&folder)?;
            outputs = outputs.with_folder("--pictures", folder);
        }
    }
    if let Some(folder) = &args.report {
        check_output_folder(folder)?;
        let mut existing = pages.iter().filter(|page| page.exists());
        existing.try_for_each(|page| output::check_writable(page))?;
        for part in Report::FOLDERS {
            outputs = outputs.with_folder("--report", folder.join(part));
        }
    }
    Ok(outputs)
}

/// Checks that no file of the scenes is overwritten. They are opened for that: better now than after hours.
fn keep_scenes(outputs: &Outputs, scenes: &[PathBuf]) -> Result<(), Failure> {
    outputs.keep("the scene", scenes.iter().map(PathBuf::as_path))?;
    let is_file = |path: &&PathBuf| !path.to_string_lossy().starts_with("builtin:");
    if !outputs.is_empty() {
        for path in scenes.iter().filter(is_file) {
            outputs.keep_scene(&Scene::open(path)?)?;
        }
    }
    Ok(())
}

fn plan(args: &SuiteArgs) -> Plan {
    let plan = Plan::new(args.quick);
    Plan {
        budget: args.budget.map_or(plan.budget, |budget| budget.0),
        device: args.device,
        threads: args.threads.map(|threads| threads as usize),
        scenes: args.scenes.clone(),
        smooth: args.smooth.0,
        size: args.size,
        frames: args.frames,
        repetitions: args.repeat as usize,
        command: command_line(std::env::args().skip(1)),
        ..plan
    }
}

/// The command line to repeat the run, without the path of the program.
fn command_line(words: impl Iterator<Item = String>) -> String {
    let quoted = words.map(|word| if word.contains([' ', '?', '*', '"']) { format!("'{word}'") } else { word });
    std::iter::once("lightmesh".to_owned()).chain(quoted).collect::<Vec<_>>().join(" ")
}

fn summary(results: &Results, args: &SuiteArgs) -> String {
    let page = args.report.as_ref().map(|folder| folder.join("report.html"));
    let files: String = args.json.iter().chain(&page).map(|path| format!(", {}", path.display())).collect();
    // Images that are neither saved nor shown are not mentioned.
    let pictures = if args.pictures || args.report.is_some() {
        format!(", {} images", results.pictures.len())
    } else {
        String::new()
    };
    format!("{}: {} rows{pictures} in {:.0} s{files}", results.suite, results.rows.len(), results.seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_can_be_typed_again() {
        let words = ["bench", "rays", "--scene", "builtin:garden?lights=3"].map(str::to_owned);
        assert_eq!(command_line(words.into_iter()), "lightmesh bench rays --scene 'builtin:garden?lights=3'");
    }
}
