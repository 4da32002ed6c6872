//! Where a model is in a scene.

use std::path::Path;

use glam::DMat4;

/// The placement of a model in the scene, and which parts of it to use.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// From the model's coordinates to the world's.
    pub(crate) transform: DMat4,
    /// Replaces the model's own materials.
    pub(crate) material: Option<u32>,
    /// Replaces the names of the model's objects.
    pub(crate) object: Option<String>,
    /// Use only the triangles: the surrounding scene has its own lights and cameras.
    pub(crate) part: bool,
}

impl Placement {
    /// The name of the object of the model in a file without names: its own, or else that of the file.
    pub(crate) fn object_in(&self, path: &Path) -> String {
        self.object.clone().unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
    }
}

impl Default for Placement {
    fn default() -> Placement {
        Placement { transform: DMat4::IDENTITY, material: None, object: None, part: false }
    }
}
