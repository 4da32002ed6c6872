//! `lightmesh export`.

use lightmesh::Scene;

use super::open::open;
use crate::args::ExportArgs;
use crate::failure::Failure;
use crate::memory;
use crate::output::{self, Outputs};
use crate::progress::Watcher;

pub(super) fn run(args: &ExportArgs) -> Result<(), Failure> {
    let mesh = Scene::export_mesh(&args.output)?;
    for path in std::iter::once(&args.output).chain(&mesh) {
        output::check_writable(path)?;
    }
    let outputs = Outputs::new([("-o", Some(&*args.output)), ("the triangles of -o", mesh.as_deref())])?;
    let watcher = Watcher::plain(args.quiet);
    let scene = open(&args.scene, args.smooth.0, &outputs, &watcher)?;
    memory::during("exporting the scene", || scene.export(&args.output))?;
    let normals = match scene.smooth_normals {
        0 => String::new(),
        made => format!(", {made} smooth normals"),
    };
    let (name, triangles) = (&scene.name, scene.geometry.mesh.triangles.len());
    watcher.summary(&format!("{name}, {triangles} triangles{normals}: {}", args.output.display()));
    Ok(())
}
