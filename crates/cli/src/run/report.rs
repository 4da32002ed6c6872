//! `lightmesh report`.

use std::path::PathBuf;

use lightmesh_bench::report::Report;

use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::output::Outputs;
use crate::progress::Watcher;

pub(super) fn run(args: &ReportArgs) -> Result<(), Failure> {
    let report = Report::open(&args.results)?;
    let files = report.files(&args.output);
    let outputs = Outputs::new(files.iter().map(|file| ("-o", Some(&**file))))?;
    outputs.keep("BENCH.json", report.inputs().iter().map(PathBuf::as_path))?;
    report.write(&args.output)?;
    let page = args.output.join("report.html");
    Watcher::plain(args.quiet).summary(&format!("{} and report.md next to it", page.display()));
    Ok(())
}
