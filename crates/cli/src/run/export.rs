//! `lightmesh export`.

use super::open::open;
use crate::args::ExportArgs;
use crate::failure::Failure;
use crate::progress::Watcher;
use crate::{interrupt, output};

pub(super) fn run(args: &ExportArgs) -> Result<(), Failure> {
    output::check_writable(&args.output)?;
    output::check_distinct(&[("the scene", Some(&args.scene.scene)), ("-o", Some(&args.output))])?;
    let watcher = Watcher::plain(args.quiet);
    let scene = open(&args.scene, &watcher)?;
    interrupt::watch();
    scene.export(&args.output)?;
    watcher.summary(&format!(
        "{}, {} triangles: {}",
        scene.name,
        scene.geometry.mesh.triangles.len(),
        args.output.display()
    ));
    Ok(())
}
