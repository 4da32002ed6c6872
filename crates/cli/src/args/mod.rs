//! The command line as typed: one struct per subcommand. Doc comments are the help text.
//!
//! Values are parsed individually (see [`value`](crate::value)); combinations are checked in [`plan`](crate::plan).

mod bench;
mod render;
mod words;

use std::path::{Path, PathBuf};

use clap::{Arg, Args, CommandFactory, Parser, Subcommand};
use lightmesh::scene::{Instancing, SceneFormat};

pub(crate) use bench::{BenchArgs, BenchCommand, BenchCompareArgs, SuiteArgs};
pub(crate) use render::{ExposureArgs, FormArgs, ImageArgs, RenderArgs, StorageArgs};
pub(crate) use words::{Progress, Switch, Up};

use crate::color::When;
use crate::value::{Bound, ByteSize, Dims, Smooth};

/// Soft shadows by the light mesh method
#[derive(Debug, Parser)]
#[command(name = "lightmesh", version, long_version = version(), max_term_width = 110, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// When messages have colours
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    pub(crate) color: When,
}

/// The version, with the commit if it is known, and what the kernels need.
fn version() -> String {
    let commit = lightmesh_bench::commit().map_or_else(String::new, |commit| format!("commit {commit}, "));
    format!("{} ({commit}kernels for CUDA 12.0 or newer)", env!("CARGO_PKG_VERSION"))
}

/// The command line with a variable for each flag of `render`: LIGHTMESH_MEMORY_LIMIT for `--memory-limit`.
pub(crate) fn command() -> clap::Command {
    Cli::command().mut_subcommands(|subcommand| match subcommand.get_name() {
        "render" => subcommand.mut_args(with_variable),
        _ => subcommand,
    })
}

fn with_variable(flag: Arg) -> Arg {
    match flag.get_long().map(|long| long.replace('-', "_").to_uppercase()) {
        Some(name) if !NOT_FROM_VARIABLES.contains(&&*name) => flag.env(format!("LIGHTMESH_{name}")).hide_env(true),
        _ => flag,
    }
}

/// What a single command asks for, or what has no value.
const NOT_FROM_VARIABLES: [&str; 5] = ["HELP", "OUTPUT", "LIGHT", "QUIET", "VERBOSE"];

const EXIT_CODES: &str = "\
Exit codes: 0 success, 1 a comparison exceeded its threshold, 2 bad input or usage, 3 device unusable or memory \
insufficient, 4 a film failed after some of its frames (--resume goes on), 130 interrupted (143 by SIGTERM, 129 by SIGHUP).

Environment: each flag of `lightmesh render` except -o, --light, -q and -v can be set by a variable, LIGHTMESH_DEVICE for \
--device or LIGHTMESH_MEMORY_LIMIT for --memory-limit; the flag wins. LIGHTMESH_FFMPEG names the program that encodes movies. CUDA_VISIBLE_DEVICES hides GPUs. NO_COLOR, \
CLICOLOR_FORCE and CLICOLOR=0 decide about colours, unless --color does.

Examples:
  lightmesh render builtin:childpark -o park.png
  lightmesh render house.glb -o house.png --size 1920x1080 --quality final
  lightmesh render room.toml -o room.exr --layers layers.exr --device cpu -v
  lightmesh render room.toml -o room.png --quality final --partial
  lightmesh export room.toml -o - | lightmesh render - --scene-format glb -o - --format png > room.png
  lightmesh render crystal.stl -o crystal.png --smooth off
  lightmesh compare before.png after.png --max-flip 0.01";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render an image of a scene
    Render(Box<RenderArgs>),
    /// Describe a scene, or list devices
    Info(InfoArgs),
    /// Compare two images
    Compare(CompareArgs),
    /// Build the acceleration grid of a scene and save it
    Grid(GridArgs),
    /// Export a built-in or loaded scene
    Export(ExportArgs),
    /// Run a suite of experiments, or compare two runs
    Bench(Box<BenchArgs>),
    /// Write a report on benchmark results, as Markdown and HTML
    Report(ReportArgs),
    /// Print the JSON Schema of TOML scene files, for editors and validators
    Schema,
    /// Print a shell completion script
    Completions(CompletionsArgs),
    /// Print the manual page
    Man(ManArgs),
}

/// Where a scene comes from.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArg {
    /// A .toml, .obj, .gltf, .glb, .ply or .stl file, or builtin:gazebo, builtin:childpark, builtin:garden (also with options, as
    /// in builtin:garden?lights=3), or `-`: standard input, which needs --scene-format
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

impl SceneArg {
    /// The format of the scene; `None` if it is built in, or unknown.
    pub(crate) fn format(&self) -> Option<SceneFormat> {
        self.reading.format_of(&self.scene)
    }
}

impl ReadingArgs {
    /// The format of a scene: the given one, or by the extension.
    pub(crate) fn format_of(self, scene: &Path) -> Option<SceneFormat> {
        self.scene_format.or_else(|| SceneFormat::from_path(scene))
    }
}

/// How a scene is read.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct ReadingArgs {
    /// Format of the scene [default: by the extension]. Files to which a scene on standard input refers are looked for
    /// in the current folder
    #[arg(long, value_parser = words::scene_format(), help_heading = "Reading")]
    pub(crate) scene_format: Option<SceneFormat>,

    /// Allow references to files outside the scene's folder
    #[arg(long, help_heading = "Reading")]
    pub(crate) allow_outside: bool,

    /// Treat warnings as errors (exit code 2)
    #[arg(long, help_heading = "Reading")]
    pub(crate) strict: bool,

    /// Most memory to use, on the host and on a device each; work is split to fit, and what cannot be split is refused (exit code 3). In
    /// bytes, or with a unit: K, M, G, T (or KiB, …) are powers of 1024, kB, MB, GB, TB powers of 1000. A CUDA driver's own memory on the
    /// host is not counted [default: free memory minus a reserve]
    #[arg(long, value_name = "SIZE", help_heading = "Machine")]
    pub(crate) memory_limit: Option<ByteSize>,
}

impl Command {
    /// How it reads its scene; `None` if it has no such flags.
    pub(crate) fn reading(&self) -> Option<ReadingArgs> {
        match self {
            Command::Render(args) => Some(args.scene.reading),
            Command::Info(args) => Some(args.reading),
            Command::Grid(args) => Some(args.scene.reading),
            Command::Export(args) => Some(args.scene.reading),
            _ => None,
        }
    }
}

/// Describe a scene, or list devices
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The scene to describe; `-` is standard input, which needs --scene-format
    #[arg(value_name = "SCENE", required_unless_present = "devices", conflicts_with = "devices")]
    pub(crate) scene: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) reading: ReadingArgs,

    /// Crease angle of OBJ, PLY and STL files without normals, in degrees, or off, as for `lightmesh render`
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, default_value_t, help_heading = "Reading")]
    pub(crate) smooth: Smooth,

    /// Whether meshes in many places are stored once, as for `lightmesh render`
    #[arg(long, value_name = "WHEN", value_parser = words::instances(), default_value_t = Instancing::Auto, help_heading = "Reading")]
    pub(crate) instances: Instancing,

    /// List devices, and why some cannot be used
    #[arg(long)]
    pub(crate) devices: bool,

    /// Print JSON: world coordinates, degrees
    #[arg(long)]
    pub(crate) json: bool,
}

/// Compare two images
///
/// RMSE, PSNR and the maximum difference are computed on display values in [0, 1]; FLIP predicts the difference that a viewer
/// perceives when flipping between the images. The exit code is 1 if a threshold is exceeded.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Reference image: bmp, png, exr or jpg
    #[arg(value_name = "A")]
    pub(crate) reference: PathBuf,

    /// Image to compare with the reference
    #[arg(value_name = "B")]
    pub(crate) test: PathBuf,

    /// Save the FLIP error of each pixel as an image, from black (equal) to yellow (maximum error)
    #[arg(long, value_name = "D.png")]
    pub(crate) diff: Option<PathBuf>,

    /// Maximum mean FLIP error
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_flip: Option<Bound>,

    /// Maximum RMSE
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_rmse: Option<Bound>,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Build the acceleration grid of a scene and save it
///
/// `lightmesh render SCENE --grid-file FILE` loads it instead of building one. The file is only valid for the geometry from which
/// it was built, and rejected for any other.
#[derive(Debug, Args)]
pub(crate) struct GridArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Output file
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Cells along each axis [default: from the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ")]
    pub(crate) grid: Option<Dims>,

    /// 1: a single grid; 2: cells with many triangles contain a nested grid
    #[arg(long, value_name = "1|2", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub(crate) levels: u8,

    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Export a built-in or loaded scene
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// NAME.glb: everything in one file; NAME.toml: cameras and lights as text, and the triangles in NAME.mesh.glb;
    /// `-`: GLB on standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Crease angle of OBJ, PLY and STL files without normals, in degrees: the normals that they get are exported. off exports facets
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, default_value_t, help_heading = "Reading")]
    pub(crate) smooth: Smooth,

    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Write a report on benchmark results, as Markdown and HTML
///
/// Both contain tables, plots, images compared with their references, and the machine, driver, commit and command of each run.
/// Several files are shown side by side, with ratios to the first file for rows with the same id.
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Results of `lightmesh bench SUITE --json FILE`; the file name is used as the name of the run
    #[arg(value_name = "BENCH.json", required = true)]
    pub(crate) results: Vec<PathBuf>,

    /// Output folder for report.md with its plots and images, and for the self-contained report.html; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Print a shell completion script
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub(crate) shell: clap_complete::Shell,
}

/// Print the manual page
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The page of a subcommand instead of the general one
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) page: Option<String>,

    /// Write all pages to a directory
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn flags_have_variables() {
        let command = command();
        let render = command.find_subcommand("render").unwrap();
        let variable = |id: &str| render.get_arguments().find(|flag| flag.get_id() == id).unwrap().get_env();
        assert_eq!(variable("memory_limit"), Some("LIGHTMESH_MEMORY_LIMIT".as_ref()));
        assert_eq!((variable("device"), variable("output")), (Some("LIGHTMESH_DEVICE".as_ref()), None));
    }
}
