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

    /// Output image; the extension determines the format: bmp, png, exr or jpg. `-` is standard output, which then has
    /// nothing else, and needs --format. A film can also go to a movie, mp4, mov, mkv or webm, which ffmpeg encodes: the
    /// program of this name, or that of LIGHTMESH_FFMPEG. Without it, --sun-hours alone is computed
    #[arg(short, long, value_name = "OUT", required_unless_present = "sun_hours")]
    pub(crate) output: Option<PathBuf>,

    /// Render a film of N frames in which the camera goes once around the scene, at constant height; frame 1 is the image
    /// without this. `####` or `%04d` in the names of output files stands for the number of the frame. Exposure and step
    /// are chosen once, from frames across the film; light points and gathered light are kept from frame to frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), group = "motion", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) turntable: Option<u32>,

    /// Render a film of the hours of a day: the sun stands under a clear sky (--sky "clear;turbidity=…") as it does at this
    /// place and date from one time to another, in steps of minutes (15m, the default) or hours (1h). The offset from
    /// universal time, or Z, holds all day. Moments with the sun below the horizon have no frame; the exposure is
    /// chosen once. As in "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m"
    #[arg(long, value_name = "LAT,LON,DATE,FROM-TO/STEP", allow_hyphen_values = true, group = "motion", conflicts_with_all = ["partial", "environment"], help_heading = "Film")]
    pub(crate) sun: Option<SunSpec>,

    /// Write the hours of direct sun of --sun, of the surface in the middle of each pixel: numbers (exr, channel `hours`),
    /// colours with a legend (png), or a table by object (csv). Repeatable; without -o, no film is rendered
    #[arg(long = "sun-hours", value_name = "F.exr|png|csv", requires = "sun", help_heading = "Film")]
    pub(crate) sun_hours: Vec<PathBuf>,

    /// Frames of the film to render: from A to B, or every N-th of them. Without --turntable and --sun the film is the
    /// scene's own animation, whose beginning is frame 1 [default: all, with --turntable, --sun or --fps]
    #[arg(long, value_name = "A-B[xN]", requires = "output", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) frames: Option<Frames>,

    /// Frames per second of the film, as a decimal or a ratio such as 30000/1001: how far the scene's own animation goes from
    /// one to the next, and how fast a movie is shown [default: 24]
    #[arg(long, value_name = "F", requires = "output", conflicts_with = "partial", help_heading = "Film")]
    pub(crate) fps: Option<FrameRate>,

    /// Go on with a film that has ended early, as if it had not: frames whose files are as manifest.json beside them
    /// records are kept, and all others rendered with the recorded exposure and step. Refused if scene or settings are
    /// not those of the film; begins the film if there is no record of it
    #[arg(long, requires = "output", conflicts_with_all = ["overwrite", "skip_existing"], help_heading = "Film")]
    pub(crate) resume: bool,

    /// Leave frames whose image exists as they are, whatever made them, and render the others
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

    /// Write per-pixel data as a multilayer exr: colour, depth, normal, position, visibility and radiance of each light, number of light
    /// points used, ids and Cryptomattes of objects and materials; `-` is standard output [default: off]
    #[arg(long, value_name = "F.exr", requires = "output", help_heading = "Image")]
    pub(crate) layers: Option<PathBuf>,

    /// Read what light points see, and the light that surfaces gathered, from this file before the first image, if it exists, and write
    /// it there after the last: for later runs, other cameras and other devices, with --lookup half-ball or --ambient-light mesh.
    /// Images are the same without it. A file of other surfaces or another step, or one that is damaged, is replaced, with a
    /// warning; so is its gathered light alone if lights, surroundings or materials are others. What light points see of a light that
    /// has changed is computed anew
    #[arg(long, value_name = "F", requires = "output", help_heading = "Machine")]
    pub(crate) mesh_file: Option<PathBuf>,

    /// Write counts, timings and all resolved settings as JSON; `-` is standard output. The time of the render excludes
    /// file input and output [default: off]
    #[arg(long, value_name = "F.json", requires = "output", help_heading = "Reports")]
    pub(crate) stats: Option<PathBuf>,

    /// How to show progress on stderr
    #[arg(long, value_enum, default_value_t = Progress::Auto, help_heading = "Reports")]
    pub(crate) progress: Progress,

    /// Print only errors, and progress only if --progress requests it
    #[arg(short, long, help_heading = "Reports")]
    pub(crate) quiet: bool,

    /// Print more: why no CUDA device can be used; how many normals were made (--smooth); seconds of each stage, counts and memory
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
    /// How visibility is computed
    #[arg(long, value_parser = words::mode(), default_value_t = Mode::LightMesh, help_heading = "Method")]
    pub(crate) mode: Mode,

    /// Maximum depth of mirror reflections, in any mode
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) bounces: u32,

    /// Light-mesh step h in scene units; auto derives it from the size of a pixel in the scene [default: the scene's, else auto]
    #[arg(long, value_name = "H|auto", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) step: Option<Step>,

    /// Interpolation radius in steps, r/h [default: the scene's, else 2.1]
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Method")]
    pub(crate) radius: Option<Positive>,

    /// Weight of a light point at distance d, with q = d/r [default: the scene's, else smooth]
    #[arg(long, value_parser = words::weight(), help_heading = "Method")]
    pub(crate) weight: Option<Weight>,

    /// How light-mesh mode finds the visibility of a light
    #[arg(long, value_parser = words::lookup(), default_value_t = Lookup::Auto, help_heading = "Method")]
    pub(crate) lookup: Lookup,

    /// Samples of each light with a size, and of each pixel: how smooth soft shadows and edges are
    #[arg(long, value_parser = words::quality(), default_value_t = Quality::Good, help_heading = "Method")]
    pub(crate) quality: Quality,

    /// Samples of a pixel, in any mode; 1 is its centre [default: by --quality; 1 with half-ball, ray-trace and area]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536), help_heading = "Image")]
    pub(crate) aa: Option<u32>,

    /// Filter over which the colour of a pixel with several samples is averaged
    #[arg(long, value_parser = words::filter(), default_value_t = Filter::BlackmanHarris, help_heading = "Image")]
    pub(crate) filter: Filter,

    /// How short tests are evaluated; the image is the same
    #[arg(long, value_parser = words::short_tests(), default_value_t = ShortTests::Cells, help_heading = "Method")]
    pub(crate) short_tests: ShortTests,

    /// Number of samples of each light with a size, in a pixel (lists, adaptive, area) or at a light point (half-ball)
    /// [default: by --quality / 225 / 4]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65535), help_heading = "Method")]
    pub(crate) samples: Option<u32>,

    /// Seed of the sampling pattern: same seed, same image
    #[arg(long, value_name = "S", allow_negative_numbers = true, default_value_t = 0, help_heading = "Method")]
    pub(crate) seed: u64,

    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", help_heading = "Image")]
    pub(crate) size: Size,

    /// Only these pixels of the image: column and row of the first, width and height; they are the same as in the whole
    #[arg(long, value_name = "X,Y,W,H", help_heading = "Image")]
    pub(crate) crop: Option<Crop>,

    /// What is behind the scene: a colour, as one number, r,g,b or "#rrggbb" (sRGB), or transparent, which writes an alpha channel to png and exr
    /// files; mirrors then still reflect the scene's background [default: the scene's, else black]
    #[arg(long, value_name = "COLOUR|transparent", allow_hyphen_values = true, help_heading = "Image")]
    pub(crate) background: Option<Background>,

    /// Catch the scene's shadows on a ground below it, which shows the background, or is transparent with it
    /// [background: the scene's, else what is shown as 0.8 at the image's exposure]
    #[arg(long, help_heading = "Scene")]
    pub(crate) ground: bool,

    /// Keep what is finished when the run is interrupted: the rows that are rendered by then, over the background or
    /// transparent, in all files of the run; a second Ctrl-C ends it at once. The image is rendered in bands, with the
    /// same result
    #[arg(long, help_heading = "Image")]
    pub(crate) partial: bool,

    /// Position, target and vertical field of view in degrees, as in "0,2,5;0,1,0;45" [default: the scene's first camera, else
    /// one that frames the scene]
    #[arg(long, value_name = "P;T;VFOV", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) camera: Option<CameraView>,

    /// Use the scene's camera of this name
    #[arg(long, value_name = "NAME", conflicts_with = "camera", help_heading = "Scene")]
    pub(crate) camera_name: Option<String>,

    /// Up axis for --camera and for the camera of a scene without one
    #[arg(long, value_enum, default_value_t = Up::Auto, help_heading = "Scene")]
    pub(crate) up: Up,

    /// Replace the scene's lights: position, intensity (one number or r,g,b; 1 if omitted) and radius, as in
    /// "3,8,2;0.9,0.8,0.7;0.25"; repeatable. With a radius above 0 the light is a ball, which area and light-mesh mode sample
    /// [default: the scene's, else a key light above the camera and a weaker fill light on the other side, or, if that would not reach what
    /// the camera sees, both in that space]
    #[arg(long = "light", value_name = "P[;I[;RADIUS]]", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) lights: Vec<LightSpec>,

    /// Distance falloff of the lights of --light
    #[arg(long, value_parser = words::falloff(), default_value_t = Falloff::None, requires = "lights", help_heading = "Scene")]
    pub(crate) falloff: Falloff,

    /// Ambient intensity: one number or r,g,b [default: the mean of --sky or --environment, else the scene's, else 0.1, or a tenth of what photometric lights give, or 0.2 with
    /// default lights in the space that the camera sees]
    #[arg(long, value_name = "V", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) ambient: Option<Color>,

    /// What stands for light that comes from no light directly: from the sky, and from other surfaces
    #[arg(long, value_name = "SOURCE", value_parser = words::ambient_light(), default_value_t = AmbientSource::Auto, help_heading = "Scene")]
    pub(crate) ambient_light: AmbientSource,

    /// A sky around the scene: clear (Hosek and Wilkie's, with its sun), uniform or gradient, and after semicolons
    /// sun=ELEVATION,AZIMUTH in degrees, clockwise from north, or place=LATITUDE,LONGITUDE and time=2026-06-21T15:00+02:00; turbidity=T
    /// (haze, 1 to 10); ground=V (what it reflects; below a gradient its radiance); color=V; zenith=V; horizon=V; north=DEGREES (clockwise
    /// from -Z if Y is up, from +Y if Z is); strength=S. It replaces the scene's directional lights, ambient light and background; with
    /// alone, all its lights. The camera, mirrors and --ground see it. White that faces the sun shows about 1
    /// [default: none; clear is sun=40,225;turbidity=3;ground=0.2]
    #[arg(long, value_name = "SPEC", allow_hyphen_values = true, help_heading = "Scene")]
    pub(crate) sky: Option<SkySpec>,

    /// A panorama around the scene: an equirectangular .hdr or .exr image, north in its middle, and after semicolons rotation=DEGREES
    /// (clockwise from above), strength=S, alone. Its sun, if it shows one, becomes a light. Replaces what --sky does
    #[arg(long, value_name = "FILE[;OPTIONS]", conflicts_with = "sky", help_heading = "Scene")]
    pub(crate) environment: Option<EnvironmentSpec>,

    /// Acceleration structure
    #[arg(long, value_parser = words::acceleration(), default_value_t = Acceleration::Auto, help_heading = "Machine")]
    pub(crate) accel: Acceleration,

    /// Cells of the acceleration grid along each axis; implies --accel grid [default: from the number of triangles]
    #[arg(long, value_name = "NXxNYxNZ", conflicts_with = "grid_file", help_heading = "Machine")]
    pub(crate) grid: Option<Dims>,

    /// Load the acceleration grid saved by `lightmesh grid`; implies --accel grid
    #[arg(long, value_name = "F", help_heading = "Machine")]
    pub(crate) grid_file: Option<PathBuf>,
}

/// How bright image files are.
#[derive(Clone, Debug, Args)]
pub(crate) struct ExposureArgs {
    /// Exposure of 8-bit files in stops, each of which doubles the brightness; auto brings any light level into range, whatever a ground
    /// shows. Does not affect exr files and --layers [default: auto if a light has a photometric unit (inverse-square falloff), else 0]
    #[arg(long, value_name = "STOPS|auto", allow_negative_numbers = true, help_heading = "Image")]
    pub(crate) exposure: Option<Exposure>,
}

/// How image files store what they show.
#[derive(Clone, Debug, Args)]
pub(crate) struct StorageArgs {
    /// Format of the output image [default: by the extension]
    #[arg(long, value_parser = words::image_format(), help_heading = "Image")]
    pub(crate) format: Option<Format>,

    /// Transfer function of 8-bit files; exr files are always linear
    #[arg(long, value_parser = words::transfer(), default_value_t = Transfer::Srgb, help_heading = "Image")]
    pub(crate) transfer: Transfer,

    /// How 8-bit and 16-bit files show what is brighter than white; exr files are always linear
    #[arg(long, value_parser = words::view(), default_value_t = View::Standard, help_heading = "Image")]
    pub(crate) view: View,

    /// Bits per channel of png files
    #[arg(long, value_name = "N", value_parser = words::bit_depth(), default_value = "8", help_heading = "Image")]
    pub(crate) bit_depth: BitDepth,

    /// Round 8-bit codes up and down in a fine fixed pattern, so that smooth gradients have no bands. Exact codes, such as black and white,
    /// stay as they are; files become larger
    #[arg(long, value_enum, default_value_t = Switch::Off, help_heading = "Image")]
    pub(crate) dither: Switch,

    /// Numbers of exr files; depth, positions, counts and mattes of --layers are always float, ids whole numbers
    #[arg(long, value_parser = words::exr_type(), default_value_t = ExrSamples::Float, help_heading = "Image")]
    pub(crate) exr_type: ExrSamples,

    /// Lossless compression of exr files
    #[arg(long, value_parser = words::exr_compression(), default_value_t = ExrCompression::Zip, help_heading = "Image")]
    pub(crate) exr_compression: ExrCompression,

    /// How --layers are divided
    #[arg(long, value_parser = words::exr_parts(), default_value_t = ExrParts::Single, help_heading = "Image")]
    pub(crate) exr_parts: ExrParts,
}

/// How meshes and animations are read.
#[derive(Clone, Debug, Args)]
pub(crate) struct FormArgs {
    /// The animation of a glTF file that is played, by name [default: the first, and those after it that move other things]
    #[arg(long, value_name = "NAME", help_heading = "Film")]
    pub(crate) animation: Option<String>,

    /// Crease angle in degrees: OBJ, PLY and STL files without normals are smooth across edges where triangles meet at less, and across no
    /// other edge. off shows every triangle as it is. OBJ smoothing groups are honoured; glTF files and files with normals are not changed
    /// [default: 30; off with --lookup half-ball]
    #[arg(long, value_name = "DEGREES|off", allow_negative_numbers = true, help_heading = "Scene")]
    pub(crate) smooth: Option<Smooth>,

    /// Whether meshes that a scene shows in many places are stored once: what takes too long or too much memory as copies becomes possible.
    /// Rays take longer. Grids and brute force need copies
    #[arg(long, value_name = "WHEN", value_parser = words::instances(), default_value_t = Instancing::Auto, help_heading = "Scene")]
    pub(crate) instances: Instancing,
}

/// What the work is done by.
#[derive(Clone, Debug, Args)]
pub(crate) struct MachineArgs {
    /// Device: auto, cpu, cuda (the first CUDA device that works) or cuda:N; auto uses the fastest that works, cuda before cpu,
    /// and reports which and why. `lightmesh info --devices` lists devices; CUDA_VISIBLE_DEVICES hides and renumbers them
    #[arg(long, value_name = "DEVICE", default_value = "auto", help_heading = "Machine")]
    pub(crate) device: Device,

    /// CPU threads [default: all]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = "Machine")]
    pub(crate) threads: Option<u32>,
}
