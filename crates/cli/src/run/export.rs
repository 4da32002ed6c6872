//! `lightmesh export`.

use std::path::Path;

use lightmesh::Scene;
use lightmesh::request::Host;
use lightmesh::request::files::Destination;
use lightmesh::scene::Instancing;

use super::open::open_stored;
use crate::args::ExportArgs;
use crate::failure::Failure;
use crate::memory;
use crate::output::{self, Outputs};
use crate::progress::Watcher;

/// What messages call the export.
const EXPORTING: &str = "exporting the scene";

pub(super) fn run(args: &ExportArgs) -> Result<(), Failure> {
    let watcher = Watcher::plain(args.quiet);
    let destination = Destination::new(&args.output);
    let scene = match destination.file() {
        Some(path) => to_file(path, args, &watcher),
        None => to_stdout(&destination, args, &watcher),
    }?;
    let normals = match scene.smooth_normals {
        0 => String::new(),
        made => format!(", {made} smooth normals"),
    };
    // What goes to standard output is a GLB file.
    let file = destination.file().unwrap_or(Path::new("scene.glb"));
    scene.export_warnings(file)?.iter().for_each(|warning| watcher.warning(warning));
    let (name, triangles) = (&scene.name, scene.geometry.mesh.triangle_count());
    watcher.summary(&format!("{name}, {triangles} triangles{normals}: {destination}"));
    Ok(())
}

fn to_file(path: &Path, args: &ExportArgs, watcher: &Watcher) -> Result<Scene, Failure> {
    let mesh = Scene::export_mesh(path)?;
    for path in std::iter::once(path).chain(mesh.as_deref()) {
        output::check_writable(path)?;
    }
    let outputs = Outputs::new([("-o", Some(path)), ("the triangles of -o", mesh.as_deref())])?;
    let scene = open_stored(&args.scene, args.smooth.0, Instancing::Always, &outputs, watcher)?;
    memory::during(EXPORTING, || scene.export(path))?;
    Ok(scene)
}

/// As one GLB file, the only format that is one.
fn to_stdout(destination: &Destination, args: &ExportArgs, watcher: &Watcher) -> Result<Scene, Failure> {
    destination.check_binary("-o")?;
    let scene = open_stored(&args.scene, args.smooth.0, Instancing::Always, &Outputs::default(), watcher)?;
    let file = memory::during(EXPORTING, || Ok::<_, Failure>(destination.ready(&scene.to_glb()?)?))?;
    output::publish(vec![file])?;
    Ok(scene)
}
