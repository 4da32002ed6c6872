//! Visibility of light points, cached from image to image by the caller.
//!
//! The position of a light point depends only on the step, and what it sees of a light only on the geometry, its position, the light and,
//! for an area light, the sampling. As long as these stay the same, no long test has to be repeated. A [`MeshCache`] belongs to the
//! caller; an image is bit-identical with and without it.
//!
//! A backend keeps a [`Table`] for each geometry: a row for each brick, a column for each light. What all
//! backends keep goes to the same [files](file), and comes from there, by way of one [form](content).

pub(crate) mod column_key;
pub(crate) mod content;
mod device;
pub(crate) mod file;
mod host;
pub(crate) mod invalidation;
pub(crate) mod stored;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};

use lightmesh_kernels::Driver;
use lightmesh_memory::Budget;

pub(crate) use column_key::ColumnKey;
pub(crate) use content::{Content, Places, SavedGathered, Section};
pub use device::DeviceTable;
pub use file::{MeshFault, MeshFileError, MeshSaveError, SavedMesh};
pub use host::HostTable;
pub(crate) use invalidation::Invalidation;
use stored::Stored;

use crate::error::RenderError;
use crate::light_mesh::Lattice;
use crate::prepared::{PreparedGeometry, PreparedScene};
use crate::stages::irradiance_cache::Sources;
use crate::stages::irradiance_cache::saved::SavedLight;

/// The visibility of light points, cached for later images, and light that surfaces gather: for a moving camera, or, of light points, for
/// lights of which only some move. Pass it to
/// [`Renderer::render_with`](crate::Renderer::render_with).
///
/// It holds the light points of every geometry that is alive, as long as the step of the light mesh stays the same: with `--step auto` it
/// may change with the camera.
#[derive(Default)]
pub struct MeshCache {
    host: Cache<HostTable>,
    /// What is kept in the memory of CUDA devices, by the device's id.
    devices: Vec<(u64, Cache<DeviceTable<Driver>>)>,
    /// What was read from a file, until it is asked for where images are rendered.
    read: Content,
    /// The file.
    file: PathBuf,
}

impl MeshCache {
    /// An empty cache.
    pub fn new() -> MeshCache {
        MeshCache::default()
    }

    /// A cache with what was [saved](MeshCache::save) for the geometry of `scene`, on any device. Values for a light that has changed since
    /// are computed anew, and replaced. If light points of an image are at other places, none of the file's are used; if what surfaces gather
    /// depends on anything that has changed, it is gathered anew: [`MeshCache::refused`] says so. At most as much memory is taken as `budget` allows.
    ///
    /// # Errors
    /// [`MeshFileError`] if the file cannot be read, is of another kind or version, belongs to other geometry, is damaged, or does not fit into
    /// memory. [`MeshFault::is_replaceable`] tells files that a new one may replace from those that are something else.
    pub fn load(path: impl AsRef<Path>, scene: &PreparedScene, budget: Budget) -> Result<MeshCache, MeshFileError> {
        let path = path.as_ref();
        Ok(MeshCache { read: file::load(path, scene, budget)?, file: path.into(), ..MeshCache::default() })
    }

    /// Writes what light points of a scene's geometry see, and what its surfaces gathered, whole or not at all, in the form that is the same for
    /// all devices. `None` if nothing is known of it, and no file is written then.
    ///
    /// # Errors
    /// [`MeshSaveError`] if the file cannot be written, or a device fails.
    pub fn save(&self, path: impl AsRef<Path>, scene: &PreparedScene) -> Result<Option<SavedMesh>, MeshSaveError> {
        let path = path.as_ref();
        let mut content = self.host.content(path, scene)?;
        for (_, cache) in &self.devices {
            content.append(&mut cache.content(path, scene)?);
        }
        content.append(&mut self.read.clone());
        file::save(path, scene, content)
    }

    /// Why light points, or gathered light, of the file that the cache was loaded from could not be used, if that turned out with an image. Says
    /// so once; to be asked until there is nothing more.
    pub fn refused(&mut self) -> Option<MeshFileError> {
        let on_devices = self.devices.iter_mut().find_map(|(_, cache)| cache.refused.pop());
        let fault = self.host.refused.pop().or(on_devices)?;
        Some(MeshFileError { path: self.file.clone(), fault })
    }

    /// Number of records whose gathered light was read from a file and not yet asked for.
    pub fn records_read(&self) -> u64 {
        let on_devices: u64 = self.devices.iter().map(|(_, cache)| cache.read.records()).sum();
        self.read.records() + self.host.read.records() + on_devices
    }

    /// Number of cached values: light points times lights.
    pub fn len(&self) -> u64 {
        self.read.len() + self.host.len() + self.devices.iter().map(|(_, cache)| cache.len()).sum::<u64>()
    }

    /// Whether the cache is empty.
    pub fn is_empty(&self) -> bool {
        self.read.is_empty() && self.host.is_empty() && self.devices.iter().all(|(_, cache)| cache.is_empty())
    }

    /// Bytes used, on the host and on devices.
    pub fn memory(&self) -> u64 {
        let read = self.read.memory_of_points() + self.read.memory_of_gathered();
        read + self.host.memory() + self.devices.iter().map(|(_, cache)| cache.memory()).sum::<u64>()
    }

    /// Empties the cache and frees its memory.
    pub fn clear(&mut self) {
        self.read = Content::default();
        self.host.clear();
        self.devices.clear();
    }

    /// The part that is kept on the host.
    pub(crate) fn host(&mut self) -> &mut Cache<HostTable> {
        self.host.read.append(&mut self.read);
        &mut self.host
    }

    /// The part that is kept on a device.
    pub(crate) fn device(&mut self, id: u64) -> &mut Cache<DeviceTable<Driver>> {
        let known = self.devices.iter().position(|(device, _)| *device == id);
        let index = known.unwrap_or_else(|| {
            self.devices.push((id, Cache::default()));
            self.devices.len() - 1
        });
        let cache = &mut self.devices[index].1;
        cache.read.append(&mut self.read);
        cache
    }
}

/// What is kept by one of several renderers that render parts of an image, see [`MeshCache::parted`].
impl MeshCache {
    /// For each renderer a cache with what it knows: that of the host, or of the device with an id. What a file has is in all of them.
    pub fn parted(&mut self, ids: &[Option<u64>]) -> Vec<MeshCache> {
        let read = std::mem::take(&mut self.read);
        let part = |id: &Option<u64>| {
            let mut part = MeshCache { read: read.clone(), file: self.file.clone(), ..MeshCache::default() };
            match *id {
                None => part.host = std::mem::take(&mut self.host),
                Some(id) => part.devices = self.devices.extract_if(.., |(device, _)| *device == id).collect(),
            }
            part
        };
        ids.iter().map(part).collect()
    }

    /// Takes back what [`MeshCache::parted`] has given to renderers.
    pub fn unite(&mut self, parts: Vec<MeshCache>) {
        for (number, mut part) in parts.into_iter().enumerate() {
            // All have the same; what one has asked for is in its own part.
            if number == 0 {
                self.read.append(&mut part.read);
            }
            if !part.host.is_empty() || !part.host.refused.is_empty() {
                self.host = part.host;
            }
            self.devices.append(&mut part.devices);
        }
    }
}

/// What a backend knows about the light points of one geometry.
#[allow(clippy::len_without_is_empty, reason = "not needed")]
pub trait Table: Default {
    /// What surfaces gather.
    type Light: Default;
    /// What may fail.
    type Error: Into<RenderError>;

    /// Bytes that this uses.
    fn memory_of(light: &Self::Light) -> u64;

    /// What surfaces gather, in the form that is the same for all backends.
    fn saved_light(light: &Self::Light) -> Result<SavedLight, Self::Error>;

    /// The same for this backend.
    fn restored_light(saved: SavedLight) -> Self::Light;

    /// Number of cached values: light points times lights.
    fn len(&self) -> u64;

    /// Bytes used in the backend's memory.
    fn memory(&self) -> u64;

    /// Evicts the values that `invalidation` may have changed. After an error the table must be dropped.
    fn evict(&mut self, invalidation: &Invalidation) -> Result<(), Self::Error>;

    /// Sets what holds until the next image.
    fn allow(&mut self, allowance: Allowance);

    /// All values, in the form that is the same for all backends.
    fn stored(&self) -> Result<Stored, Self::Error>;

    /// A table with these values.
    fn restored(stored: Stored) -> Self;
}

/// What a table may take for an image.
#[derive(Clone, Copy, Debug, Default)]
pub struct Allowance {
    /// The number of the image, which becomes the age of what it uses.
    pub image: u32,
    /// Bytes; `None`: as many as there are.
    pub most: Option<u64>,
}

/// Light points may take one part in this many of the memory that is left.
const PART_KEPT: u64 = 4;

/// The tables of a backend: one for each geometry that is alive, for the lattice that it was last used with.
pub struct Cache<T: Table> {
    tables: Vec<Known<T>>,
    gathered: Vec<Gathered<T::Light>>,
    /// What was read from a file, until its geometry is asked for.
    read: Content,
    /// Why some of it could not be used.
    refused: Vec<MeshFault>,
    allowance: Allowance,
}

struct Known<T> {
    /// The geometry itself is not kept alive. While this exists, no other geometry can have its address.
    geometry: Weak<PreparedGeometry>,
    places: Places,
    table: T,
}

/// What surfaces of a geometry gather.
struct Gathered<L> {
    geometry: Weak<PreparedGeometry>,
    sources: Sources,
    light: L,
}

impl<L> Gathered<L> {
    /// Whether it belongs to the geometry of `scene`.
    fn is_of(&self, scene: &PreparedScene) -> bool {
        self.geometry.as_ptr() == Arc::as_ptr(&scene.geometry)
    }
}

impl<T: Table> Default for Cache<T> {
    fn default() -> Cache<T> {
        Cache {
            tables: Vec::new(),
            gathered: Vec::new(),
            read: Content::default(),
            refused: Vec::new(),
            allowance: Allowance::default(),
        }
    }
}

impl<T: Table> Cache<T> {
    /// Number of cached values: light points times lights.
    pub fn len(&self) -> u64 {
        self.tables.iter().map(|known| known.table.len()).sum::<u64>() + self.read.len()
    }

    /// Whether nothing is kept: no values, and no gathered light.
    pub fn is_empty(&self) -> bool {
        self.len() == 0 && self.gathered.is_empty() && self.read.is_empty()
    }

    /// Bytes used.
    pub fn memory(&self) -> u64 {
        let gathered: u64 = self.gathered.iter().map(|gathered| T::memory_of(&gathered.light)).sum();
        self.memory_of_tables() + gathered + self.read.memory_of_gathered()
    }

    /// Removes everything.
    pub(crate) fn clear(&mut self) {
        self.tables.clear();
        self.gathered.clear();
        self.read = Content::default();
    }

    /// Begins an image that has light points, if `left` bytes are left for it: bricks that were not used for the longest give way if what is
    /// known takes more than its part. Returns the bytes that tables may still take.
    pub(crate) fn reserve(&mut self, left: Option<u64>) -> u64 {
        let held = self.memory_of_tables();
        let most = left.map(|left| (left + held) / PART_KEPT);
        self.allowance = Allowance { image: self.allowance.image + 1, most };
        most.map_or(0, |most| most.saturating_sub(held))
    }

    /// Bytes that light points take.
    fn memory_of_tables(&self) -> u64 {
        self.tables.iter().map(|known| known.table.memory()).sum::<u64>() + self.read.memory_of_points()
    }

    /// [`MeshCache::load`] for one backend.
    ///
    /// # Errors
    /// As [`MeshCache::load`].
    pub fn load(path: impl AsRef<Path>, scene: &PreparedScene, budget: Budget) -> Result<Cache<T>, MeshFileError> {
        Ok(Cache { read: file::load(path.as_ref(), scene, budget)?, ..Cache::default() })
    }

    /// [`MeshCache::save`] for one backend.
    ///
    /// # Errors
    /// As [`MeshCache::save`].
    pub fn save(&self, path: impl AsRef<Path>, scene: &PreparedScene) -> Result<Option<SavedMesh>, MeshSaveError> {
        let path = path.as_ref();
        file::save(path, scene, self.content(path, scene)?)
    }

    /// All that is known of a scene's geometry, in the form of files; `path` is for messages.
    fn content(&self, path: &Path, scene: &PreparedScene) -> Result<Content, MeshSaveError> {
        let failed = |reason: T::Error| MeshSaveError::Device { path: path.into(), reason: Box::new(reason.into()) };
        let mut content = self.read.clone();
        for geometry in scene.geometry.all_parts() {
            for known in self.tables.iter().filter(|known| known.geometry.as_ptr() == Arc::as_ptr(geometry)) {
                let stored = known.table.stored().map_err(failed)?;
                content.points.push(Section { geometry: geometry.hash(), places: known.places, stored });
            }
        }
        for gathered in self.gathered.iter().filter(|gathered| gathered.is_of(scene)) {
            content.gathered.push(SavedGathered {
                geometry: scene.geometry.hash(),
                sources: gathered.sources.hash(scene),
                light: T::saved_light(&gathered.light).map_err(failed)?,
            });
        }
        Ok(content)
    }

    /// Takes out what surfaces gathered from the same sources; nothing if there are others. Removes that of geometry that no longer exists.
    pub(crate) fn take_gathered(&mut self, scene: &PreparedScene, sources: &Sources) -> T::Light {
        self.gathered.retain(|gathered| gathered.geometry.strong_count() > 0);
        let Some(index) = self.gathered.iter().position(|gathered| gathered.is_of(scene)) else {
            return self.restored_gathered(scene, sources).unwrap_or_default();
        };
        let Gathered { sources: known, light, .. } = self.gathered.swap_remove(index);
        if known == *sources { light } else { T::Light::default() }
    }

    /// What surfaces gathered of which a file was read, if it depends on nothing else.
    fn restored_gathered(&mut self, scene: &PreparedScene, sources: &Sources) -> Option<T::Light> {
        if self.read.gathered.is_empty() {
            return None;
        }
        let hash = scene.geometry.hash();
        let index = self.read.gathered.iter().position(|gathered| gathered.geometry == hash)?;
        let gathered = self.read.gathered.swap_remove(index);
        if gathered.sources != sources.hash(scene) {
            self.refused.push(MeshFault::OtherSources);
            return None;
        }
        Some(T::restored_light(gathered.light))
    }

    /// Keeps what surfaces gather.
    pub(crate) fn insert_gathered(&mut self, scene: &PreparedScene, sources: Sources, light: T::Light) {
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
                let table = self
                    .deformed(scene, lattice, &places)?
                    .or_else(|| self.restored(scene, &places))
                    .unwrap_or_default();
                self.tables.push(Known { geometry: Arc::downgrade(&scene.geometry), places, table });
                self.tables.len() - 1
            }
        };
        let most = self.allowance.most.map(|most| most / self.tables.len() as u64);
        let table = &mut self.tables[index].table;
        table.allow(Allowance { most, ..self.allowance });
        Ok(table)
    }

    /// The table of geometry of which a file was read, if its light points are at the same places.
    fn restored(&mut self, scene: &PreparedScene, places: &Places) -> Option<T> {
        if self.read.points.is_empty() {
            return None;
        }
        let hash = scene.geometry.hash();
        let index = self.read.points.iter().position(|section| section.geometry == hash)?;
        let mut section = self.read.points.swap_remove(index);
        if section.places != *places {
            self.refused.push(MeshFault::OtherStep { found: section.places.step, expected: places.step });
            return None;
        }
        section.stored.limit(self.allowance.most);
        Some(T::restored(section.stored))
    }

    /// The table of geometry in which things have moved since, if its light points are at the same places.
    fn deformed(&mut self, scene: &PreparedScene, lattice: &Lattice, places: &Places) -> Result<Option<T>, T::Error> {
        let Some(deformation) = &scene.geometry.deformation else { return Ok(None) };
        let was = |known: &Known<T>| known.geometry.ptr_eq(&deformation.before) && known.places == *places;
        let Some(index) = self.tables.iter().position(was) else { return Ok(None) };
        let mut table = self.tables.swap_remove(index).table;
        table.evict(&Invalidation::new(&deformation.boxes, lattice, &scene.geometry))?;
        Ok(Some(table))
    }
}
