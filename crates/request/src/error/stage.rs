//! What can be wrong with the light and the camera of a scene.

use lightmesh_scene::{EnvironmentError, SkyError, UnknownCamera};

use crate::told::{Told, display_by_fields};
use crate::words::Words;

/// Why a scene cannot be lit or seen as requested.
#[derive(Debug)]
#[non_exhaustive]
pub enum StageError {
    /// There is no camera of this name.
    Camera(UnknownCamera),
    /// Invalid sky.
    Sky(SkyError),
    /// The panorama cannot be used.
    Environment(EnvironmentError),
    /// A studio is asked for where there is light.
    Studio {
        /// What stands against it.
        what: &'static str,
    },
}

impl Told for StageError {
    fn told(&self, words: Words) -> String {
        match self {
            StageError::Camera(error) => error.to_string(),
            StageError::Sky(error) => format!("{}: {error}", words.of("sky")),
            StageError::Environment(error) => format!("{}: {error}", words.of("environment")),
            StageError::Studio { what } => format!(
                "{}: the scene has {what}, which a studio would replace; leave the {} out to render it as it is",
                words.of("studio"),
                if words == Words::Flags { "flag" } else { "setting" }
            ),
        }
    }
}

display_by_fields!(StageError);

impl std::error::Error for StageError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StageError::Camera(error) => error.source(),
            StageError::Sky(error) => Some(error),
            StageError::Environment(error) => Some(error),
            StageError::Studio { .. } => None,
        }
    }
}

impl From<UnknownCamera> for StageError {
    fn from(error: UnknownCamera) -> StageError {
        StageError::Camera(error)
    }
}

impl From<SkyError> for StageError {
    fn from(error: SkyError) -> StageError {
        StageError::Sky(error)
    }
}

impl From<EnvironmentError> for StageError {
    fn from(error: EnvironmentError) -> StageError {
        StageError::Environment(error)
    }
}
