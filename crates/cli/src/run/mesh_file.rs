//! `--mesh-file`: what light points see, from an earlier run and for later ones.

use std::path::Path;

use lightmesh::render::{MeshFileError, PreparedScene, SavedMesh};
use lightmesh::{Lookup, MeshCache, Mode, Observer, Renderer};
use lightmesh_memory::Bytes;

use crate::failure::Failure;
use crate::memory;
use crate::plan::RenderPlan;
use crate::progress::Watcher;

/// What light points see, and the file that it is kept in.
pub(super) struct Mesh<'a> {
    /// What is known of them.
    pub(super) cache: MeshCache,
    file: Option<&'a Path>,
}

impl<'a> Mesh<'a> {
    /// What is known before the first image; nothing without a file. `moves`: whether surfaces move from image to image.
    pub(super) fn open(
        plan: &'a RenderPlan,
        (renderer, prepared): (&Renderer, &PreparedScene),
        moves: bool,
        watcher: &Watcher,
    ) -> Result<Mesh<'a>, Failure> {
        let mut mesh = Mesh { cache: MeshCache::new(), file: None };
        let Some(path) = plan.mesh_file.as_deref() else { return Ok(mesh) };
        let has_points = plan.settings.mode == Mode::LightMesh && plan.settings.resolved_lookup() == Lookup::HalfBall;
        if !has_points || moves {
            let why = if moves {
                "surfaces move in this film, and a mesh belongs to one place of them"
            } else {
                "only --lookup half-ball has light points"
            };
            watcher.note(&format!("--mesh-file {} is not used: {why}", path.display()));
            return Ok(mesh);
        }
        mesh.file = Some(path);
        if !path.exists() {
            return Ok(mesh);
        }
        let load = || renderer.load_cache(path, prepared, &plan.settings);
        match memory::during(format!("reading {}", path.display()), load) {
            Ok(cache) => {
                watcher.note(&format!("{}: {} values of light points were read", path.display(), cache.len()));
                mesh.cache = cache;
            }
            Err(error) if error.fault.is_replaceable() => refused(&error, watcher),
            Err(error) => return Err(error.into()),
        }
        Ok(mesh)
    }

    /// Whether there is a file.
    pub(super) fn has_file(&self) -> bool {
        self.file.is_some()
    }

    /// Says so if the first image has shown that the file is of no use. To be called after each image.
    pub(super) fn check(&mut self, watcher: &Watcher) {
        if let Some(error) = self.cache.refused() {
            refused(&error, watcher);
        }
    }

    /// Writes what is known after the last image, of which the scene is `prepared`.
    pub(super) fn save(&self, prepared: &PreparedScene, watcher: &Watcher) -> Result<(), Failure> {
        let Some(path) = self.file else { return Ok(()) };
        let saved = memory::during(format!("writing {}", path.display()), || self.cache.save(path, prepared))?;
        if let Some(SavedMesh { values, bytes, .. }) = saved {
            let (path, bytes) = (path.display(), Bytes(bytes));
            watcher.note(&format!("{path}: {values} values of light points were written, {bytes}"));
        }
        Ok(())
    }
}

/// Says that a file is of no use.
fn refused(error: &MeshFileError, watcher: &Watcher) {
    let (path, fault) = (error.path.display(), &error.fault);
    watcher.warning(&format!("{path}: {fault}; the mesh is built anew and replaces it"));
}
