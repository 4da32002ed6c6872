//! Opening the scene given on the command line.

use std::io::{self, IsTerminal};
use std::path::Path;

use lightmesh::Scene;
use lightmesh::request::files::{Outputs, input, is_standard};
use lightmesh::request::{Host, load_options};
use lightmesh::scene::{CreaseAngle, Instancing, LoadOptions, SceneFormat};

use crate::args::SceneArg;
use crate::failure::Failure;
use crate::memory;
use crate::progress::Watcher;

/// What messages call the scene that is read from standard input.
const STANDARD_INPUT: &str = "standard input";

/// Reads a scene for a command that has no request, of which meshes in several places are stored as it needs them.
pub(super) fn open_stored(
    arg: &SceneArg,
    smooth: Option<CreaseAngle>,
    instancing: Instancing,
    outputs: &Outputs,
    watcher: &Watcher,
) -> Result<Scene, Failure> {
    let request = arg.reading.request();
    let options = load_options(&request, smooth, instancing);
    opened(&arg.scene, || read((&arg.scene, request.scene_format), &options), outputs, watcher)
}

/// The scene of `path`, which is read by `read` and of which outputs must not overwrite any file; prints its warnings.
pub(super) fn opened(
    path: &Path,
    read: impl FnOnce() -> Result<Scene, Failure>,
    outputs: &Outputs,
    watcher: &Watcher,
) -> Result<Scene, Failure> {
    outputs.keep("the scene", input(path))?;
    let scene = read()?;
    outputs.keep_scene(&scene)?;
    scene.warnings.iter().for_each(|warning| watcher.warning(warning));
    Ok(scene)
}

/// Reads the scene.
pub(super) fn read((path, format): (&Path, Option<SceneFormat>), options: &LoadOptions) -> Result<Scene, Failure> {
    if !is_standard(path) {
        let open = || Scene::open_with(path, options);
        return Ok(memory::during(format!("reading {}", path.display()), open)?);
    }
    let format = format.ok_or(Failure::NoSceneFormat)?;
    if io::stdin().is_terminal() {
        return Err(Failure::NoScene);
    }
    let read = || Scene::from_reader(io::stdin().lock(), STANDARD_INPUT, format, options);
    Ok(memory::during(format!("reading {STANDARD_INPUT}"), read)?)
}
