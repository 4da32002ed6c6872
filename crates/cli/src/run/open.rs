//! Opening the scene given on the command line.

use std::io::{self, IsTerminal};
use std::path::Path;

use lightmesh::Scene;
use lightmesh::scene::LoadOptions;

use crate::args::{ReadingArgs, SceneArg};
use crate::destination::is_standard;
use crate::failure::Failure;
use crate::memory;
use crate::output::{Outputs, input};
use crate::plan::MeshForm;
use crate::progress::Watcher;

/// What messages call the scene that is read from standard input.
const STANDARD_INPUT: &str = "standard input";

/// Reads the scene, of which outputs must not overwrite any file, and prints its warnings.
pub(super) fn open(
    arg: &SceneArg,
    form: MeshForm,
    animation: Option<&str>,
    outputs: &Outputs,
    watcher: &Watcher,
) -> Result<Scene, Failure> {
    outputs.keep("the scene", input(&arg.scene))?;
    let scene = read(&arg.scene, arg.reading, form, animation)?;
    outputs.keep_scene(&scene)?;
    scene.warnings.iter().for_each(|warning| watcher.warning(warning));
    Ok(scene)
}

/// Reads the scene.
pub(super) fn read(
    path: &Path,
    reading: ReadingArgs,
    form: MeshForm,
    animation: Option<&str>,
) -> Result<Scene, Failure> {
    let options = read_options(reading, form, animation);
    if !is_standard(path) {
        let open = || Scene::open_with(path, &options);
        return Ok(memory::during(format!("reading {}", path.display()), open)?);
    }
    let format = reading.scene_format.ok_or(Failure::NoSceneFormat)?;
    if io::stdin().is_terminal() {
        return Err(Failure::NoScene);
    }
    let read = || Scene::from_reader(io::stdin().lock(), STANDARD_INPUT, format, &options);
    Ok(memory::during(format!("reading {STANDARD_INPUT}"), read)?)
}

/// How a scene is read.
pub(crate) fn read_options(reading: ReadingArgs, form: MeshForm, animation: Option<&str>) -> LoadOptions {
    LoadOptions::default()
        .with_format(reading.scene_format)
        .with_allow_outside(reading.allow_outside)
        .with_strict(reading.strict)
        .with_smooth(form.smooth)
        .with_instancing(form.instancing)
        .with_animation(animation.map(str::to_owned))
        .with_memory_limit(reading.memory_limit.map(|limit| limit.0))
}
