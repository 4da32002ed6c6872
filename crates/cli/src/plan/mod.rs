//! From arguments to a plan: everything that can be checked before the work begins is checked here.

mod files;
mod scene;
mod settings;

use std::num::NonZeroUsize;

use lightmesh::render::Crop;
use lightmesh::scene::{CameraError, CreaseAngle};
use lightmesh::{Device, Lookup, Mode, SaveError, Settings};

use crate::args::{RenderArgs, SceneArg};
use crate::output::OutputError;
use crate::value::Smooth;
pub(crate) use files::PictureFiles;
pub(crate) use scene::{ChoiceError, SceneChoices};

/// Why a command line is invalid.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PlanError {
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The part of the image is not in it.
    #[error("--crop {crop} is not a part of an image of {}x{} pixels; choose pixels of it (--crop, --size)", size[0], size[1])]
    Crop {
        /// The part.
        crop: Crop,
        /// Width and height of the image.
        size: [u32; 2],
    },
    /// The image goes to standard output, which has no extension.
    #[error("-o - needs the format of the image; add --format bmp, png, exr or jpg")]
    NoFormat,
    /// A flag specifies a grid, but another structure is selected.
    #[error("{flag} specifies a grid, but --accel {chosen} selects another structure; remove one of them")]
    NoGrid {
        /// The flag that specifies the grid.
        flag: &'static str,
        /// The structure that was selected.
        chosen: &'static str,
    },
}

/// A render, validated as far as possible without the scene.
pub(crate) struct RenderPlan {
    /// The scene to open.
    pub(crate) scene: SceneArg,
    /// The crease angle of files without normals, if they are to be smooth.
    pub(crate) smooth: Option<CreaseAngle>,
    /// Overrides for parts of it.
    pub(crate) choices: SceneChoices,
    /// Everything else about the image.
    pub(crate) settings: Settings,
    /// The device.
    pub(crate) device: Device,
    /// CPU threads; `None`: all.
    pub(crate) threads: Option<NonZeroUsize>,
    /// The output files.
    pub(crate) files: PictureFiles,
}

impl RenderPlan {
    /// Checks that the flags are consistent and that every output can be written.
    pub(crate) fn new(args: &RenderArgs) -> Result<RenderPlan, PlanError> {
        let settings = settings::settings(args)?;
        let files = PictureFiles::new(args)?;
        Ok(RenderPlan {
            scene: args.scene.clone(),
            smooth: args.smooth.unwrap_or_else(|| usual_smooth(&settings)).0,
            choices: SceneChoices::new(args)?,
            settings,
            device: args.device,
            threads: args.threads.and_then(|threads| NonZeroUsize::new(threads as usize)),
            files,
        })
    }
}

/// The half-ball stands for the thesis, whose surfaces are facets.
fn usual_smooth(settings: &Settings) -> Smooth {
    let is_thesis = settings.mode == Mode::LightMesh && settings.resolved_lookup() == Lookup::HalfBall;
    if is_thesis { Smooth::OFF } else { Smooth::default() }
}
