//! Opening the scene given on the command line.

use std::path::Path;

use lightmesh::scene::LoadOptions;
use lightmesh::{LoadError, Scene};

use crate::args::{ReadingArgs, SceneArg};
use crate::progress::Watcher;

/// Reads the scene, and prints its warnings.
pub(super) fn open(arg: &SceneArg, watcher: &Watcher) -> Result<Scene, LoadError> {
    let scene = read(&arg.scene, arg.reading)?;
    scene.warnings.iter().for_each(|warning| watcher.warning(warning));
    Ok(scene)
}

/// Reads the scene.
pub(super) fn read(path: &Path, reading: ReadingArgs) -> Result<Scene, LoadError> {
    let options = LoadOptions::default().with_allow_outside(reading.allow_outside).with_strict(reading.strict);
    Scene::open_with(path, &options)
}
