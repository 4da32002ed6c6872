//! The command line as it is typed: one struct a subcommand. Doc comments are the help text.
//!
//! Values are parsed where they stand (see [`value`](crate::value)); what they mean together is checked in
//! [`plan`](crate::plan).

mod bench;
mod render;
mod words;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

pub(crate) use bench::{BenchArgs, BenchCommand, BenchCompareArgs, SuiteArgs};
pub(crate) use render::RenderArgs;
pub(crate) use words::{Accel, Falloff, Lookup, Mode, Progress, ShortTests, Transfer, Up, Weight};

use crate::value::{Bound, Dims};

/// Soft shadows by the light mesh method
#[derive(Debug, Parser)]
#[command(name = "lightmesh", version, max_term_width = 110, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 a comparison exceeded its bound, 2 bad input or usage, 3 device or memory cannot do it, \
130 interrupted.";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render one picture of a scene
    Render(Box<RenderArgs>),
    /// Say what is in a scene, or which devices can be used
    Info(InfoArgs),
    /// Say how far two pictures are apart
    Compare(CompareArgs),
    /// Build the acceleration grid of a scene and keep it in a file
    Grid(GridArgs),
    /// Write a built-in or loaded scene as files
    Export(ExportArgs),
    /// Run a suite of experiments, or compare two runs
    Bench(Box<BenchArgs>),
    /// Show results of suites as Markdown and as one HTML page
    Report(ReportArgs),
    /// Print the JSON Schema of scene files in TOML, for editors and checkers
    Schema,
    /// Print a script that completes command lines in a shell
    Completions(CompletionsArgs),
    /// Print the manual page
    Man(ManArgs),
}

/// Where a scene comes from.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArg {
    /// A .toml, .obj, .gltf, .glb, .ply or .stl file, or builtin:gazebo, builtin:childpark, builtin:garden (also with options, as in
    /// builtin:garden?lights=3)
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

/// How a scene is read.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct ReadingArgs {
    /// Follow references out of the folder that the scene lies in; elsewhere lies what its author cannot know
    #[arg(long, help_heading = "Reading")]
    pub(crate) allow_outside: bool,

    /// End with exit code 2 where there is something to warn of
    #[arg(long, help_heading = "Reading")]
    pub(crate) strict: bool,
}

/// Say what is in a scene, or which devices can be used
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The scene to describe
    #[arg(value_name = "SCENE", required_unless_present = "devices", conflicts_with = "devices")]
    pub(crate) scene: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,

    /// List the devices, and why those that cannot be used cannot
    #[arg(long)]
    pub(crate) devices: bool,

    /// Print JSON: world coordinates, degrees
    #[arg(long)]
    pub(crate) json: bool,
}

/// Say how far two pictures are apart
///
/// RMSE, PSNR and the largest difference are taken over display values in [0, 1]; FLIP predicts what a viewer sees who flips
/// between both. With a bound the exit code is 1 where it is exceeded.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The reference: bmp, png, exr or jpg
    #[arg(value_name = "A")]
    pub(crate) reference: PathBuf,

    /// The picture to hold against it
    #[arg(value_name = "B")]
    pub(crate) test: PathBuf,

    /// Save the FLIP error of each pixel as a picture: black is equal, yellow as different as can be
    #[arg(long, value_name = "D.png")]
    pub(crate) diff: Option<PathBuf>,

    /// The largest mean FLIP error that is accepted
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_flip: Option<Bound>,

    /// The largest RMSE that is accepted
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_rmse: Option<Bound>,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Build the acceleration grid of a scene and keep it in a file
///
/// `lightmesh render SCENE --grid-file FILE` takes it instead of building one. It belongs to this very geometry and is
/// refused for any other.
#[derive(Debug, Args)]
pub(crate) struct GridArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Where the grid goes
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Cells along each axis [default: after the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ")]
    pub(crate) grid: Option<Dims>,

    /// 1: one grid; 2: cells with many triangles hold a grid of their own
    #[arg(long, value_name = "1|2", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub(crate) levels: u8,

    /// Print nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Write a built-in or loaded scene as files
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// NAME.glb: everything in one file; NAME.toml: cameras and lights as text, with the triangles beside it in
    /// NAME.mesh.glb
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Print nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Show results of suites as Markdown and as one HTML page
///
/// Both have tables, plots, pictures held against their references, and the machine, driver, commit and command of each run. Several
/// files are shown side by side: rows with the same id get ratios to the first file.
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Results of `lightmesh bench SUITE --json FILE`; each is called by the name of its file
    #[arg(value_name = "BENCH.json", required = true)]
    pub(crate) results: Vec<PathBuf>,

    /// The folder for report.md with its plots and pictures, and for report.html, which needs nothing else; made where it is missing
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Print nothing but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Print a script that completes command lines in a shell
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub(crate) shell: clap_complete::Shell,
}

/// Print the manual page
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The page of this subcommand rather than the general one
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) page: Option<String>,

    /// Write all pages into this directory
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }
}
