//! Opening a scene: the file extension determines the format, unless it is given.

use std::io::Read;
use std::path::Path;

use super::{
    models::{known_format, reader},
    toml,
};
use crate::build::draft::Draft;
use crate::build::placement::Placement;
use crate::{LoadError, LoadOptions, Scene, SceneFormat, builtin};

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
            return builtin::open(query);
        }
        let format = options.format.map_or_else(|| known_format(path), Ok)?;
        let mut draft = Draft::new(path, options);
        let bytes = draft.access.read_scene()?;
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
        let bytes = draft.access.read_stream(source)?;
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
        None => toml::read(path, &bytes, draft),
    }
}
