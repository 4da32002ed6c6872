//! The flags of `lightmesh farm`.

use std::path::PathBuf;

use clap::Args;
use lightmesh::request::files::Files;
use lightmesh::request::{Order, Request};

use super::settings::{Flags, Motion, Others};
use super::{Chunks, SceneArg};

/// Write a job for a render farm: the frames of a film in chunks, as an Open Job Description template
///
/// The template is of specification 2023-09 with TASK_CHUNKING: `openjd run JOB.yaml` renders it here, farms take it as it
/// is. Scene, frames, size, quality and the folder of the frames are parameters of the job; paths are mapped. A task
/// renders a chunk and keeps frames that are finished, so that it can be repeated. On each machine, the tasks of a
/// session share one server (lightmesh serve), which reads the scene once.
#[derive(Debug, Args)]
pub(crate) struct FarmArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Write the job to this .yaml or .json file, or `-` (standard output, as YAML)
    #[arg(short, long, value_name = "JOB.yaml")]
    pub(crate) output: PathBuf,

    /// Write frames to files of this name; `####` or `%04d` stands for the number of the frame
    #[arg(long, value_name = "f.####.png")]
    pub(crate) frames_to: PathBuf,

    #[command(flatten)]
    pub(crate) motion: Flags<Motion>,

    #[command(flatten)]
    pub(crate) others: Flags<Others>,

    /// Write layers of each frame as a multilayer exr of this name [default: off]
    #[arg(long, value_name = "F.####.exr", help_heading = "Image")]
    pub(crate) layers: Option<PathBuf>,

    /// Write counts and timings of each frame as JSON of this name [default: off]
    #[arg(long, value_name = "F.####.json", help_heading = "Reports")]
    pub(crate) stats: Option<PathBuf>,

    /// Render so many frames in a task
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Job")]
    pub(crate) frames_per_task: u32,

    /// Choose which frames a chunk may have
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = Chunks::Noncontiguous, help_heading = "Job")]
    pub(crate) chunks: Chunks,

    /// Let each task read the scene itself, without a server
    #[arg(long, help_heading = "Job")]
    pub(crate) no_server: bool,

    /// Call the program by this name or path on the farm's machines
    #[arg(long, value_name = "PROGRAM", default_value = "lightmesh", help_heading = "Job")]
    pub(crate) program: String,

    /// Print only errors
    #[arg(short, long, help_heading = "Reports")]
    pub(crate) quiet: bool,
}

impl FarmArgs {
    /// The film that all tasks render together.
    pub(crate) fn order(&self) -> Order {
        let mut request = Request::default();
        self.scene.reading.apply(&mut request);
        self.motion.apply(&mut request);
        self.others.apply(&mut request);
        let files = Files {
            output: Some(self.frames_to.clone()),
            layers: self.layers.clone(),
            stats: self.stats.clone(),
            ..Files::default()
        };
        Order { scene: self.scene.scene.clone(), request, files }
    }
}
