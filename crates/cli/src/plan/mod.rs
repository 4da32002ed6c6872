//! From what was typed to what will be done: everything that can be known before work begins is checked here.

mod files;
mod scene;
mod settings;

use std::num::NonZeroUsize;

use lightmesh::{Device, SaveError, Settings};

use crate::args::{RenderArgs, SceneArg};
use crate::output::OutputError;
pub(crate) use files::PictureFiles;
pub(crate) use scene::SceneChoices;

/// Why a command line cannot be followed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PlanError {
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A grid was described and something else chosen.
    #[error("{flag} describes a grid, but --accel bvh asks for something else; leave one of them out")]
    NoGrid {
        /// The flag that describes the grid.
        flag: &'static str,
    },
}

/// A render, checked as far as it can be without the scene.
pub(crate) struct RenderPlan {
    /// The scene to open.
    pub(crate) scene: SceneArg,
    /// What replaces parts of it.
    pub(crate) choices: SceneChoices,
    /// Everything else about the picture; the camera comes from `choices`.
    pub(crate) settings: Settings,
    /// Where to compute.
    pub(crate) device: Device,
    /// CPU threads; `None`: all.
    pub(crate) threads: Option<NonZeroUsize>,
    /// What to write.
    pub(crate) files: PictureFiles,
}

impl RenderPlan {
    /// Checks the flags against each other, and that every output can be written.
    pub(crate) fn new(args: &RenderArgs) -> Result<RenderPlan, PlanError> {
        let settings = settings::settings(args)?;
        let files = PictureFiles::new(args)?;
        Ok(RenderPlan {
            scene: args.scene.clone(),
            choices: SceneChoices::new(args),
            settings,
            device: args.device,
            threads: args.threads.and_then(|threads| NonZeroUsize::new(threads as usize)),
            files,
        })
    }
}
