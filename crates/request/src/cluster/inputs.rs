//! The files that a scene is read from, and their checksums: by these, the file of one machine is known to be that of another.

use std::fs;
use std::path::{Path, PathBuf, absolute};

use lightmesh_files::directory;
use lightmesh_scene::Scene;
use serde::{Deserialize, Serialize};

use crate::error::ManifestError;
use crate::manifest;
use crate::order::Order;

/// A file that is needed, with what is in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Its absolute path.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
    /// XXH3, 128 bits, as in manifests.
    pub xxh3: String,
}

impl Input {
    /// The file at `path` as it is now.
    ///
    /// # Errors
    /// [`ManifestError::Checksum`] if it cannot be read.
    pub fn at(path: &Path) -> Result<Input, ManifestError> {
        let (bytes, xxh3) = digest_of(path)?;
        let path = absolute(path).unwrap_or_else(|_| path.to_owned());
        Ok(Input { path, bytes, xxh3 })
    }

    /// All files that an order needs, whose scene has been read.
    ///
    /// # Errors
    /// As [`Input::at`].
    pub fn all_of(order: &Order, scene: &Scene) -> Result<Vec<Input>, ManifestError> {
        let request = &order.request;
        let surroundings = request.environment.as_ref().map(|spec| spec.file.clone());
        let mut files = files_of(scene, &order.scene, request.allow_outside);
        files.extend(surroundings.into_iter().chain(request.grid_file.clone()));
        files.dedup();
        files.iter().map(|file| Input::at(file)).collect()
    }
}

/// Size and checksum of a file.
///
/// # Errors
/// [`ManifestError::Checksum`] if it cannot be read.
pub fn digest_of(path: &Path) -> Result<(u64, String), ManifestError> {
    manifest::checksum_of(path)
}

/// The files that the scene read from `path` is made of: all that it refers to and that are there, inside of its folder unless others are allowed.
/// The scene's own file is the first; a built-in scene has none.
pub fn files_of(scene: &Scene, path: &Path, allow_outside: bool) -> Vec<PathBuf> {
    let folder = fs::canonicalize(directory(path)).ok();
    let is_inside = |file: &Path| {
        let real = fs::canonicalize(file).ok();
        real.zip(folder.as_ref()).is_some_and(|(file, folder)| file.starts_with(folder))
    };
    let others = scene.files.iter().filter(|file| *file != path);
    let may_be_read = |file: &&PathBuf| file.is_file() && (allow_outside || is_inside(file));
    let own = scene.files.iter().any(|file| file == path).then(|| path.to_owned());
    own.into_iter().chain(others.filter(may_be_read).cloned()).collect()
}
