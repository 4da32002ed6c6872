//! The flags of `lightmesh render`.

use std::path::PathBuf;

use clap::Args;
use lightmesh::request::files::Files;
use lightmesh::request::{Order, Request};

use super::settings::{Flags, Motion, Others};
use super::{Progress, SceneArg};

/// Render an image of a scene
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Write the image to this .bmp, .png, .exr or .jpg file, or `-` (standard output, with --format); a film also to
    /// .mp4, .mov, .mkv or .webm, by ffmpeg
    #[arg(short, long, value_name = "OUT", required_unless_present_any = ["sun_hours", "sun"])]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) motion: Flags<Motion>,

    /// Write the hours of direct sun in each pixel of --sun, as numbers (exr), colours (png) or a table of objects (csv);
    /// repeatable; needs no -o [default: off]
    #[arg(long = "sun-hours", value_name = "F.exr|png|csv", requires = "sun", help_heading = "Film")]
    pub(crate) sun_hours: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) others: Flags<Others>,

    /// Write depth, normals, positions, the light of each lamp, ids and Cryptomattes as a multilayer exr; `-` is standard
    /// output [default: off]
    #[arg(long, value_name = "F.exr", requires = "output", help_heading = "Image")]
    pub(crate) layers: Option<PathBuf>,

    /// Keep light points (--lookup half-ball) and gathered light (--ambient-light mesh) from run to run in this file;
    /// images stay the same [default: off]
    #[arg(long, value_name = "F", requires = "output", help_heading = "Machine")]
    pub(crate) mesh_file: Option<PathBuf>,

    /// Write counts, timings and resolved settings as JSON; `-` is standard output [default: off]
    #[arg(long, value_name = "F.json", requires = "output", help_heading = "Reports")]
    pub(crate) stats: Option<PathBuf>,

    /// Have the server at this socket render, which `lightmesh serve` has started: devices are awake there, and the scene
    /// that was rendered last is ready [default: off]
    #[arg(long, value_name = "PATH", help_heading = "Machine")]
    pub(crate) server: Option<PathBuf>,

    /// Show progress on stderr
    #[arg(long, value_enum, default_value_t = Progress::Auto, help_heading = "Reports")]
    pub(crate) progress: Progress,

    /// Print only errors; --progress bar and json still show progress
    #[arg(short, long, help_heading = "Reports")]
    pub(crate) quiet: bool,

    /// Print more: why devices cannot be used, normals made by --smooth, seconds of each stage, counts and memory
    #[arg(short, long, conflicts_with = "quiet", help_heading = "Reports")]
    pub(crate) verbose: bool,
}

impl RenderArgs {
    /// What is asked for.
    pub(crate) fn order(&self) -> Order {
        let mut request = Request::default();
        self.scene.reading.apply(&mut request);
        self.motion.apply(&mut request);
        self.others.apply(&mut request);
        let files = Files {
            output: self.output.clone(),
            layers: self.layers.clone(),
            stats: self.stats.clone(),
            sun_hours: self.sun_hours.clone(),
            mesh_file: self.mesh_file.clone(),
        };
        Order { scene: self.scene.scene.clone(), request, files }
    }
}
