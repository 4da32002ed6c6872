//! The formats of scene files.

use std::path::Path;

use crate::{Up, parse_by_name};

/// A format of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SceneFormat {
    /// Cameras, lights, materials and shapes as text, and references to models.
    Toml,
    /// Wavefront OBJ with MTL.
    Obj,
    /// glTF 2.0 as text.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// PLY, as text or binary.
    Ply,
    /// STL, as text or binary.
    Stl,
}

impl SceneFormat {
    /// All of them, in the order used by messages.
    pub const ALL: &'static [SceneFormat] =
        &[SceneFormat::Toml, SceneFormat::Obj, SceneFormat::Gltf, SceneFormat::Glb, SceneFormat::Ply, SceneFormat::Stl];

    /// Its name, which is also its file extension.
    pub fn name(self) -> &'static str {
        match self {
            SceneFormat::Toml => "toml",
            SceneFormat::Obj => "obj",
            SceneFormat::Gltf => "gltf",
            SceneFormat::Glb => "glb",
            SceneFormat::Ply => "ply",
            SceneFormat::Stl => "stl",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            SceneFormat::Toml => "Lightmesh's own scene files",
            SceneFormat::Obj => "Wavefront OBJ, with MTL",
            SceneFormat::Gltf => "glTF 2.0 as text",
            SceneFormat::Glb => "glTF 2.0, binary",
            SceneFormat::Ply => "PLY, text or binary",
            SceneFormat::Stl => "STL, text or binary",
        }
    }

    /// The format of the extension of `path`, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<SceneFormat> {
        let extension = path.extension()?;
        SceneFormat::ALL.iter().copied().find(|format| extension.eq_ignore_ascii_case(format.name()))
    }

    /// The usual up axis: Z for STL, Y for all others. Only glTF defines it; for the others it is a convention.
    pub fn usual_up(self) -> Up {
        match self {
            SceneFormat::Stl => Up::Z,
            _ => Up::Y,
        }
    }
}

parse_by_name!(SceneFormat, "scene format");

impl Up {
    /// The [usual](SceneFormat::usual_up) up axis for this kind of file.
    pub fn of_file(path: &Path) -> Up {
        SceneFormat::from_path(path).map_or(Up::Y, SceneFormat::usual_up)
    }
}
