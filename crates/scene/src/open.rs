//! Opening a scene: the file extension determines the format, unless it is given.

use std::io::Read;
use std::path::Path;

use glam::DMat4;

use crate::{
    CreaseAngle, Instancing, LoadError, Scene, SceneFormat,
    draft::{Draft, Placement},
    formats,
};

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

impl Scene {
    /// Reads a scene: `.toml`, `.obj`, `.gltf`, `.glb`, `.ply` or `.stl`, or a built-in one named `builtin:NAME` or
    /// `builtin:NAME?key=value&…`.
    ///
    /// Content of a file that the scene model cannot represent is ignored, with a sentence in [`Scene::warnings`].
    ///
    /// # Errors
    ///
    /// [`LoadError`] names the file, the line if possible, and the remedy.
    pub fn open(path: impl AsRef<Path>) -> Result<Scene, LoadError> {
        Scene::open_with(path, &LoadOptions::default())
    }

    /// [`Scene::open`] with other options.
    ///
    /// # Errors
    ///
    /// [`LoadError`] names the file, the line if possible, and the remedy.
    pub fn open_with(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Scene, LoadError> {
        let path = path.as_ref();
        if let Some(query) = path.to_str().and_then(|name| name.strip_prefix("builtin:")) {
            return crate::builtin::open(query);
        }
        let format = options.format.map_or_else(|| known_format(path), Ok)?;
        let mut draft = Draft::new(path, options);
        let bytes = draft.border.read_scene()?;
        read(path, format, bytes, &mut draft)?;
        draft.finish()
    }

    /// Reads a scene from a stream, such as standard input, up to its end. Messages and the scene call it `name`; files
    /// that it refers to are looked for in the folder of that path, which is the current one for a name alone. There
    /// need not be a file of this name.
    ///
    /// ```
    /// use lightmesh_scene::{LoadOptions, Scene, SceneFormat};
    ///
    /// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    /// let scene = Scene::from_reader(text.as_bytes(), "triangle", SceneFormat::Obj, &LoadOptions::default())?;
    /// assert_eq!((scene.name.as_str(), scene.geometry.mesh.triangles.len()), ("triangle", 1));
    /// # Ok::<(), lightmesh_scene::LoadError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`LoadError`] names the stream, the line if possible, and the remedy.
    pub fn from_reader(
        source: impl Read,
        name: impl AsRef<Path>,
        format: SceneFormat,
        options: &LoadOptions,
    ) -> Result<Scene, LoadError> {
        let name = name.as_ref();
        let mut draft = Draft::new(name, options);
        let bytes = draft.border.read_stream(source)?;
        read(name, format, bytes, &mut draft)?;
        let mut scene = draft.finish()?;
        scene.files.retain(|file| file != name);
        Ok(scene)
    }
}

/// Reads a whole scene.
fn read(path: &Path, format: SceneFormat, bytes: Vec<u8>, draft: &mut Draft) -> Result<(), LoadError> {
    match reader(format) {
        Some(reader) => reader(path, bytes, &Placement::default(), draft),
        None => formats::toml::read(path, &bytes, draft),
    }
}

/// Reads a model from a file's path and bytes.
type Reader = fn(&Path, Vec<u8>, &Placement, &mut Draft) -> Result<(), LoadError>;

/// The reader of a model; `None` for scenes that are made of models.
fn reader(format: SceneFormat) -> Option<Reader> {
    match format {
        SceneFormat::Toml => None,
        SceneFormat::Obj => Some(formats::obj::read),
        SceneFormat::Gltf | SceneFormat::Glb => Some(formats::gltf::read),
        SceneFormat::Ply => Some(formats::ply::read),
        SceneFormat::Stl => Some(formats::stl::read),
    }
}

fn known_format(path: &Path) -> Result<SceneFormat, LoadError> {
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
pub(crate) fn read_part(
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
