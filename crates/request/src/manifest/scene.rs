//! The checksum of a scene: that of all files that it is read from.

use std::path::Path;

use lightmesh_scene::Scene;
use xxhash_rust::xxh3::Xxh3;

use super::{digest, hex};
use crate::error::ManifestError;
use crate::order::Order;

/// The scene's own file, or the name of a built-in one with its options; the files that the scene refers to, also that some are missing; and
/// the panorama. A folder that is moved as a whole stays the same. A grid file does not count: it changes no pixel.
pub(super) fn checksum(order: &Order, scene: &Scene) -> Result<String, ManifestError> {
    let source = &order.scene;
    let mut hash = Xxh3::new();
    if scene.files.is_empty() {
        hash.update(source.as_os_str().as_encoded_bytes());
    }
    let panorama = order.request.environment.as_ref().map(|spec| &spec.file);
    for file in scene.files.iter().chain(panorama) {
        add(&mut hash, file, order.folder())?;
    }
    Ok(hex(&hash))
}

/// Name, size and content, so that files cannot be confused with each other.
fn add(hash: &mut Xxh3, file: &Path, folder: &Path) -> Result<(), ManifestError> {
    let name = file.strip_prefix(folder).unwrap_or(file).as_os_str().as_encoded_bytes();
    hash.update(&(name.len() as u64).to_le_bytes());
    hash.update(name);
    // The loader has said what is missing.
    let size = if file.is_file() { digest(file, hash)? } else { u64::MAX };
    hash.update(&size.to_le_bytes());
    Ok(())
}
