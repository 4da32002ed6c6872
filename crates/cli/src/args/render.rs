//! The flags of `lightmesh render`.

use std::path::PathBuf;

use clap::Args;
use lightmesh::Device;

use super::{Accel, Falloff, Lookup, Mode, Progress, SceneArg, ShortTests, Transfer, Up, Weight};
use crate::value::{ByteSize, CameraView, Color, Dims, Exposure, LightSpec, Positive, Size, StepValue};

/// Render one picture of a scene
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Where the picture goes; the extension chooses the format: bmp, png, exr or jpg
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// How visibility is found
    #[arg(long, value_enum, default_value_t = Mode::LightMesh, help_heading = "Method")]
    pub(crate) mode: Mode,

    /// Depth of mirror recursion, in any mode
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) bounces: u32,

    /// Light-mesh step h in scene units; auto ties it to the size of a pixel in the scene [default: the scene's, else auto]
    #[arg(long, value_name = "H|auto", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) step: Option<StepValue>,

    /// Interpolation radius in steps, r/h [default: the scene's, else 2.1]
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) radius: Option<Positive>,

    /// Weight of a light point at distance d, with q = d/r [default: the scene's, else smooth]
    #[arg(long, value_enum, help_heading = "Method")]
    pub(crate) weight: Option<Weight>,

    /// How light-mesh mode finds the visibility of a light
    #[arg(long, value_enum, default_value_t = Lookup::Auto, help_heading = "Method")]
    pub(crate) lookup: Lookup,

    /// How short tests are evaluated; the picture is the same
    #[arg(long, value_enum, default_value_t = ShortTests::Cells, help_heading = "Method")]
    pub(crate) short_tests: ShortTests,

    /// Shadow rays per light (area), or per light point and light that has a size (light-mesh) [default: 225 / 4]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65535), help_heading = "Method")]
    pub(crate) samples: Option<u32>,

    /// Random pattern of sampled lights: same seed, same picture
    #[arg(long, value_name = "S", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) seed: u64,

    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", help_heading = "Picture")]
    pub(crate) size: Size,

    /// Transfer function of 8-bit files; an exr is always linear
    #[arg(long, value_enum, default_value_t = Transfer::Srgb, help_heading = "Picture")]
    pub(crate) transfer: Transfer,

    /// How many stops brighter 8-bit files show the picture, one stop doubling it; auto brings any light level into range. An exr
    /// and --layers hold what was computed
    #[arg(
        long,
        value_name = "STOPS|auto",
        allow_negative_numbers = true,
        default_value = "0",
        help_heading = "Picture"
    )]
    pub(crate) exposure: Exposure,

    /// Write what each pixel saw as a multilayer exr: colour, depth, normal, position, visibility of each light, light
    /// points used [default: off]
    #[arg(long, value_name = "F.exr", help_heading = "Picture")]
    pub(crate) layers: Option<PathBuf>,

    /// Position, target and vertical angle in degrees, as in "0,2,5;0,1,0;45" [default: the scene's first camera, else one
    /// that frames the scene]
    #[arg(long, value_name = "P;T;VFOV", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) camera: Option<CameraView>,

    /// Take the scene's camera of this name
    #[arg(long, value_name = "NAME", conflicts_with = "camera", help_heading = "Scene")]
    pub(crate) camera_name: Option<String>,

    /// Which way is up for --camera and for the camera that frames the scene
    #[arg(long, value_enum, default_value_t = Up::Auto, help_heading = "Scene")]
    pub(crate) up: Up,

    /// Replace the scene's lights: position, intensity (one number or r,g,b; 1 where left out) and radius, as in
    /// "3,8,2;0.9,0.8,0.7;0.25"; repeatable. A radius above 0 makes a ball, which area and light-mesh mode sample
    /// [default: the scene's, else a key light above the camera and a weaker fill light on its other side]
    #[arg(long = "light", value_name = "P[;I[;RADIUS]]", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) lights: Vec<LightSpec>,

    /// What distance does to the lights of --light
    #[arg(long, value_enum, default_value_t = Falloff::None, requires = "lights", help_heading = "Scene")]
    pub(crate) falloff: Falloff,

    /// Ambient intensity, one number or r,g,b [default: the scene's, else 0.1]
    #[arg(long, value_name = "V", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) ambient: Option<Color>,

    /// Where to compute: auto, cpu, cuda (the first CUDA device that works) or cuda:N; auto takes the fastest that works, cuda
    /// before cpu, and says which and why. `lightmesh info --devices` lists them; CUDA_VISIBLE_DEVICES hides and renumbers them
    #[arg(long, value_name = "DEVICE", default_value = "auto", help_heading = "Machine")]
    pub(crate) device: Device,

    /// CPU threads [default: all]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = "Machine")]
    pub(crate) threads: Option<u32>,

    /// Acceleration structure
    #[arg(long, value_enum, default_value_t = Accel::Auto, help_heading = "Machine")]
    pub(crate) accel: Accel,

    /// Cells of the acceleration grid along each axis; implies --accel grid [default: after the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ", conflicts_with = "grid_file", help_heading = "Machine")]
    pub(crate) grid: Option<Dims>,

    /// Take the acceleration grid that `lightmesh grid` kept; implies --accel grid
    #[arg(long, value_name = "F", help_heading = "Machine")]
    pub(crate) grid_file: Option<PathBuf>,

    /// Memory to stay under, work is split to fit: bytes, or with K, M, G, T (or KiB, …) in steps of 1024, or kB, MB, GB,
    /// TB in steps of 1000 [default: free memory less a reserve]
    #[arg(long, value_name = "SIZE", help_heading = "Machine")]
    pub(crate) memory_limit: Option<ByteSize>,

    /// Write counts, seconds and every resolved setting as JSON. Seconds are of the render alone, file input and output
    /// apart [default: off]
    #[arg(long, value_name = "F.json", help_heading = "Reports")]
    pub(crate) stats: Option<PathBuf>,

    /// Progress on stderr
    #[arg(long, value_enum, default_value_t = Progress::Auto, help_heading = "Reports")]
    pub(crate) progress: Progress,

    /// Print nothing but errors, and progress only where --progress asks for it
    #[arg(short, long, help_heading = "Reports")]
    pub(crate) quiet: bool,
}
