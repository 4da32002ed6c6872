//! What is asked for: a request with its scene and its files.

use std::path::{Path, PathBuf};

use lightmesh_files::directory;
use lightmesh_scene::SceneFormat;

use crate::files::{Files, is_standard};
use crate::request::Request;

/// What is asked for: a picture, a film or a study of a scene, and its files.
#[derive(Clone, Debug)]
pub struct Order {
    /// The file of the scene, or the name of a built-in one; `-` is standard input.
    pub scene: PathBuf,
    /// The request.
    pub request: Request,
    /// The files to write.
    pub files: Files,
}

impl Order {
    /// The scene's format; `None` if it is built in, or unknown.
    pub fn format(&self) -> Option<SceneFormat> {
        format_of(&self.scene, self.request.scene_format)
    }

    /// The folder of the scene.
    pub(crate) fn folder(&self) -> &Path {
        directory(&self.scene)
    }

    /// Whether the scene comes from standard input.
    pub(crate) fn is_from_stdin(&self) -> bool {
        is_standard(&self.scene)
    }
}

/// The format of a scene: the given one, or by the extension.
pub fn format_of(scene: &Path, given: Option<SceneFormat>) -> Option<SceneFormat> {
    given.or_else(|| SceneFormat::from_path(scene))
}
