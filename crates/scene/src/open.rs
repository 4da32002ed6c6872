//! Opening a scene by its name: the file extension determines the format.

use std::path::Path;

use glam::DMat4;

use crate::{
    CreaseAngle, LoadError, Scene,
    draft::{Draft, Placement},
    formats,
};

/// Supported extensions of scene files.
const SCENE_FORMATS: [&str; 6] = ["toml", "obj", "gltf", "glb", "ply", "stl"];

/// How strictly a scene is read, which files it may refer to, and whether normals are added.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadOptions {
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
}

impl LoadOptions {
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
        let mut draft = Draft::new(path, options);
        if extension(path) == "toml" {
            formats::toml::read(path, &draft.border.read_scene()?, &mut draft)?;
        } else {
            reader(path)?(path, draft.border.read_scene()?, &Placement::default(), &mut draft)?;
        }
        draft.finish()
    }
}

/// Reads a model from a file's path and bytes.
type Reader = fn(&Path, Vec<u8>, &Placement, &mut Draft) -> Result<(), LoadError>;

/// The reader for this kind of file.
fn reader(path: &Path) -> Result<Reader, LoadError> {
    Ok(match extension(path).as_str() {
        "obj" => formats::obj::read,
        "gltf" | "glb" => formats::gltf::read,
        "ply" => formats::ply::read,
        "stl" => formats::stl::read,
        extension => {
            return Err(LoadError::UnknownFormat {
                path: path.to_owned(),
                extension: extension.to_owned(),
                known: SCENE_FORMATS.map(|known| format!(".{known}")).to_vec(),
            });
        }
    })
}

/// Reads a model as a part of a larger scene: its triangles, and its materials unless the placement has one.
pub(crate) fn read_part(
    path: &Path,
    bytes: Vec<u8>,
    transform: DMat4,
    material: Option<u32>,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    reader(path)?(path, bytes, &Placement { transform, material, part: true }, draft)
}

/// The file extension in lower case, without the dot.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn error(path: &str) -> String {
        Scene::open(path).expect_err("an error").to_string()
    }

    #[test]
    fn a_format_that_cannot_be_read_is_answered_with_those_that_can() {
        let known = "supported: .toml, .obj, .gltf, .glb, .ply, .stl, and builtin:NAME";
        assert_eq!(error("bunny.fbx"), format!("`.fbx` is not a supported scene format, bunny.fbx; {known}"));
        assert!(error("bunny").contains(known));
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        for path in ["none.toml", "none.obj", "none.gltf", "none.GLB", "none.ply", "none.STL"] {
            let message = error(path);
            assert!(message.contains(path) && message.contains("; check that it exists"), "{message}");
        }
    }

    #[test]
    fn a_folder_is_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.obj");
        fs::create_dir(&path).unwrap();
        assert!(error(path.to_str().unwrap()).starts_with("this is not a regular file"));
    }

    #[test]
    fn built_in_scenes_go_by_name() {
        assert_eq!(Scene::open("builtin:gazebo").unwrap().name, "gazebo");
        assert!(error("builtin:gazibo").contains("available: gazebo"));
    }
}
