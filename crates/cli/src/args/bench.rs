//! The flags of `lightmesh bench`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use lightmesh::Device;
use lightmesh_bench::{Plan, Suite};

use super::Progress;
use lightmesh::request::value::Smooth;

use crate::budget::Budget;

/// Run a suite of experiments, or compare two runs
///
/// A suite prints a table; --json saves all rows, for `lightmesh bench compare` and `lightmesh report`. `lightmesh
/// bench --list` says what each suite measures. To name a file `compare`, write ./compare.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    pub(crate) command: Option<BenchCommand>,

    #[command(flatten)]
    pub(crate) run: SuiteArgs,
}

/// Commands on the results of suites.
#[derive(Debug, Subcommand)]
pub(crate) enum BenchCommand {
    /// Compare two runs of a suite: exit code 1 if the later one is significantly slower
    Compare(BenchCompareArgs),
}

/// Run a suite.
#[derive(Debug, Args)]
pub(crate) struct SuiteArgs {
    /// Run this suite; --list names them
    #[arg(value_name = "SUITE", required_unless_present = "list")]
    pub(crate) suite: Option<Suite>,

    /// List the suites
    #[arg(long, conflicts_with_all = ["suite", "json", "pictures", "report", "short", "budget", "device", "threads", "scenes", "smooth", "size", "frames", "repeat"])]
    pub(crate) list: bool,

    /// Save rows and notes as JSON [default: off]
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// Save images next to the JSON, in the folder FILE-pictures (FILE without extension), for reports
    #[arg(long, requires = "json")]
    pub(crate) pictures: bool,

    /// Write report.md, its plots and images, and the self-contained report.html to this folder [default: off]
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,

    /// Measure fewer rows and smaller images
    #[arg(long = "quick", id = "short")]
    pub(crate) quick: bool,

    /// Limit the time, as in 90s, 15m or 2h, with fewer repetitions, then fewer rows; notes in the results name them
    /// [default: 15m, or 150s with --quick]
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub(crate) budget: Option<Budget>,

    /// Measure on auto (the CPU and, if one works, a GPU), cpu, cuda, cuda:N or several such as cuda:all
    #[arg(long, value_name = "DEVICE", default_value = "auto")]
    pub(crate) device: Device,

    /// Use N CPU threads [default: all]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) threads: Option<u32>,

    /// Measure this scene, in suites that accept any; repeatable [default: the suite's own]
    #[arg(long = "scene", id = "scenes", value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,

    /// Smooth edges below this crease angle in OBJ, PLY and STL files without normals; off shows facets
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, default_value_t = Smooth::OFF)]
    pub(crate) smooth: Smooth,

    /// Set the pixels along a side, in suites that accept any [default: the suite's own]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) size: Option<u32>,

    /// Render N frames in the suite flight [default: 240, or 24 with --quick]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub(crate) frames: Option<u32>,

    /// Count N repetitions of each image; fewer if the budget is short
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = Plan::REPETITIONS as u32,
        value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,

    /// Show progress on stderr
    #[arg(long, value_enum, default_value_t = Progress::Auto)]
    pub(crate) progress: Progress,

    /// Print only the table and errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Compare two runs of a suite
///
/// Rows are matched by id. For each stage that both runs have, the ratio of the medians is compared with a noise band
/// derived from the repetitions of both. A row is judged by its stage `render`, or by all stages if it has no such
/// stage or the suite is `stages`.
#[derive(Debug, Args)]
pub(crate) struct BenchCompareArgs {
    /// Read the earlier run
    #[arg(value_name = "OLD.json")]
    pub(crate) old: PathBuf,

    /// Read the later run
    #[arg(value_name = "NEW.json")]
    pub(crate) new: PathBuf,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}
