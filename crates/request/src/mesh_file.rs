//! The mesh file: what light points see and what surfaces gather, from an earlier run and for later ones.

use std::path::PathBuf;

use lightmesh_memory::Bytes;
use lightmesh_render::{AmbientSource, MeshCache, MeshFileError, PreparedScene, Renderer, SavedMesh};

use crate::error::Error;
use crate::host::Host;
use crate::plan::Plan;

/// What light points see and surfaces gather, and the file that it is kept in.
pub(crate) struct Mesh {
    /// What is known of it.
    pub(crate) cache: MeshCache,
    file: Option<PathBuf>,
}

impl Mesh {
    /// What is known before the first image; nothing without a file. `moves`: whether surfaces move from image to image.
    pub(crate) fn open(
        plan: &Plan,
        (renderer, prepared): (&Renderer, &PreparedScene),
        moves: bool,
        host: &dyn Host,
    ) -> Result<Mesh, Error> {
        let mut mesh = Mesh { cache: MeshCache::new(), file: None };
        let Some(path) = plan.order.files.mesh_file.as_deref() else { return Ok(mesh) };
        let gathers = plan.settings.ambient_light.for_scene(&prepared.scene) == AmbientSource::Mesh;
        if !(plan.settings.has_light_points() || gathers) || moves {
            let words = host.words();
            let why = if moves {
                "surfaces move in this film, and each frame would need a file of its own".to_owned()
            } else {
                let (points, gathers) = (words.with("lookup", "half-ball"), words.with("ambient_light", "mesh"));
                format!("only {points} has light points, and only {gathers} keeps gathered light")
            };
            host.note(&format!("{} is not used: {why}", words.with("mesh_file", path.display())));
            return Ok(mesh);
        }
        mesh.file = Some(path.to_owned());
        if !path.exists() {
            return Ok(mesh);
        }
        let load = || renderer.load_cache(path, prepared, &plan.settings);
        match host.during(&format!("reading {}", path.display()), load) {
            Ok(cache) => {
                let what = amount(cache.len(), cache.records_read());
                host.note(&format!("{}: read {what}", path.display()));
                mesh.cache = cache;
            }
            Err(error) if error.fault.is_replaceable() => refused(&error, host),
            Err(error) => return Err(error.into()),
        }
        Ok(mesh)
    }

    /// For each of several devices what it knows.
    pub(crate) fn parted(&mut self, ids: &[Option<u64>]) -> Vec<Mesh> {
        let parts = self.cache.parted(ids).into_iter();
        parts.map(|cache| Mesh { cache, file: self.file.clone() }).collect()
    }

    /// What all of them know.
    pub(crate) fn united(parts: impl Iterator<Item = Mesh>) -> Mesh {
        let mut all = Mesh { cache: MeshCache::new(), file: None };
        let take_file = |part: Mesh| {
            all.file = part.file;
            part.cache
        };
        let caches = parts.map(take_file).collect();
        all.cache.unite(caches);
        all
    }

    /// Whether there is a file.
    pub(crate) fn has_file(&self) -> bool {
        self.file.is_some()
    }

    /// Says so if the first image has shown that the file is of no use. To be called after each image.
    pub(crate) fn check(&mut self, host: &dyn Host) {
        while let Some(error) = self.cache.refused() {
            refused(&error, host);
        }
    }

    /// Writes what is known after the last image, of which the scene is `prepared`. Images are there by then: a file that cannot be written is
    /// worth a warning, not the images.
    pub(crate) fn save(&self, prepared: &PreparedScene, host: &dyn Host) {
        let Some(path) = &self.file else { return };
        match host.during(&format!("writing {}", path.display()), || self.cache.save(path, prepared)) {
            Ok(Some(SavedMesh { values, records, bytes, .. })) => {
                let (path, what, bytes) = (path.display(), amount(values, records), Bytes(bytes));
                host.note(&format!("{path}: wrote {what}, {bytes}"));
            }
            Ok(None) => {}
            Err(error) => host.warning(&format!("{error}; what was rendered is complete, later runs start without it")),
        }
    }
}

/// How much a file holds.
fn amount(values: u64, records: u64) -> String {
    let of_points = format!("{values} values of light points");
    let of_records = format!("{records} records of gathered light");
    match (values, records) {
        (_, 0) => of_points,
        (0, _) => of_records,
        _ => format!("{of_points} and {of_records}"),
    }
}

/// Says that a file, or a part of it, is of no use.
fn refused(error: &MeshFileError, host: &dyn Host) {
    let (path, fault) = (error.path.display(), &error.fault);
    let what = if fault.is_of_gathered_light() { "light is gathered anew" } else { "the mesh is built anew" };
    host.warning(&format!("{path}: {fault}; {what} and replaces it"));
}
