//! Models by their format: files with one model each, which may be a part of a larger scene.

use std::path::Path;

use glam::DMat4;

use super::{gltf, obj, ply, stl};
use crate::build::draft::Draft;
use crate::build::placement::Placement;
use crate::{LoadError, SceneFormat};

/// Reads a model from a file's path and bytes.
pub(super) type Reader = fn(&Path, Vec<u8>, &Placement, &mut Draft) -> Result<(), LoadError>;

/// The reader of a model; `None` for scenes that are made of models.
pub(super) fn reader(format: SceneFormat) -> Option<Reader> {
    match format {
        SceneFormat::Toml => None,
        SceneFormat::Obj => Some(obj::read),
        SceneFormat::Gltf | SceneFormat::Glb => Some(gltf::read),
        SceneFormat::Ply => Some(ply::read),
        SceneFormat::Stl => Some(stl::read),
    }
}

/// The format of a file by its extension.
pub(super) fn known_format(path: &Path) -> Result<SceneFormat, LoadError> {
    SceneFormat::from_path(path).ok_or_else(|| unknown_format(path))
}

fn unknown_format(path: &Path) -> LoadError {
    LoadError::UnknownFormat {
        path: path.to_owned(),
        extension: path.extension().unwrap_or_default().to_string_lossy().to_lowercase(),
        known: SceneFormat::ALL.iter().map(|known| format!(".{known}")).collect(),
    }
}

/// Reads a model as a part of a larger scene: its triangles, and its materials and objects unless others are given.
pub(super) fn read_part(
    path: &Path,
    bytes: Vec<u8>,
    transform: DMat4,
    material: Option<u32>,
    object: Option<String>,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    let reader = reader(known_format(path)?).ok_or_else(|| unknown_format(path))?;
    reader(path, bytes, &Placement { transform, material, object, part: true }, draft)
}
