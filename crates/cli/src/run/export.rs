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
    let scene = open(&args.scene, &outputs, &watcher)?;
    memory::during("exporting the scene", || scene.export(&args.output))?;
    watcher.summary(&format!(
        "{}, {} triangles: {}",
        scene.name,
        scene.geometry.mesh.triangles.len(),
        args.output.display()
    ));
    Ok(())
}
