//! From arguments to a plan: everything that can be checked before the work begins is checked here.

mod files;
mod film;
mod movie;
pub(crate) mod scene;
mod settings;
mod sun;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use lightmesh::render::Crop;
use lightmesh::scene::{CameraError, CreaseAngle, Instancing};
use lightmesh::{Acceleration, Device, Lookup, Mode, SaveError, Settings};

use crate::args::{RenderArgs, SceneArg};
use crate::manifest::ManifestError;
use crate::output::OutputError;
use crate::value::{Frames, Smooth, SunSpec};
pub(crate) use files::{PictureFiles, save_options};
pub(crate) use film::{Film, Motion, Work};
pub(crate) use movie::{Container, MovieChoiceError};
pub(crate) use scene::ChoiceError;
pub(crate) use scene::SceneChoices;
pub(crate) use settings::settings;
pub(crate) use sun::{HoursFile, HoursFormat, SunMoment, SunStudy};

/// Why a command line is invalid.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PlanError {
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Camera(#[from] CameraError),
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    #[error(transparent)]
    Movie(#[from] MovieChoiceError),
    /// The part of the image is not in it.
    #[error("--crop {crop} exceeds the image of {}x{} pixels; choose a part of the image (--crop, --size)", size[0], size[1])]
    Crop {
        /// The part.
        crop: Crop,
        /// Width and height of the image.
        size: [u32; 2],
    },
    /// The image goes to standard output, which has no extension.
    #[error("-o - needs the format of the image; add --format bmp, png, exr or jpg")]
    NoFormat,
    /// A mesh file that is no file.
    #[error("--mesh-file - cannot be standard output, since the file is read and written; name a file")]
    MeshOnStdout,
    /// A file of a film whose name has no place for the number of the frame.
    #[error("{flag} {} is one file, but a film has one for each frame; write #### where the number goes, as in film.####.png", path.display())]
    NoNumber {
        /// The flag.
        flag: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// Frames that the film does not have.
    #[error(
        "--frames {frames}: the film ends with frame {last}; choose frames up to it (--frames, --turntable, --fps, --sun)"
    )]
    NoFrame {
        /// The frames that were asked for.
        frames: Frames,
        /// The film's last one.
        last: u32,
    },
    /// Nothing in the scene moves.
    #[error(
        "nothing in the scene moves; add --turntable N for a film in which the camera goes around it, or render one image such as image.png, without --frames and --fps"
    )]
    NotAnimated,
    /// What is said of frames where there are none.
    #[error(
        "--resume, --skip-existing and --overwrite are for films; add --frames, --fps or --turntable, or remove them"
    )]
    NoFilm,
    /// Frames that were rendered before.
    #[error("{} exists{}; add --skip-existing to keep such frames, or --overwrite to replace them", first.display(), others(*count))]
    FrameExists {
        /// The first of their images.
        first: PathBuf,
        /// How many there are.
        count: usize,
    },
    /// The sun of a study shines from a clear sky.
    #[error("--sun needs a clear sky, but --sky chooses another; write --sky clear with its options, or omit it")]
    SunWithoutSky,
    /// It is night all the time.
    #[error(
        "--sun {spec}: the sun is below the horizon at all of these moments; choose another date, other hours or a smaller step"
    )]
    NoSun {
        /// The hours that were asked for.
        spec: SunSpec,
    },
    /// A file for hours of direct sun of an unknown format.
    #[error("--sun-hours {}: unknown format; use the extension exr, png or csv", path.display())]
    HoursFormat {
        /// The file.
        path: PathBuf,
    },
    /// A flag specifies a grid, but another structure is selected.
    #[error("{flag} specifies a grid, but --accel {chosen} selects another structure; remove one of them")]
    NoGrid {
        /// The flag that specifies the grid.
        flag: &'static str,
        /// The structure that was selected.
        chosen: &'static str,
    },
}

/// How meshes are read.
#[derive(Clone, Copy)]
pub(crate) struct MeshForm {
    pub(crate) smooth: Option<CreaseAngle>,
    pub(crate) instancing: Instancing,
}

impl MeshForm {
    /// Each place of a mesh has a copy.
    pub(crate) fn copied(smooth: Option<CreaseAngle>) -> MeshForm {
        MeshForm { smooth, instancing: Instancing::Never }
    }
}

/// A render, validated as far as possible without the scene.
pub(crate) struct RenderPlan {
    /// The scene to open.
    pub(crate) scene: SceneArg,
    /// The crease angle of files without normals, if they are to be smooth.
    pub(crate) smooth: Option<CreaseAngle>,
    /// Whether meshes in many places are stored once.
    pub(crate) instancing: Instancing,
    /// Overrides for parts of it.
    pub(crate) choices: SceneChoices,
    /// Everything else about the image.
    pub(crate) settings: Settings,
    /// The device.
    pub(crate) device: Device,
    /// CPU threads; `None`: all.
    pub(crate) threads: Option<NonZeroUsize>,
    /// The output files; of a film, those of its first frame.
    pub(crate) files: PictureFiles,
    /// The frames, if it is a film.
    pub(crate) film: Option<Film>,
    /// Where light points are kept from run to run.
    pub(crate) mesh_file: Option<PathBuf>,
    /// The hours of a day, if the sun of one is studied.
    pub(crate) sun: Option<SunStudy>,
}

impl RenderPlan {
    /// How meshes are read.
    pub(crate) fn meshes(&self) -> MeshForm {
        MeshForm { smooth: self.smooth, instancing: self.instancing }
    }

    /// Checks that the flags are consistent and that every output can be written.
    pub(crate) fn new(args: &RenderArgs) -> Result<RenderPlan, PlanError> {
        let (format, memory_limit) = (args.scene.format(), args.scene.reading.memory_limit.map(|limit| limit.0));
        let settings = settings(&args.image, format, memory_limit)?.with_layers(args.layers.is_some());
        let sun = SunStudy::new(args)?;
        let film = Film::new(args, sun.as_ref())?;
        let files = match (&film, &sun) {
            (Some(film), _) => film.files(args, film.first())?,
            (None, Some(sun)) => sun.files(args)?,
            (None, None) => PictureFiles::new(args)?,
        };
        Ok(RenderPlan {
            scene: args.scene.clone(),
            smooth: args.form.smooth.unwrap_or_else(|| usual_smooth(&settings)).0,
            instancing: instancing(args, &settings),
            choices: SceneChoices::new(&args.image, format, memory_limit)?
                .under_sun(sun.as_ref())
                .of_picture(sun.is_none()),
            settings,
            device: args.machine.device,
            threads: args.machine.threads.and_then(|threads| NonZeroUsize::new(threads as usize)),
            files,
            film,
            mesh_file: args.mesh_file.clone(),
            sun,
        })
    }
}

/// Further files besides the first.
fn others(count: usize) -> String {
    match count - 1 {
        0 => String::new(),
        1 => " and one more".to_owned(),
        more => format!(" and {more} more"),
    }
}

/// The half-ball stands for the thesis, whose surfaces are facets.
/// Grids and brute force hold no instances.
fn instancing(args: &RenderArgs, settings: &Settings) -> Instancing {
    match settings.acceleration {
        Acceleration::Auto | Acceleration::Bvh => args.form.instances,
        _ => Instancing::Never,
    }
}

fn usual_smooth(settings: &Settings) -> Smooth {
    if has_light_points(settings) { Smooth::OFF } else { Smooth::default() }
}

/// Whether there is a lattice of light points, with its step: of all techniques, only the thesis' has one.
pub(crate) fn has_light_points(settings: &Settings) -> bool {
    settings.mode == Mode::LightMesh && settings.resolved_lookup() == Lookup::HalfBall
}
