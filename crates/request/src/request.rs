//! The request: everything that decides what a picture of a file shows, in one type.

use std::path::PathBuf;

use lightmesh_image::{BitDepth, ExrCompression, ExrParts, ExrSamples, Format, Transfer, View};
use lightmesh_render::{
    Acceleration, AmbientSource, Crop, Device, Filter, Glass, Lookup, Mode, Quality, ShortTests, Step,
};
use lightmesh_scene::{Falloff, Instancing, SceneFormat, Weight};

use crate::items::Slot;
use crate::table::{FieldOf, Group};
use crate::value::{
    Background, ByteSize, CameraView, Color, Dims, EnvironmentSpec, Exposure, FrameRate, Frames, LightSpec, Positive,
    Size, SkySpec, Smooth, SunSpec, Switch, UpChoice,
};

/// A setting: a field of [`Request`].
pub type Field = FieldOf<Request>;

/// Declares the fields of [`Request`] and the table of them. An entry is
///
/// ```text
/// /// What it means, with `names` of settings in backquotes.
/// Group "Heading" name: Type = default, placeholder "N", in 1..=9, conflicts [other], requires other, of light_points, bytes same;
/// ```
///
/// of which all after the type may be left out. `of light_points`: it means nothing without them. `bytes same`: those of images do not depend on
/// it.
macro_rules! settings {
    ($(
        $(#[doc = $doc:literal])+
        $group:ident $heading:literal $name:ident: $type:ty $(= $default:expr)? $(, placeholder $placeholder:literal)?
        $(, in $range:expr)? $(, conflicts [$($conflict:ident),*])? $(, requires $requires:ident)? $(, of $of:ident)?
        $(, bytes $bytes:ident)?;
    )*) => {
        /// What a picture of a scene is, and how it is made. The default is what `lightmesh render FILE` does.
        ///
        /// It is read and written by serde, with the names of its fields: fields that are left out have their defaults. Values may be text, as on the
        /// command line (`"640x480"`), or what they hold (`[640, 480]`).
        #[derive(Clone, Debug, PartialEq)]
        pub struct Request {
            $($(#[doc = $doc])+ pub $name: $type,)*
        }

        impl Default for Request {
            fn default() -> Request {
                Request { $($name: settings!(@default $($default)?),)* }
            }
        }

        /// All settings, in the order in which they are listed.
        pub static FIELDS: &[Field] = &[$(FieldOf {
            name: stringify!($name),
            doc: concat!($($doc),+),
            group: Group::$group,
            heading: $heading,
            placeholder: settings!(@text $($placeholder)?),
            kind: <$type as Slot>::KIND,
            minus: <$type as Slot>::MINUS,
            shape: <$type as Slot>::SHAPE,
            choices: <$type as Slot>::choices,
            range: settings!(@range $($range)?),
            conflicts: &[$($(stringify!($conflict)),*)?],
            requires: settings!(@requires $($requires)?),
            is_of_light_points: settings!(@of $($of)?),
            decides_bytes: settings!(@decides $($bytes)?),
            set: |request, value| request.$name.set(value),
            get: |request| request.$name.get(),
        }),*];
    };
    (@default) => { Default::default() };
    (@default $default:expr) => { $default };
    (@text) => { "" };
    (@text $text:literal) => { $text };
    (@range) => { None };
    (@range $range:expr) => { Some($range) };
    (@requires) => { None };
    (@requires $name:ident) => { Some(stringify!($name)) };
    (@of) => { false };
    (@of light_points) => { true };
    (@decides) => { true };
    (@decides same) => { false };
}

settings! {
    /// Read the scene in this format [default: by the extension]
    Reading "Reading" scene_format: Option<SceneFormat>;

    /// Allow references to files outside the scene's folder
    Reading "Reading" allow_outside: bool, bytes same;

    /// Treat warnings as errors (exit code 2)
    Reading "Reading" strict: bool, bytes same;

    /// Use at most this much memory, as in 512M, on host and device each; if work cannot be split to fit, the exit code
    /// is 3 [default: free memory minus a reserve]
    Memory "Machine" memory_limit: Option<ByteSize>, placeholder "SIZE", bytes same;

    /// Turn the camera once around the scene in N frames; `####` or `%04d` in file names stands for the number of the
    /// frame [default: off]
    Motion "Film" turntable: Option<u32>, placeholder "N", in 1..=1_000_000, conflicts [sun, partial];

    /// Render a day under a clear sky, a frame for each STEP in minutes or hours, as in
    /// "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m"; hours need no STEP [default: off]
    Motion "Film" sun: Option<SunSpec>, placeholder "LAT,LON,DATE,FROM-TO/STEP", conflicts [partial, environment, studio];

    /// Count panes and other surfaces that let light through as this in hours of direct sun
    Motion "Film" glass: Glass, requires sun, bytes same;

    /// Render frames A to B or every N-th of them, or a list as in "7,9,20-30x2", of the scene's animation, `turntable` or
    /// `sun` [default: all, with `fps`, `turntable` or `sun`]
    Frames "Film" frames: Option<Frames>, placeholder "A-B[xN]", conflicts [partial], bytes same;

    /// Set the frames per second of animation and movie, as a decimal or a ratio such as 30000/1001 [default: 24]
    Frames "Film" fps: Option<FrameRate>, placeholder "F", conflicts [partial];

    /// Resume an interrupted film, with an identical result, or begin it; fails if scene or settings differ from those in
    /// manifest.json
    Frames "Film" resume: bool, conflicts [overwrite, skip_existing], bytes same;

    /// Keep frames whose image exists, and render the others
    Frames "Film" skip_existing: bool, conflicts [overwrite], bytes same;

    /// Replace frames whose image exists
    Frames "Film" overwrite: bool, bytes same;

    /// Play the animation of this name in a glTF file [default: all that do not conflict]
    Form "Film" animation: Option<String>, placeholder "NAME";

    /// Smooth edges below this crease angle in OBJ, PLY and STL files without normals; off shows facets [default: 30; off
    /// with `lookup` half-ball]
    Form "Scene" smooth: Option<Smooth>, placeholder "DEGREES|off";

    /// Store meshes in many places once: less memory, slower rays
    Form "Scene" instances: Instancing, placeholder "WHEN";

    /// Write the image in this format [default: by the extension]
    Storage "Image" format: Option<Format>;

    /// Encode 8-bit and 16-bit files by this function; exr files stay linear
    Storage "Image" transfer: Transfer;

    /// Show colours brighter than white in this way; exr files stay linear
    Storage "Image" view: View;

    /// Write png files with this many bits per channel
    Storage "Image" bit_depth: BitDepth, placeholder "N";

    /// Dither 8-bit files against bands in smooth gradients; files become larger
    Storage "Image" dither: Switch;

    /// Store exr files as these numbers
    Storage "Image" exr_type: ExrSamples;

    /// Compress exr files without loss
    Storage "Image" exr_compression: ExrCompression;

    /// Divide the channels of `layers` into parts
    Storage "Image" exr_parts: ExrParts;

    /// Brighten 8-bit and 16-bit files by this many stops; auto suits any light; exr stays linear [default: auto with
    /// photometric lights, by what is seen under `sky`, else 0]
    Exposure "Image" exposure: Option<Exposure>, placeholder "STOPS|auto";

    /// Compute shadows by this method
    Image "Method" mode: Mode;

    /// Follow mirror reflections to this depth, in any mode; in the studio, at least to 1
    Image "Method" bounces: u32, placeholder "N";

    /// Set the light-mesh step h in scene units; auto derives it from the size of a pixel in the scene [default: the
    /// scene's, else auto]
    Image "Method" step: Option<Step>, placeholder "H|auto", of light_points;

    /// Set the interpolation radius in steps, r/h [default: the scene's, else 2.1]
    Image "Method" radius: Option<Positive>, placeholder "R", of light_points;

    /// Weight light points at distance d by their q = d/r [default: the scene's, else smooth]
    Image "Method" weight: Option<Weight>, of light_points;

    /// Find the visibility of lights in light-mesh mode by this method
    Image "Method" lookup: Lookup;

    /// Choose the number of samples of lights with a size and of pixels
    Image "Method" quality: Quality;

    /// Take N samples of each pixel, in any mode; 1 is its centre [default: by `quality`; 1 with half-ball, ray-trace and
    /// area]
    Image "Image" aa: Option<u32>, placeholder "N", in 1..=65536;

    /// Average the samples of a pixel by this filter
    Image "Image" filter: Filter;

    /// Evaluate short tests by this method; the image is the same
    Image "Method" short_tests: ShortTests, of light_points, bytes same;

    /// Take N samples of each light with a size, in each pixel or, with half-ball, at each light point [default: by
    /// `quality`; area 225, half-ball 4]
    Image "Method" samples: Option<u32>, placeholder "N", in 1..=65535;

    /// Seed the sampling pattern: same seed, same image
    Image "Method" seed: u64, placeholder "S";

    /// Set width and height in pixels
    Image "Image" size: Size, placeholder "WxH";

    /// Render only this part, also beyond the edges: column and row of its first pixel, width and height; pixels stay the
    /// same [default: the whole image]
    Image "Image" crop: Option<Crop>, placeholder "X,Y,W,H";

    /// Set the background: one number, r,g,b, "#rrggbb" (sRGB) or transparent, which gives png and exr files an alpha
    /// channel [default: the scene's, else black or the studio's]
    Image "Image" background: Option<Background>, placeholder "COLOUR|transparent";

    /// Add a ground below the scene that catches its shadows and shows the background, or is transparent with it
    Image "Scene" ground: bool;

    /// Light the model in a studio, in interiors, too; not beside other light [default: where there is no light and no
    /// background]
    Image "Scene" studio: bool, conflicts [no_studio, light, sky, environment, ambient, background, grid_file];

    /// Give a model without lights a key light and a fill light only, and under `sky` no ground and horizon
    Image "Scene" no_studio: bool;

    /// Keep finished rows if the run is interrupted; a second Ctrl-C ends it at once
    Image "Image" partial: bool, bytes same;

    /// Place the camera: position, target and vertical field of view in degrees, as in "0,2,5;0,1,0;45" [default: the
    /// scene's first, else one that frames the scene]
    Image "Scene" camera: Option<CameraView>, placeholder "P;T;VFOV";

    /// Use the scene's camera of this name [default: the first]
    Image "Scene" camera_name: Option<String>, placeholder "NAME", conflicts [camera];

    /// Set the up axis for `camera`, and for scenes without a camera
    Image "Scene" up: UpChoice;

    /// Replace the scene's lights: position, intensity (one number or r,g,b) and radius, as in "3,8,2;0.9;0.25";
    /// repeatable [default: the scene's, else a studio]
    Image "Scene" light: Vec<LightSpec>, placeholder "P[;I[;RADIUS]]";

    /// Set how the lights of `light` fall off with distance
    Image "Scene" falloff: Falloff, requires light;

    /// Set the ambient intensity, one number or r,g,b [default: the mean of the sky or environment, else the scene's,
    /// else 0.1 or suited to the lights]
    Image "Scene" ambient: Option<Color>, placeholder "V";

    /// Choose how surfaces get light from the sky and from each other
    Image "Scene" ambient_light: AmbientSource, placeholder "SOURCE";

    /// Set the sky: clear, uniform or gradient, as in "clear;sun=40,225"; also place, time, turbidity, ground, color,
    /// zenith, horizon, north, strength, alone [default: none]
    Image "Scene" sky: Option<SkySpec>, placeholder "SPEC";

    /// Put the scene into an equirectangular .hdr or .exr panorama, as in "street.hdr;rotation=90;strength=2;alone"
    /// [default: none]
    Image "Scene" environment: Option<EnvironmentSpec>, placeholder "FILE[;OPTIONS]", conflicts [sky];

    /// Choose the acceleration structure
    Image "Machine" accel: Acceleration, bytes same;

    /// Set the cells of the grid along each axis; implies `accel` grid [default: from the number of triangles]
    Image "Machine" grid: Option<Dims>, placeholder "NXxNYxNZ", conflicts [grid_file], bytes same;

    /// Load the grid that `lightmesh grid` saved; implies `accel` grid [default: none]
    Image "Machine" grid_file: Option<PathBuf>, placeholder "F", bytes same;

    /// Give images depth, normals, positions, the light of each lamp, ids and Cryptomattes
    Layers "Image" layers: bool, bytes same;

    /// Render on cpu, cuda (the first that works), cuda:N, several (cuda:all, cuda:0,1) or auto, the fastest; `lightmesh info
    /// --devices` lists them
    Machine "Machine" device: Device, placeholder "DEVICE", bytes same;

    /// Use N CPU threads [default: all]
    Machine "Machine" threads: Option<u32>, placeholder "N", in 1..=1024, bytes same;
}
