//! The flags of `lightmesh render`.

use std::path::{Path, PathBuf};

use clap::Args;
use lightmesh::image::{BitDepth, ExrCompression, ExrParts, ExrSamples, Format, View};
use lightmesh::render::{AmbientSource, Crop, Filter, Quality, ShortTests};
use lightmesh::scene::{Falloff, Instancing, Weight};
use lightmesh::{Acceleration, Device, Lookup, Mode, Step, Transfer};

use super::{Progress, SceneArg, Switch, Up, words};
use crate::value::{
    Background, CameraView, Color, Dims, EnvironmentSpec, Exposure, FrameRate, Frames, LightSpec, Positive, Size,
    SkySpec, Smooth, SunSpec,
};

/// Render an image of a scene
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArg,

    /// Write the image to this .bmp, .png, .exr or .jpg file, or `-` (standard output, with --format); a film also to
    /// .mp4, .mov, .mkv or .webm, by ffmpeg
    #[arg(short, long, value_name = "OUT", required_unless_present = "sun_hours")]
    pub(crate) output: Option<PathBuf>,

    /// Turn the camera once around the scene in N frames; `####` or `%04d` in file names stands for the number of the
    /// frame [default: off]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), group = "motion", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) turntable: Option<u32>,

    /// Render a day under a clear sky, a frame for each STEP in minutes or hours, as in
    /// "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m" [default: off]
    #[arg(long, value_name = "LAT,LON,DATE,FROM-TO/STEP", allow_hyphen_values = true, group = "motion", conflicts_with_all = ["partial", "environment", "studio"], help_heading = "Film")]
    pub(crate) sun: Option<SunSpec>,

    /// Write the hours of direct sun in each pixel of --sun, as numbers (exr), colours (png) or a table of objects (csv);
    /// repeatable; needs no -o [default: off]
    #[arg(long = "sun-hours", value_name = "F.exr|png|csv", requires = "sun", help_heading = "Film")]
    pub(crate) sun_hours: Vec<PathBuf>,

    /// Render frames A to B, or every N-th of them, of the scene's animation, --turntable or --sun [default: all, with
    /// --fps, --turntable or --sun]
    #[arg(long, value_name = "A-B[xN]", requires = "output", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) frames: Option<Frames>,

    /// Set the frames per second of animation and movie, as a decimal or a ratio such as 30000/1001 [default: 24]
    #[arg(long, value_name = "F", requires = "output", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) fps: Option<FrameRate>,

    /// Resume an interrupted film, with an identical result, or begin it; fails if scene or settings differ from those in
    /// manifest.json
    #[arg(long, requires = "output", conflicts_with_all = ["overwrite", "skip_existing"], help_heading = "Film")]
    pub(crate) resume: bool,

    /// Keep frames whose image exists, and render the others
    #[arg(long, requires = "output", conflicts_with = "overwrite", help_heading = "Film")]
    pub(crate) skip_existing: bool,

    /// Replace frames whose image exists
    #[arg(long, requires = "output", help_heading = "Film")]
    pub(crate) overwrite: bool,

    #[command(flatten)]
    pub(crate) form: FormArgs,

    #[command(flatten)]
    pub(crate) storage: StorageArgs,

    #[command(flatten)]
    pub(crate) exposure: ExposureArgs,

    #[command(flatten)]
    pub(crate) image: ImageArgs,

    #[command(flatten)]
    pub(crate) machine: MachineArgs,

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
    /// The output image; an empty path if there is none.
    pub(crate) fn picture(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(""))
    }
}

/// What an image shows, and how it is computed.
#[derive(Clone, Debug, Args)]
pub(crate) struct ImageArgs {
    /// Compute shadows by this method
    #[arg(long, value_parser = words::mode(), default_value_t = Mode::LightMesh, help_heading = "Method")]
    pub(crate) mode: Mode,

    /// Follow mirror reflections to this depth, in any mode; in the studio, at least to 1
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) bounces: u32,

    /// Set the light-mesh step h in scene units; auto derives it from the size of a pixel in the scene [default: the
    /// scene's, else auto]
    #[arg(long, value_name = "H|auto", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) step: Option<Step>,

    /// Set the interpolation radius in steps, r/h [default: the scene's, else 2.1]
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) radius: Option<Positive>,

    /// Weight light points at distance d by their q = d/r [default: the scene's, else smooth]
    #[arg(long, value_parser = words::weight(), help_heading = "Method")]
    pub(crate) weight: Option<Weight>,

    /// Find the visibility of lights in light-mesh mode by this method
    #[arg(long, value_parser = words::lookup(), default_value_t = Lookup::Auto, help_heading = "Method")]
    pub(crate) lookup: Lookup,

    /// Choose the number of samples of lights with a size and of pixels
    #[arg(long, value_parser = words::quality(), default_value_t = Quality::Good, help_heading = "Method")]
    pub(crate) quality: Quality,

    /// Take N samples of each pixel, in any mode; 1 is its centre [default: by --quality; 1 with half-ball, ray-trace and
    /// area]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Image")]
    pub(crate) aa: Option<u32>,

    /// Average the samples of a pixel by this filter
    #[arg(long, value_parser = words::filter(), default_value_t = Filter::BlackmanHarris, help_heading = "Image")]
    pub(crate) filter: Filter,

    /// Evaluate short tests by this method; the image is the same
    #[arg(long, value_parser = words::short_tests(), default_value_t = ShortTests::Cells, help_heading = "Method")]
    pub(crate) short_tests: ShortTests,

    /// Take N samples of each light with a size, in each pixel or, with half-ball, at each light point [default: by
    /// --quality; area 225, half-ball 4]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65535), help_heading = "Method")]
    pub(crate) samples: Option<u32>,

    /// Seed the sampling pattern: same seed, same image
    #[arg(long, value_name = "S", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) seed: u64,

    /// Set width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", help_heading = "Image")]
    pub(crate) size: Size,

    /// Render only this part: column and row of its first pixel, width and height; its pixels stay the same [default: the
    /// whole image]
    #[arg(long, value_name = "X,Y,W,H", help_heading = "Image")]
    pub(crate) crop: Option<Crop>,

    /// Set the background: one number, r,g,b, "#rrggbb" (sRGB) or transparent, which gives png and exr files an alpha
    /// channel [default: the scene's, else black or the studio's]
    #[arg(long, value_name = "COLOUR|transparent", allow_hyphen_values = true, help_heading = "Image")]
    pub(crate) background: Option<Background>,

    /// Add a ground below the scene that catches its shadows and shows the background, or is transparent with it
    #[arg(long, help_heading = "Scene")]
    pub(crate) ground: bool,

    /// Light the model in a studio, in interiors, too; not beside other light [default: where there is no light and no
    /// background]
    #[arg(long, conflicts_with_all = ["no_studio", "lights", "sky", "environment", "ambient", "background", "grid_file"], help_heading = "Scene")]
    pub(crate) studio: bool,

    /// Give a model without lights a key light and a fill light only, and under --sky no ground and horizon
    #[arg(long, help_heading = "Scene")]
    pub(crate) no_studio: bool,

    /// Keep finished rows if the run is interrupted; a second Ctrl-C ends it at once
    #[arg(long, help_heading = "Image")]
    pub(crate) partial: bool,

    /// Place the camera: position, target and vertical field of view in degrees, as in "0,2,5;0,1,0;45" [default: the
    /// scene's first, else one that frames the scene]
    #[arg(long, value_name = "P;T;VFOV", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) camera: Option<CameraView>,

    /// Use the scene's camera of this name [default: the first]
    #[arg(long, value_name = "NAME", conflicts_with = "camera", help_heading = "Scene")]
    pub(crate) camera_name: Option<String>,

    /// Set the up axis for --camera, and for scenes without a camera
    #[arg(long, value_enum, default_value_t = Up::Auto, help_heading = "Scene")]
    pub(crate) up: Up,

    /// Replace the scene's lights: position, intensity (one number or r,g,b) and radius, as in "3,8,2;0.9;0.25";
    /// repeatable [default: the scene's, else a studio]
    #[arg(long = "light", value_name = "P[;I[;RADIUS]]", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) lights: Vec<LightSpec>,

    /// Set how the lights of --light fall off with distance
    #[arg(long, value_parser = words::falloff(), default_value_t = Falloff::None, requires = "lights", help_heading = "Scene")]
    pub(crate) falloff: Falloff,

    /// Set the ambient intensity, one number or r,g,b [default: the mean of the sky or environment, else the scene's,
    /// else 0.1 or suited to the lights]
    #[arg(long, value_name = "V", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) ambient: Option<Color>,

    /// Choose how surfaces get light from the sky and from each other
    #[arg(long, value_name = "SOURCE", value_parser = words::ambient_light(), default_value_t = AmbientSource::Auto, help_heading = "Scene")]
    pub(crate) ambient_light: AmbientSource,

    /// Set the sky: clear, uniform or gradient, as in "clear;sun=40,225"; also place, time, turbidity, ground, color,
    /// zenith, horizon, north, strength, alone [default: none]
    #[arg(long, value_name = "SPEC", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) sky: Option<SkySpec>,

    /// Put the scene into an equirectangular .hdr or .exr panorama, as in "street.hdr;rotation=90;strength=2;alone"
    /// [default: none]
    #[arg(long, value_name = "FILE[;OPTIONS]", conflicts_with = "sky", help_heading = "Scene")]
    pub(crate) environment: Option<EnvironmentSpec>,

    /// Choose the acceleration structure
    #[arg(long, value_parser = words::acceleration(), default_value_t = Acceleration::Auto, help_heading = "Machine")]
    pub(crate) accel: Acceleration,

    /// Set the cells of the grid along each axis; implies --accel grid [default: from the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ", conflicts_with = "grid_file", help_heading = "Machine")]
    pub(crate) grid: Option<Dims>,

    /// Load the grid that `lightmesh grid` saved; implies --accel grid [default: none]
    #[arg(long, value_name = "F", help_heading = "Machine")]
    pub(crate) grid_file: Option<PathBuf>,
}

/// How bright image files are.
#[derive(Clone, Debug, Args)]
pub(crate) struct ExposureArgs {
    /// Brighten 8-bit and 16-bit files by this many stops; auto suits any light; exr stays linear [default: auto with
    /// photometric lights, by what is seen under --sky, else 0]
    #[arg(long, value_name = "STOPS|auto", allow_negative_numbers = true, help_heading = "Image")]
    pub(crate) exposure: Option<Exposure>,
}

/// How image files store what they show.
#[derive(Clone, Debug, Args)]
pub(crate) struct StorageArgs {
    /// Write the image in this format [default: by the extension]
    #[arg(long, value_parser = words::image_format(), help_heading = "Image")]
    pub(crate) format: Option<Format>,

    /// Encode 8-bit and 16-bit files by this function; exr files stay linear
    #[arg(long, value_parser = words::transfer(), default_value_t = Transfer::Srgb, help_heading = "Image")]
    pub(crate) transfer: Transfer,

    /// Show colours brighter than white in this way; exr files stay linear
    #[arg(long, value_parser = words::view(), default_value_t = View::Standard, help_heading = "Image")]
    pub(crate) view: View,

    /// Write png files with this many bits per channel
    #[arg(long, value_name = "N", value_parser = words::bit_depth(), default_value = "8", help_heading = "Image")]
    pub(crate) bit_depth: BitDepth,

    /// Dither 8-bit files against bands in smooth gradients; files become larger
    #[arg(long, value_enum, default_value_t = Switch::Off, help_heading = "Image")]
    pub(crate) dither: Switch,

    /// Store exr files as these numbers
    #[arg(long, value_parser = words::exr_type(), default_value_t = ExrSamples::Float, help_heading = "Image")]
    pub(crate) exr_type: ExrSamples,

    /// Compress exr files without loss
    #[arg(long, value_parser = words::exr_compression(), default_value_t = ExrCompression::Zip, help_heading = "Image")]
    pub(crate) exr_compression: ExrCompression,

    /// Divide the channels of --layers into parts
    #[arg(long, value_parser = words::exr_parts(), default_value_t = ExrParts::Single, help_heading = "Image")]
    pub(crate) exr_parts: ExrParts,
}

/// How meshes and animations are read.
#[derive(Clone, Debug, Args)]
pub(crate) struct FormArgs {
    /// Play the animation of this name in a glTF file [default: all that do not conflict]
    #[arg(long, value_name = "NAME", help_heading = "Film")]
    pub(crate) animation: Option<String>,

    /// Smooth edges below this crease angle in OBJ, PLY and STL files without normals; off shows facets [default: 30; off
    /// with --lookup half-ball]
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, help_heading = "Scene")]
    pub(crate) smooth: Option<Smooth>,

    /// Store meshes in many places once: less memory, slower rays
    #[arg(long, value_name = "WHEN", value_parser = words::instances(), default_value_t = Instancing::Auto, help_heading = "Scene")]
    pub(crate) instances: Instancing,
}

/// What the work is done by.
#[derive(Clone, Debug, Args)]
pub(crate) struct MachineArgs {
    /// Render on cpu, cuda (the first CUDA device that works), cuda:N or auto, the fastest that works; `lightmesh info
    /// --devices` lists them
    #[arg(long, value_name = "DEVICE", default_value = "auto", help_heading = "Machine")]
    pub(crate) device: Device,

    /// Use N CPU threads [default: all]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = "Machine")]
    pub(crate) threads: Option<u32>,
}
