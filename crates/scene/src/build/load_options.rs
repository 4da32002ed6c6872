//! How a scene is opened.

use super::{scene_format::SceneFormat, smooth::CreaseAngle};
use crate::Instancing;

/// How strictly a scene is read, which files it may refer to, and whether normals are added.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadOptions {
    /// The format of the opened file; `None`: by its extension. Files that it refers to are those of their extensions.
    pub format: Option<SceneFormat>,
    /// Follow references, and links in the folder of the opened file, that lead outside of it. Off by default: an untrusted scene must
    /// not read other files.
    pub allow_outside: bool,
    /// Treat warnings as errors.
    pub strict: bool,
    /// Most bytes that the process may hold while it reads; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
    /// Gives smooth normals to OBJ, PLY and STL files without any, also to those that a TOML scene refers to; `None`, the default: their
    /// triangles are flat. Files with normals, glTF, whose triangles without normals are flat, and built-in scenes stay as they are.
    ///
    /// Triangles that meet at less than this angle get common normals where they meet, and vertices are duplicated at creases; the order of
    /// triangles and the positions of their corners stay. In an OBJ file with smoothing groups (`s`), triangles of different groups meet in
    /// creases, too, and those of no group stay flat.
    pub smooth: Option<CreaseAngle>,
    /// The animation of glTF files that is played; `None`: all that do not move what one before them moves.
    pub animation: Option<String>,
    /// Whether shapes that are placed many times are stored once: meshes of several nodes and `EXT_mesh_gpu_instancing` in glTF files, and files
    /// that several tables of a TOML scene place. The image is nearly the same: places are computed in single precision. Shapes that shine,
    /// move or are bent are copied.
    pub instancing: Instancing,
}

impl LoadOptions {
    /// The format of the opened file; `None`: by its extension.
    pub fn with_format(self, format: impl Into<Option<SceneFormat>>) -> LoadOptions {
        LoadOptions { format: format.into(), ..self }
    }

    /// Whether to follow references outside the folder of the opened file.
    pub fn with_allow_outside(self, allow_outside: bool) -> LoadOptions {
        LoadOptions { allow_outside, ..self }
    }

    /// Most bytes that the process may hold while it reads.
    pub fn with_memory_limit(self, memory_limit: impl Into<Option<u64>>) -> LoadOptions {
        LoadOptions { memory_limit: memory_limit.into(), ..self }
    }

    /// The crease angle of files without normals.
    ///
    /// ```
    /// use lightmesh_scene::{CreaseAngle, LoadOptions};
    ///
    /// let options = LoadOptions::default().with_smooth(CreaseAngle::from_degrees(40.0));
    /// assert_eq!(options.smooth.map(CreaseAngle::degrees), Some(40.0));
    /// ```
    pub fn with_smooth(self, smooth: impl Into<Option<CreaseAngle>>) -> LoadOptions {
        LoadOptions { smooth: smooth.into(), ..self }
    }

    /// The name of the animation of glTF files that is played.
    pub fn with_animation(self, animation: impl Into<Option<String>>) -> LoadOptions {
        LoadOptions { animation: animation.into(), ..self }
    }

    /// Whether shapes that are placed many times are stored once.
    pub fn with_instancing(self, instancing: Instancing) -> LoadOptions {
        LoadOptions { instancing, ..self }
    }

    /// Whether warnings are errors.
    pub fn with_strict(self, strict: bool) -> LoadOptions {
        LoadOptions { strict, ..self }
    }
}
