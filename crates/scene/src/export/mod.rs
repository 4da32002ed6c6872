//! Writing a scene so that it reads back to the same image.
//!
//! - `.glb`: everything in one file. What glTF cannot represent is kept in `extras`, see
//!   [`formats::gltf::extras`](crate::formats::gltf::extras); other programs show the rest.
//! - `.toml`: cameras, lights and the ambient term as editable text, and next to it `NAME.mesh.glb` with the triangles and
//!   their materials.
//!
//! Coordinates are written so that every `f32` of the local frame is read back exactly; only a scene far from the world's
//! origin may round its smallest ones. Files are written next to their target and renamed: never half-written.

mod error;
mod glb;
mod info;
mod lights;
mod lost;
mod text;

use std::io;
use std::path::{Path, PathBuf};

use lightmesh_files::{Ready, publish};

use self::error::refused;
use crate::Scene;

pub use error::ExportError;
pub use info::{AnimationInfo, BoundsInfo, CameraInfo, LightInfo, SceneInfo};

impl Scene {
    /// Writes the scene as `.toml` (with `NAME.mesh.glb` next to it) or `.glb`.
    ///
    /// # Errors
    ///
    /// [`ExportError`] names the file and the remedy. Nothing is left half-written; two files appear together.
    pub fn export(&self, path: impl AsRef<Path>) -> Result<(), ExportError> {
        let path = path.as_ref();
        let mut files = Vec::new();
        if let Some(mesh) = Scene::export_mesh(path)? {
            let name = mesh.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let text = text::encode(self, &name).map_err(|cause| refused(path, io::Error::other(cause)))?;
            files.push(Ready::with(&mesh, &glb::encode(self, glb::Content::Triangles, &mesh)?)?);
            files.push(Ready::with(path, text.as_bytes())?);
        } else {
            files.push(Ready::with(path, &glb::encode(self, glb::Content::Everything, path)?)?);
        }
        Ok(publish(files)?)
    }

    /// What a file that [`Scene::export`] writes to `path` does not keep, and what of a `.glb` other programs show otherwise: a sentence for each
    /// kind. What glTF has no words for is in its `extras`, where it is found again when this crate reads the file.
    ///
    /// ```
    /// use lightmesh_scene::{Light, Scene, glam::Vec3};
    ///
    /// let mut scene = Scene::open("builtin:gazebo")?;
    /// scene.lights.push(Light::point(Vec3::Y));
    /// let warnings = scene.export_warnings("gazebo.glb")?;
    /// assert!(warnings.iter().any(|warning| warning.contains("inverse-square falloff")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ExportError::UnknownFormat`]
    pub fn export_warnings(&self, path: impl AsRef<Path>) -> Result<Vec<String>, ExportError> {
        let mut warnings = lost::always(self);
        if Scene::export_mesh(path)?.is_none() {
            warnings.extend(lost::to_others(self));
        }
        Ok(warnings)
    }

    /// The bytes that [`Scene::export`] would write as `.glb`.
    ///
    /// # Errors
    ///
    /// [`ExportError::TooLarge`], or [`ExportError::Write`] if a texture cannot be encoded.
    pub fn to_glb(&self) -> Result<Vec<u8>, ExportError> {
        glb::encode(self, glb::Content::Everything, Path::new(&self.name))
    }

    /// The file of triangles that [`Scene::export`] writes next to `path`: `a.mesh.glb` next to `a.toml`, none next to `a.glb`.
    ///
    /// # Errors
    ///
    /// [`ExportError::UnknownFormat`]
    pub fn export_mesh(path: impl AsRef<Path>) -> Result<Option<PathBuf>, ExportError> {
        let path = path.as_ref();
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "glb" => Ok(None),
            "toml" => Ok(Some(path.with_extension("mesh.glb"))),
            _ => Err(ExportError::UnknownFormat { path: path.to_owned(), extension }),
        }
    }
}
