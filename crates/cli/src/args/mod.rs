//! The command line as typed: one struct per subcommand. Doc comments are the help text.
//!
//! Settings of a request are flags of the same names, made from the table of them. Values are checked one by one here, and together in the plan.

#[cfg(feature = "bench")]
mod bench;
mod farm;
mod render;
mod serve;
mod settings;
mod variables;
mod words;

use std::path::PathBuf;

use clap::builder::UnknownArgumentValueParser;
use clap::{Arg, Args, CommandFactory, Parser, Subcommand};
use lightmesh::request::value::{Bound, ByteSize, Dims, Smooth};
use lightmesh::scene::Instancing;

#[cfg(feature = "bench")]
pub(crate) use bench::{BenchArgs, BenchCommand, BenchCompareArgs, SuiteArgs};
pub(crate) use farm::FarmArgs;
pub(crate) use render::RenderArgs;
pub(crate) use serve::ServeArgs;
pub(crate) use settings::{Flags, Reading};
pub(crate) use variables::{naming_variables, variable_of};
pub(crate) use words::{Chunks, Progress};

use crate::color::When;

/// Render triangle models with exact soft shadows
#[derive(Debug, Parser)]
#[command(name = "lightmesh", version, long_version = version(), max_term_width = 110, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Colour messages
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    pub(crate) color: When,
}

/// The version, with the commit if it is known, and what the kernels need.
fn version() -> String {
    let commit = option_env!("LIGHTMESH_COMMIT").filter(|commit| !commit.is_empty());
    let commit = commit.map_or_else(String::new, |commit| format!("commit {commit}, "));
    format!("{} ({commit}kernels for CUDA 12.0 or newer)", env!("CARGO_PKG_VERSION"))
}

/// The command line with a variable for each flag of `render`.
pub(crate) fn command() -> clap::Command {
    with_defaults(Cli::command()).mut_subcommands(|subcommand| match subcommand.get_name() {
        "render" => subcommand.mut_args(variables::with_variable),
        _ => subcommand,
    })
}

/// The command whose help texts end with the defaults of their flags. The parser would put each into a paragraph of its own.
fn with_defaults(command: clap::Command) -> clap::Command {
    command.mut_args(with_default).mut_subcommands(with_defaults)
}

fn with_default(flag: Arg) -> Arg {
    let values: Vec<_> = flag.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    match flag.get_help() {
        Some(help) if !values.is_empty() => {
            let help = format!("{help} [default: {}]", values.join(" "));
            flag.hide_default_value(true).help(help)
        }
        _ => flag,
    }
}

const EXIT_CODES: &str = "\
Exit codes:
  0    success
  1    a comparison exceeded its threshold
  2    bad input or usage
  3    device unusable, memory insufficient, or a server (--server) that cannot be had
  4    a film failed after some of its frames; --resume continues it
  130  interrupted (143 by SIGTERM, 129 by SIGHUP)

Environment (flags win over variables):
  LIGHTMESH_DEVICE      sets --device of `lightmesh render`
  LIGHTMESH_GRID_FILE   sets --grid-file, and so on for its flags
                        except -o, --light, -q and -v; flags without
                        a value take 1, yes, true or on and 0, no, false or off
  LIGHTMESH_FFMPEG      names the program that encodes movies
  CUDA_VISIBLE_DEVICES  hides and renumbers GPUs
  NO_COLOR, CLICOLOR_FORCE, CLICOLOR=0 decide about colours

Examples:
  lightmesh render builtin:childpark -o park.png
  lightmesh render house.glb -o house.png --size 1920x1080 --quality final
  lightmesh render room.toml -o room.exr --layers layers.exr --device cpu -v
  lightmesh render room.toml -o room.png --quality final --partial
  lightmesh export room.toml -o - | lightmesh render - --scene-format glb -o room.png
  lightmesh render crystal.stl -o crystal.png --smooth off
  lightmesh compare before.png after.png --max-flip 0.01";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render an image of a scene
    Render(Box<RenderArgs>),
    /// Describe a scene, or list devices
    Info(InfoArgs),
    /// Render for others, with a scene that stays read and devices that stay awake
    Serve(ServeArgs),
    /// Write a job for a render farm, as an Open Job Description template
    Farm(Box<FarmArgs>),
    /// Compare two images
    Compare(CompareArgs),
    /// Build the acceleration grid of a scene and save it
    Grid(GridArgs),
    /// Export a built-in or loaded scene
    Export(ExportArgs),
    /// Run a suite of experiments, or compare two runs
    #[cfg(feature = "bench")]
    Bench(Box<BenchArgs>),
    /// Write a report on benchmark results, as Markdown and HTML
    #[cfg(feature = "bench")]
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
    /// Open a .toml, .obj, .gltf, .glb, .ply or .stl file, builtin:gazebo, builtin:childpark, builtin:garden, or `-`
    /// (standard input, with --scene-format)
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) reading: Flags<Reading>,
}

impl Command {
    /// The limit of memory, if it has a flag for that.
    pub(crate) fn memory_limit(&self) -> Option<Option<ByteSize>> {
        let reading = match self {
            Command::Render(args) => &args.scene.reading,
            Command::Farm(args) => &args.scene.reading,
            Command::Info(args) => &args.reading,
            Command::Grid(args) => &args.scene.reading,
            Command::Export(args) => &args.scene.reading,
            _ => return None,
        };
        Some(reading.request().memory_limit)
    }
}

/// Describe a scene, or list devices
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// Describe this scene; `-` is standard input, with --scene-format
    #[arg(value_name = "SCENE", required_unless_present = "devices", conflicts_with = "devices")]
    pub(crate) scene: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) reading: Flags<Reading>,

    /// Smooth edges below this crease angle in OBJ, PLY and STL files without normals; off shows facets
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, default_value_t, help_heading = "Reading")]
    pub(crate) smooth: Smooth,

    /// Store meshes in many places once
    #[arg(long, value_name = "WHEN", value_parser = settings::instances(), default_value_t = Instancing::Auto, help_heading = "Reading")]
    pub(crate) instances: Instancing,

    /// List devices, and why some cannot be used
    #[arg(long)]
    pub(crate) devices: bool,

    /// Print the files that the scene is read from, a line each: itself, and all it refers to that are there
    #[arg(long, requires = "scene")]
    pub(crate) files: bool,

    /// Print JSON, in world coordinates and degrees
    #[arg(long)]
    pub(crate) json: bool,
}

/// Compare two images
///
/// RMSE, PSNR and the maximum difference compare display values in [0, 1]. FLIP predicts the difference that a viewer
/// sees when flipping between the images. Of two exr or hdr files, linear values are compared, too: their RMSE relative
/// to A, and HDR-FLIP, the largest FLIP error over all exposures. The exit code is 1 if a measure exceeds its threshold.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Compare with this reference: bmp, png, exr, hdr or jpg
    #[arg(value_name = "A")]
    pub(crate) reference: PathBuf,

    /// Compare this image
    #[arg(value_name = "B")]
    pub(crate) test: PathBuf,

    /// Save the FLIP error of each pixel as an image, from black (equal) to yellow (maximum error) [default: off]
    #[arg(long, value_name = "D.png")]
    pub(crate) diff: Option<PathBuf>,

    #[arg(short, long, hide = true, value_parser = UnknownArgumentValueParser::suggest_arg("--diff"))]
    pub(crate) output: Option<String>,

    /// Fail if the mean FLIP error exceeds X; of two exr or hdr files, HDR-FLIP, too [default: none]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_flip: Option<Bound>,

    /// Fail if the RMSE exceeds X; of two exr or hdr files, the relative RMSE of linear values, too [default: none]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) max_rmse: Option<Bound>,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Build the acceleration grid of a scene and save it
///
/// `lightmesh render SCENE --grid-file FILE` loads the grid instead of building one. The file is valid only for the
/// geometry that it was built from; other scenes are refused.
#[derive(Debug, Args)]
pub(crate) struct GridArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Write the grid to this file
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Set the cells along each axis [default: from the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ")]
    pub(crate) grid: Option<Dims>,

    /// Build 1 level, or 2: cells with many triangles contain a nested grid
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

    /// Write NAME.glb, all in one file, or NAME.toml, cameras and lights as text with the triangles in NAME.mesh.glb; `-`
    /// is GLB on standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Smooth edges below this crease angle in OBJ, PLY and STL files without normals, and export the normals; off
    /// exports facets
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, default_value_t, help_heading = "Reading")]
    pub(crate) smooth: Smooth,

    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Write a report on benchmark results, as Markdown and HTML
///
/// Both contain tables, plots, images compared with their references, and the machine, driver, commit and command of
/// each run. The report shows several files side by side, with ratios to the first file for rows with the same id.
#[cfg(feature = "bench")]
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Read results of `lightmesh bench SUITE --json FILE`; the file name names the run
    #[arg(value_name = "BENCH.json", required = true)]
    pub(crate) results: Vec<PathBuf>,

    /// Write report.md, its plots and images, and the self-contained report.html to this folder; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Print a shell completion script
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// Print the script for this shell
    #[arg(value_name = "SHELL")]
    pub(crate) shell: clap_complete::Shell,
}

/// Print the manual page
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Print the page of this subcommand [default: the general page]
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) page: Option<String>,

    /// Write all pages to this folder [default: print one]
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use clap::builder::PossibleValue;

    use super::*;

    /// Lines that the help of a flag has at most, its own included.
    const MAX_LINES: usize = 3;
    const COLUMNS: usize = 100;

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

    /// Each flag and positional of a help text, with the number of its lines without those of possible values; and the values that have more
    /// than one line.
    fn flags_and_lines(help: &str) -> (Vec<(&str, usize)>, Vec<&str>) {
        let (mut flags, mut values) = (Vec::<(&str, usize)>::new(), Vec::new());
        let (mut in_flag, mut value) = (false, None);
        for line in help.lines() {
            let text = line.trim_start();
            let indent = line.len() - text.len();
            if text.is_empty() {
                continue;
            }
            if indent == 0 {
                (in_flag, value) = (false, None);
            } else if indent <= 6 && text.starts_with(['-', '<', '[']) {
                flags.push((text, 1));
                (in_flag, value) = (true, None);
            } else if text == "Possible values:" {
                (in_flag, value) = (false, Some(text));
            } else if value.is_some() && text.starts_with("- ") {
                value = Some(text);
            } else if let Some(value) = value {
                values.push(value);
            } else if in_flag && let Some((_, lines)) = flags.last_mut() {
                *lines += 1;
            }
        }
        (flags, values)
    }

    /// All commands that have no commands of their own, and `bench`, with their full names.
    fn commands(command: &clap::Command, name: &str) -> Vec<(String, clap::Command)> {
        let mut all = vec![(name.to_owned(), command.clone())];
        for subcommand in command.get_subcommands().filter(|subcommand| subcommand.get_name() != "help") {
            all.extend(commands(subcommand, &format!("{name} {}", subcommand.get_name())));
        }
        all
    }

    #[test]
    fn help_on_a_flag_is_short() {
        let mut lightmesh = command().term_width(COLUMNS);
        lightmesh.build();
        let mut count = 0;
        for (name, mut command) in commands(&lightmesh, "lightmesh") {
            for help in [command.render_long_help().to_string(), command.render_help().to_string()] {
                let (flags, values) = flags_and_lines(&help);
                let long: Vec<_> = flags.iter().filter(|(_, lines)| *lines > MAX_LINES).collect();
                assert!(long.is_empty() && values.is_empty(), "{name}: {long:?} {values:?}\n{help}");
                count += flags.len();
            }
        }
        assert!(count > 200, "{count} flags are too few to be all");
    }

    #[test]
    fn a_long_help_is_noticed() {
        let values = || [PossibleValue::new("a").help("b ".repeat(60)), PossibleValue::new("c")];
        let flag = |name: &'static str, help: String| Arg::new(name).long(name).help(help);
        let mut odd = clap::Command::new("odd")
            .term_width(COLUMNS)
            .arg(flag("long", "word ".repeat(60)).long_help(format!("{}\n\nmore", "word ".repeat(36))))
            .arg(flag("short", "word ".repeat(36)).value_parser(values()));
        let lines = |help: String| {
            let (flags, values) = flags_and_lines(&help);
            (flags.iter().map(|(_, lines)| *lines).collect::<Vec<_>>(), values.len())
        };
        assert_eq!(lines(odd.render_long_help().to_string()), (vec![4, 3, 2], 1));
        assert!(lines(odd.render_help().to_string()).0[0] > MAX_LINES);
    }

    #[test]
    fn flags_with_a_value_say_what_it_is_without_them() {
        let mut lightmesh = command();
        lightmesh.build();
        for (name, command) in commands(&lightmesh, "lightmesh") {
            for flag in command.get_opts().filter(|flag| !flag.is_required_set() && !flag.is_hide_set()) {
                let (long, help) = (flag.get_long(), flag.get_help().map(ToString::to_string).unwrap_or_default());
                // An image is needed, but for the hours of direct sun.
                let is_needed = name == "lightmesh render" && long == Some("output");
                assert_eq!(help.matches("[default: ").count(), usize::from(!is_needed), "{name} {long:?}: {help}");
            }
        }
    }
}
