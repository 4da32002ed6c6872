//! What light points see, kept from picture to picture by whoever renders them.
//!
//! A light point's place depends on the step alone, and what it sees of a light on nothing but the geometry, its place, the light and, for
//! a light with a size, how that is sampled. As long as these stay the same no long test has to be made twice. A [`MeshCache`] belongs to
//! the caller; a picture has the same bits with it and without.
//!
//! A backend keeps a [`Table`] for each geometry: a row for each brick, a column for each light.

mod device;
mod host;

use std::sync::{Arc, Weak};

use glam::{UVec3, Vec3};
use lightmesh_scene::{Light, LightKind};

pub use device::DeviceTable;
pub use host::HostTable;

use crate::cuda::Driver;
use crate::job::Sampling;
use crate::light_mesh::Lattice;
use crate::prepared::{PreparedGeometry, PreparedScene};

/// What light points see of lights, for pictures to come: of a camera that moves, of lights of which some move. Give it to
/// [`Renderer::render_with`](crate::Renderer::render_with).
///
/// It holds the light points of each geometry that lives, as long as the step of the light mesh stays the same: with `--step auto` it
/// may change with the camera.
#[derive(Default)]
pub struct MeshCache {
    host: Kept<HostTable>,
    /// What stays in the memory of CUDA devices, by the number of the device.
    devices: Vec<(u64, Kept<DeviceTable<Driver>>)>,
}

impl MeshCache {
    /// A cache that knows nothing yet.
    pub fn new() -> MeshCache {
        MeshCache::default()
    }

    /// Number of answers: light points times lights.
    pub fn len(&self) -> u64 {
        self.host.len() + self.devices.iter().map(|(_, kept)| kept.len()).sum::<u64>()
    }

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that it takes, on the host and on devices.
    pub fn memory(&self) -> u64 {
        self.host.memory() + self.devices.iter().map(|(_, kept)| kept.memory()).sum::<u64>()
    }

    /// Forgets everything and frees its memory.
    pub fn clear(&mut self) {
        self.host.clear();
        self.devices.clear();
    }

    /// What the host knows.
    pub(crate) fn host(&mut self) -> &mut Kept<HostTable> {
        &mut self.host
    }

    /// What a device knows.
    pub(crate) fn device(&mut self, id: u64) -> &mut Kept<DeviceTable<Driver>> {
        let known = self.devices.iter().position(|(device, _)| *device == id);
        let index = known.unwrap_or_else(|| {
            self.devices.push((id, Kept::default()));
            self.devices.len() - 1
        });
        &mut self.devices[index].1
    }
}

/// What a backend knows of the light points of one geometry.
#[allow(clippy::len_without_is_empty, reason = "nobody asks")]
pub trait Table: Default {
    /// Number of answers: light points times lights.
    fn len(&self) -> u64;

    /// Bytes that it takes where the backend computes.
    fn memory(&self) -> u64;
}

/// The tables of a backend: one for each geometry that lives, for the lattice that it was last seen with.
pub struct Kept<T> {
    tables: Vec<Known<T>>,
}

struct Known<T> {
    /// The geometry itself is not kept alive. While this is here no other geometry can have its address.
    geometry: Weak<PreparedGeometry>,
    places: Places,
    table: T,
}

/// What decides where light points lie.
#[derive(Clone, Copy, PartialEq)]
struct Places {
    anchor: Vec3,
    step: f32,
    number: UVec3,
}

impl<T> Default for Kept<T> {
    fn default() -> Kept<T> {
        Kept { tables: Vec::new() }
    }
}

impl<T: Table> Kept<T> {
    /// Number of answers: light points times lights.
    #[allow(clippy::len_without_is_empty, reason = "nobody asks")]
    pub fn len(&self) -> u64 {
        self.tables.iter().map(|known| known.table.len()).sum()
    }

    /// Bytes that the tables take.
    pub fn memory(&self) -> u64 {
        self.tables.iter().map(|known| known.table.memory()).sum()
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.tables.clear();
    }

    /// The table of a scene's geometry, empty where it is new or its light points lie elsewhere now. Forgets geometry that is gone.
    pub(crate) fn table(&mut self, scene: &PreparedScene, lattice: &Lattice) -> &mut T {
        let Lattice { anchor, step, number, .. } = *lattice;
        let places = Places { anchor, step, number };
        let same = |known: &Known<T>| known.geometry.as_ptr() == Arc::as_ptr(&scene.geometry);
        self.tables.retain(|known| known.geometry.strong_count() > 0 && (!same(known) || known.places == places));
        let index = self.tables.iter().position(same).unwrap_or_else(|| {
            let geometry = Arc::downgrade(&scene.geometry);
            self.tables.push(Known { geometry, places, table: T::default() });
            self.tables.len() - 1
        });
        &mut self.tables[index].table
    }
}

/// What decides the values of a column, besides the light's number, which is the column's.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Seen {
    kind: LightKind,
    /// Samples and seed, for a light with a size.
    sampling: Option<(u32, u64)>,
}

impl Seen {
    pub(crate) fn of(light: &Light, sampling: &Sampling) -> Seen {
        let sampling = light.has_size().then_some((sampling.samples, sampling.seed));
        Seen { kind: light.kind.clone(), sampling }
    }

    /// Rays from each light point.
    pub(crate) fn samples(&self) -> u32 {
        self.sampling.map_or(1, |(samples, _)| samples)
    }

    /// Whether shares are seen, not bits.
    pub(crate) fn is_share(&self) -> bool {
        self.sampling.is_some()
    }
}
