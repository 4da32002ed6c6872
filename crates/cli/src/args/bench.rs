//! The flags of `lightmesh bench`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use lightmesh::Device;
use lightmesh_bench::Suite;

use super::Progress;
use crate::value::Budget;

/// Run a suite of experiments, or compare two runs
///
/// The suites: `thesis` has every table and figure of the thesis, `quality` errors against converged area shadows and what equal
/// errors cost by shadow rays, `rays` the rays per second of each acceleration structure. A table is printed; --json keeps
/// everything, for `lightmesh bench compare` and `lightmesh report`. A file that is called compare is written ./compare.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    pub(crate) command: Option<BenchCommand>,

    #[command(flatten)]
    pub(crate) run: SuiteArgs,
}

/// What else can be done with suites.
#[derive(Debug, Subcommand)]
pub(crate) enum BenchCommand {
    /// Compare two runs of a suite: exit code 1 where the later is slower by more than the noise of both
    Compare(BenchCompareArgs),
}

/// Run a suite.
#[derive(Debug, Args)]
pub(crate) struct SuiteArgs {
    /// thesis, quality or rays
    #[arg(value_name = "SUITE", required_unless_present = "list")]
    pub(crate) suite: Option<Suite>,

    /// List the suites
    #[arg(long, conflicts_with_all = ["suite", "json", "report", "short", "budget", "device", "threads", "scenes"])]
    pub(crate) list: bool,

    /// Keep rows, pictures and notes as JSON [default: off]
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// A report on the results: report.md with its plots and pictures, and report.html, which needs nothing else [default: off]
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,

    /// The short form: fewer rows and smaller pictures
    #[arg(long = "quick", id = "short")]
    pub(crate) quick: bool,

    /// Time for all of it, as in 90s, 15m or 2h: repetitions are cut to fit, then rows are left out, and notes say so [default: 15m, or
    /// 150s with --quick]
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub(crate) budget: Option<Budget>,

    /// Where to compute: auto (the processor and, where one works, a GPU), cpu, cuda or cuda:N
    #[arg(long, value_name = "DEVICE", default_value = "auto")]
    pub(crate) device: Device,

    /// CPU threads [default: all]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) threads: Option<u32>,

    /// A scene to measure, for suites that take any; repeatable [default: the suite's own]
    #[arg(long = "scene", id = "scenes", value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,

    /// Progress on stderr
    #[arg(long, value_enum, default_value_t = Progress::Auto)]
    pub(crate) progress: Progress,

    /// Print nothing but the table and errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Compare two runs of a suite
///
/// Rows are matched by their ids. For each stage that both have, the ratio of the medians is held against a noise band from the
/// repetitions of both. A row is judged by its stage `render`, or by all stages where it has none.
#[derive(Debug, Args)]
pub(crate) struct BenchCompareArgs {
    /// The earlier run
    #[arg(value_name = "OLD.json")]
    pub(crate) old: PathBuf,

    /// The later run
    #[arg(value_name = "NEW.json")]
    pub(crate) new: PathBuf,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}
