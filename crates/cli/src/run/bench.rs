//! `lightmesh bench`.

use std::path::PathBuf;

use lightmesh_bench::report::Report;
use lightmesh_bench::{Plan, Results, Suite, prepare_folder};

use crate::args::{BenchArgs, BenchCommand, SuiteArgs};
use crate::failure::Failure;
use crate::progress::Watcher;
use crate::{interrupt, output};

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    match (&args.command, args.run.suite) {
        (Some(BenchCommand::Compare(args)), _) => super::bench_compare::run(args),
        (None, Some(suite)) => measure(suite, &args.run),
        (None, None) => Ok(output::print(&list())?),
    }
}

fn list() -> String {
    Suite::ALL.iter().map(|suite| format!("{:9}{}\n", suite.name(), suite.summary())).collect()
}

fn measure(suite: Suite, args: &SuiteArgs) -> Result<(), Failure> {
    if let Some(path) = &args.json {
        output::check_writable(path)?;
        if args.pictures {
            prepare_folder(&Results::pictures_folder(path))?;
        }
    }
    if let Some(folder) = &args.report {
        prepare_folder(folder)?;
    }
    let watcher = Watcher::new(args.progress, args.quiet);
    interrupt::watch();
    let results = lightmesh_bench::run(suite, &plan(args), &watcher)?;
    if let Some(path) = &args.json {
        if args.pictures { results.save_with_pictures(path) } else { results.save(path) }?;
    }
    output::print(&results.to_string())?;
    let summary = summary(&results, args);
    if let Some(folder) = &args.report {
        // Named as in a report on the file.
        let name = args.json.clone().unwrap_or_else(|| PathBuf::from(suite.name()));
        Report::new(vec![(name, results)])?.write(folder)?;
    }
    watcher.summary(&summary);
    Ok(())
}

fn plan(args: &SuiteArgs) -> Plan {
    let plan = Plan::new(args.quick);
    Plan {
        budget: args.budget.map_or(plan.budget, |budget| budget.0),
        device: args.device,
        threads: args.threads.map(|threads| threads as usize),
        scenes: args.scenes.clone(),
        size: args.size,
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
