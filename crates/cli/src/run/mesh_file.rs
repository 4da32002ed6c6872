//! `--mesh-file`: what light points see and what surfaces gather, from an earlier run and for later ones.

use std::path::Path;

use lightmesh::render::{AmbientSource, MeshFileError, PreparedScene, SavedMesh};
use lightmesh::{MeshCache, Observer, Renderer};
use lightmesh_memory::Bytes;

use crate::failure::Failure;
use crate::memory;
use crate::plan::{RenderPlan, has_light_points};
use crate::progress::Watcher;

/// What light points see and surfaces gather, and the file that it is kept in.
pub(super) struct Mesh<'a> {
    /// What is known of it.
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
        let gathers = plan.settings.ambient_light.for_scene(&prepared.scene) == AmbientSource::Mesh;
        if !(has_light_points(&plan.settings) || gathers) || moves {
            let why = if moves {
                "surfaces move in this film, and each frame would need a file of its own"
            } else {
                "only --lookup half-ball has light points, and only --ambient-light mesh keeps gathered light"
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
                let what = amount(cache.len(), cache.sites_read());
                watcher.note(&format!("{}: read {what}", path.display()));
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
        while let Some(error) = self.cache.refused() {
            refused(&error, watcher);
        }
    }

    /// Writes what is known after the last image, of which the scene is `prepared`.
    pub(super) fn save(&self, prepared: &PreparedScene, watcher: &Watcher) -> Result<(), Failure> {
        let Some(path) = self.file else { return Ok(()) };
        let saved = memory::during(format!("writing {}", path.display()), || self.cache.save(path, prepared))?;
        if let Some(SavedMesh { values, sites, bytes, .. }) = saved {
            let (path, what, bytes) = (path.display(), amount(values, sites), Bytes(bytes));
            watcher.note(&format!("{path}: wrote {what}, {bytes}"));
        }
        Ok(())
    }
}

/// How much a file holds.
fn amount(values: u64, sites: u64) -> String {
    let of_points = format!("{values} values of light points");
    let of_sites = format!("{sites} sites of gathered light");
    match (values, sites) {
        (_, 0) => of_points,
        (0, _) => of_sites,
        _ => format!("{of_points} and {of_sites}"),
    }
}

/// Says that a file, or a part of it, is of no use.
fn refused(error: &MeshFileError, watcher: &Watcher) {
    let (path, fault) = (error.path.display(), &error.fault);
    let what = if fault.is_of_gathered_light() { "light is gathered anew" } else { "the mesh is built anew" };
    watcher.warning(&format!("{path}: {fault}; {what} and replaces it"));
}
