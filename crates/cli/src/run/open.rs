//! Opening the scene given on the command line.

use std::path::Path;

use lightmesh::scene::{CreaseAngle, LoadOptions};
use lightmesh::{LoadError, Scene};

use crate::args::{ReadingArgs, SceneArg};
use crate::failure::Failure;
use crate::memory;
use crate::output::Outputs;
use crate::progress::Watcher;

/// Reads the scene, of which outputs must not overwrite any file, and prints its warnings.
pub(super) fn open(
    arg: &SceneArg,
    smooth: Option<CreaseAngle>,
    outputs: &Outputs,
    watcher: &Watcher,
) -> Result<Scene, Failure> {
    outputs.keep("the scene", [&*arg.scene])?;
    let scene = read(&arg.scene, arg.reading, smooth)?;
    outputs.keep_scene(&scene)?;
    scene.warnings.iter().for_each(|warning| watcher.warning(warning));
    Ok(scene)
}

/// Reads the scene.
pub(super) fn read(path: &Path, reading: ReadingArgs, smooth: Option<CreaseAngle>) -> Result<Scene, LoadError> {
    let options = LoadOptions::default()
        .with_allow_outside(reading.allow_outside)
        .with_strict(reading.strict)
        .with_smooth(smooth)
        .with_memory_limit(reading.memory_limit.map(|limit| limit.0));
    memory::during(format!("reading {}", path.display()), || Scene::open_with(path, &options))
}
