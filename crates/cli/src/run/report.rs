//! `lightmesh report`.

use lightmesh_bench::report::Report;

use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Watcher;

pub(super) fn run(args: &ReportArgs) -> Result<(), Failure> {
    let report = Report::open(&args.results)?;
    interrupt::watch();
    report.write(&args.output)?;
    let page = args.output.join("report.html");
    Watcher::plain(args.quiet).summary(&format!("{} and report.md next to it", page.display()));
    Ok(())
}
