//! Visibility of light points, cached from image to image by the caller.
//!
//! The position of a light point depends only on the step, and what it sees of a light only on the geometry, its position, the light and,
//! for an area light, the sampling. As long as these stay the same, no long test has to be repeated. A [`MeshCache`] belongs to the
//! caller; an image is bit-identical with and without it.
//!
//! A backend keeps a [`Table`] for each geometry: a row for each brick, a column for each light.

mod device;
mod host;
mod noticed;

use std::sync::{Arc, Weak};

use glam::{UVec3, Vec3};
use lightmesh_scene::{Light, LightKind};

pub use device::DeviceTable;
pub use host::HostTable;
pub(crate) use noticed::Noticed;

use crate::cuda::Driver;
use crate::gathered::Sources;
use crate::job::Sampling;
use crate::light_mesh::Lattice;
use crate::prepared::{PreparedGeometry, PreparedScene};

/// The visibility of light points, cached for later images, and light that surfaces gather: for a moving camera, or, of light points, for
/// lights of which only some move. Pass it to
/// [`Renderer::render_with`](crate::Renderer::render_with).
///
/// It holds the light points of every geometry that is alive, as long as the step of the light mesh stays the same: with `--step auto` it
/// may change with the camera.
#[derive(Default)]
pub struct MeshCache {
    host: Kept<HostTable>,
    /// What is kept in the memory of CUDA devices, by the device's id.
    devices: Vec<(u64, Kept<DeviceTable<Driver>>)>,
}

impl MeshCache {
    /// An empty cache.
    pub fn new() -> MeshCache {
        MeshCache::default()
    }

    /// Number of cached values: light points times lights.
    pub fn len(&self) -> u64 {
        self.host.len() + self.devices.iter().map(|(_, kept)| kept.len()).sum::<u64>()
    }

    /// Whether the cache is empty.
    pub fn is_empty(&self) -> bool {
        self.host.is_empty() && self.devices.iter().all(|(_, kept)| kept.is_empty())
    }

    /// Bytes used, on the host and on devices.
    pub fn memory(&self) -> u64 {
        self.host.memory() + self.devices.iter().map(|(_, kept)| kept.memory()).sum::<u64>()
    }

    /// Empties the cache and frees its memory.
    pub fn clear(&mut self) {
        self.host.clear();
        self.devices.clear();
    }

    /// The part that is kept on the host.
    pub(crate) fn host(&mut self) -> &mut Kept<HostTable> {
        &mut self.host
    }

    /// The part that is kept on a device.
    pub(crate) fn device(&mut self, id: u64) -> &mut Kept<DeviceTable<Driver>> {
        let known = self.devices.iter().position(|(device, _)| *device == id);
        let index = known.unwrap_or_else(|| {
            self.devices.push((id, Kept::default()));
            self.devices.len() - 1
        });
        &mut self.devices[index].1
    }
}

/// What a backend knows about the light points of one geometry.
#[allow(clippy::len_without_is_empty, reason = "not needed")]
pub trait Table: Default {
    /// What surfaces gather.
    type Light: Default;
    /// What may fail.
    type Error;

    /// Bytes that this uses.
    fn memory_of(light: &Self::Light) -> u64;

    /// Number of cached values: light points times lights.
    fn len(&self) -> u64;

    /// Bytes used in the backend's memory.
    fn memory(&self) -> u64;

    /// Forgets the values that `noticed` may have changed. After an error the table must be dropped.
    fn forget(&mut self, noticed: &Noticed) -> Result<(), Self::Error>;
}

/// The tables of a backend: one for each geometry that is alive, for the lattice that it was last used with.
pub struct Kept<T: Table> {
    tables: Vec<Known<T>>,
    gathered: Vec<Gathered<T::Light>>,
}

struct Known<T> {
    /// The geometry itself is not kept alive. While this exists, no other geometry can have its address.
    geometry: Weak<PreparedGeometry>,
    places: Places,
    table: T,
}

/// What determines the positions of light points.
#[derive(Clone, Copy, PartialEq)]
struct Places {
    anchor: Vec3,
    step: f32,
    number: UVec3,
}

/// What surfaces of a geometry gather.
struct Gathered<L> {
    geometry: Weak<PreparedGeometry>,
    sources: Sources,
    light: L,
}

impl<T: Table> Default for Kept<T> {
    fn default() -> Kept<T> {
        Kept { tables: Vec::new(), gathered: Vec::new() }
    }
}

impl<T: Table> Kept<T> {
    /// Number of cached values: light points times lights.
    pub fn len(&self) -> u64 {
        self.tables.iter().map(|known| known.table.len()).sum()
    }

    /// Whether nothing is kept: no values, and no gathered light.
    pub fn is_empty(&self) -> bool {
        self.len() == 0 && self.gathered.is_empty()
    }

    /// Bytes used.
    pub fn memory(&self) -> u64 {
        let gathered: u64 = self.gathered.iter().map(|gathered| T::memory_of(&gathered.light)).sum();
        self.tables.iter().map(|known| known.table.memory()).sum::<u64>() + gathered
    }

    /// Removes everything.
    pub(crate) fn clear(&mut self) {
        self.tables.clear();
        self.gathered.clear();
    }

    /// Takes out what surfaces gathered from the same sources; nothing if there are others. Removes that of geometry that no longer exists.
    pub(crate) fn take_gathered(&mut self, scene: &PreparedScene, sources: &Sources) -> T::Light {
        self.gathered.retain(|gathered| gathered.geometry.strong_count() > 0);
        let same = |gathered: &Gathered<T::Light>| gathered.geometry.as_ptr() == Arc::as_ptr(&scene.geometry);
        let Some(index) = self.gathered.iter().position(same) else { return T::Light::default() };
        let Gathered { sources: known, light, .. } = self.gathered.swap_remove(index);
        if known == *sources { light } else { T::Light::default() }
    }

    /// Keeps what surfaces gather.
    pub(crate) fn keep_gathered(&mut self, scene: &PreparedScene, sources: Sources, light: T::Light) {
        self.gathered.push(Gathered { geometry: Arc::downgrade(&scene.geometry), sources, light });
    }

    /// The table of a scene's geometry, empty if it is new or its light points have moved. If things have moved in it, the table is that of
    /// before without what they may have changed. Removes tables of geometry that no longer exists.
    pub(crate) fn table(&mut self, scene: &PreparedScene, lattice: &Lattice) -> Result<&mut T, T::Error> {
        let Lattice { anchor, step, number, .. } = *lattice;
        let places = Places { anchor, step, number };
        let same = |known: &Known<T>| known.geometry.as_ptr() == Arc::as_ptr(&scene.geometry);
        self.tables.retain(|known| known.geometry.strong_count() > 0 && (!same(known) || known.places == places));
        let index = match self.tables.iter().position(same) {
            Some(index) => index,
            None => {
                let table = self.moved(scene, lattice, &places)?.unwrap_or_default();
                self.tables.push(Known { geometry: Arc::downgrade(&scene.geometry), places, table });
                self.tables.len() - 1
            }
        };
        Ok(&mut self.tables[index].table)
    }

    /// The table of geometry in which things have moved since, if its light points are at the same places.
    fn moved(&mut self, scene: &PreparedScene, lattice: &Lattice, places: &Places) -> Result<Option<T>, T::Error> {
        let Some(moved) = &scene.geometry.moved else { return Ok(None) };
        let was = |known: &Known<T>| known.geometry.ptr_eq(&moved.before) && known.places == *places;
        let Some(index) = self.tables.iter().position(was) else { return Ok(None) };
        let mut table = self.tables.swap_remove(index).table;
        table.forget(&Noticed::new(&moved.boxes, lattice, &scene.geometry))?;
        Ok(Some(table))
    }
}

/// What determines the values of a column, apart from the light's index, which is the column's.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Seen {
    kind: LightKind,
    /// Samples and seed, for an area light.
    sampling: Option<(u32, u64)>,
}

impl Seen {
    pub(crate) fn of(light: &Light, sampling: &Sampling) -> Seen {
        let sampling = light.has_size().then_some((sampling.samples, sampling.seed));
        Seen { kind: light.kind.clone(), sampling }
    }

    /// The shape of the light.
    pub(crate) fn kind(&self) -> &LightKind {
        &self.kind
    }

    /// Number of rays from each light point.
    pub(crate) fn samples(&self) -> u32 {
        self.sampling.map_or(1, |(samples, _)| samples)
    }

    /// Whether values are shares rather than bits.
    pub(crate) fn is_share(&self) -> bool {
        self.sampling.is_some()
    }
}
