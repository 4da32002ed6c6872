//! Gathered light on a CUDA device: the steps of [`super`], launch by launch.
//!
//! What is kept stays in the device's memory, in tables that grow. Which of two cells, sites or nodes gets its number first may differ from
//! run to run; what belongs to it does not.

mod bounce;
mod cells;
mod device;
mod fans;
mod far;
mod fine;
mod names;
mod saved;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::gathered::{GatherPoints, LightPlace};
use lightmesh_layout::geometry::Vec3;

use super::saved::SavedLight;
use super::{Gathering, PART_KEPT};
use crate::error::RenderError;
use crate::gpu::Cuda;
use crate::gpu::rays::DeviceWave;
use crate::shading::has_reliefs;
use bounce::DeviceBounce;
use cells::DeviceCells;
use device::{Device, read_count};
use far::DeviceFar;
use fine::{Asking, Coarse, DeviceFine};

/// Surface points that are processed at once, and rays that are cast at once, at least.
const MIN_AT_ONCE: usize = 1 << 18;
/// How many times more there may be, at most.
const MAX_TIMES: u64 = 8;
/// Bytes of a point: its places and links.
const BYTES_OF_POINT: u64 = 512;
/// Bytes of a ray with all that is known of it, three times, for what it hits asks again.
const BYTES_OF_RAY: u64 = 3 * 160;
/// What takes memory at once, at least: also tables while they grow.
const MIN_BYTES: u64 = (BYTES_OF_POINT + BYTES_OF_RAY) * MIN_AT_ONCE as u64 + (64 << 20);

/// Tables take at most so many times the memory of what is saved: half of their slots are empty, or more.
const TIMES_OF_SAVED: u64 = 4;

/// What was gathered for a scene, on a device.
pub struct DeviceSurfaceLight<R: Runtime> {
    kept: Option<Kept<R>>,
    /// What was read from a file, until the device is at hand; nothing else is kept then.
    saved: Option<SavedLight>,
}

impl<R: Runtime> Default for DeviceSurfaceLight<R> {
    fn default() -> DeviceSurfaceLight<R> {
        DeviceSurfaceLight { kept: None, saved: None }
    }
}

struct Kept<R: Runtime> {
    fine_cells: DeviceCells<R>,
    fine: DeviceFine<R>,
    far_cells: DeviceCells<R>,
    far: DeviceFar<R>,
    bounce: DeviceBounce<R>,
}

impl<R: Runtime> Kept<R> {
    fn new(cuda: &Cuda<R>) -> Result<Kept<R>, RenderError> {
        Ok(Kept {
            fine_cells: DeviceCells::new(cuda)?,
            fine: DeviceFine::new(cuda)?,
            far_cells: DeviceCells::new(cuda)?,
            far: DeviceFar::new(cuda)?,
            bounce: DeviceBounce::new(cuda)?,
        })
    }

    fn memory(&self) -> u64 {
        let cells = self.fine_cells.memory() + self.far_cells.memory();
        cells + self.fine.memory() + self.far.memory() + self.bounce.memory()
    }
}

impl<R: Runtime> DeviceSurfaceLight<R> {
    /// Bytes in the device's memory.
    pub(crate) fn memory(&self) -> u64 {
        self.kept.as_ref().map_or(0, Kept::memory)
    }

    /// Takes out what is kept, in the device's memory: what is known, or of a file if it takes no more than `most` bytes.
    fn take(&mut self, device: &Device<R>, most: Option<u64>) -> Result<Kept<R>, RenderError> {
        let fits = |saved: &SavedLight| most.is_none_or(|most| TIMES_OF_SAVED * saved.memory() <= most);
        match (self.kept.take(), self.saved.take().filter(fits)) {
            (Some(kept), _) => Ok(kept),
            (None, Some(saved)) => Kept::restored(device, &saved),
            (None, None) => Kept::new(device.cuda),
        }
    }
}

/// The mean radiance that each surface point of a wave receives, on a device.
pub struct DeviceGathered<R: Runtime> {
    pub(crate) light: Buffer<R, Vec3>,
}

/// Bytes that gathering needs on a device, besides what it keeps.
pub(crate) fn memory_at_once() -> u64 {
    MIN_BYTES
}

/// The mean radiance that each surface point of a wave receives, weighted by the cosine; zero for rays that see nothing.
pub(crate) fn gather<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    how: &Gathering,
    light: &mut DeviceSurfaceLight<R>,
) -> Result<DeviceGathered<R>, RenderError> {
    // More at once keep a large device busy; they change no result.
    let times = cuda.memory_left().map_or(1, |left| (left / PART_KEPT / MIN_BYTES).clamp(1, MAX_TIMES));
    let at_once = MIN_AT_ONCE * times as usize;
    let device = Device { cuda, wave, rays: at_once };
    let rays = wave.rays.len();
    let result = cuda.pool().zeros("gathered light", rays)?;
    for first in (0..rays).step_by(at_once) {
        wave.context.check()?;
        let most = cuda.memory_left().map(|left| (left + light.memory()) / PART_KEPT);
        if most.is_some_and(|most| light.memory() > most) {
            light.kept = None;
        }
        // In case of an error it is lost: tables may be incomplete.
        let mut kept = light.take(&device, most)?;
        let count = at_once.min(rays - first);
        gather_part(&device, how, &mut kept, first..first + count, &result)?;
        light.kept = Some(kept);
        wave.context.advance(count as u64);
    }
    Ok(DeviceGathered { light: result })
}

fn gather_part<R: Runtime>(
    device: &Device<R>,
    how: &Gathering,
    kept: &mut Kept<R>,
    rays: std::ops::Range<usize>,
    light: &Buffer<R, Vec3>,
) -> Result<(), RenderError> {
    let Device { cuda, wave, .. } = device;
    let Kept { fine_cells, fine, far_cells, far, bounce } = kept;
    // 1. Where light is asked for: at one level, or between two.
    let places = cuda.pool().room::<LightPlace>("places that ask for light", 2 * rays.len())?;
    let means = cuda.pool().room::<Vec3>("answers to these", 2 * rays.len())?;
    let alone = cuda.pool().room::<u32>("places without any", 2 * rays.len())?;
    let alone_count = cuda.pool().zeros::<u32>("number of places without any", 1)?;
    let mut record = GatherPoints {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        places: places.output(),
        means: means.output(),
        alone: alone.output(),
        alone_count: alone_count.output(),
        light: light.output(),
        eye: how.eye.to_array().into(),
        spacing: how.spacing,
        pixels: how.pixels,
        least_level: how.least_level,
        first: rays.start as u32,
        count: rays.len() as u32,
        ..GatherPoints::zeroed()
    };
    if let Some(sampled) = &wave.rays.sampled {
        record.samples = sampled.hits.input();
        record.sample_count = sampled.count;
        record.first_sampled = sampled.first;
        record.sampled_pixels = sampled.pixels;
    }
    device.threads("ask_light", rays.len(), &record)?;
    let relief = has_reliefs(&wave.scene.host.scene.geometry);
    let normals = relief.then(|| cuda.pool().room::<Vec3>("normals by their images", rays.len())).transpose()?;
    if let Some(normals) = &normals {
        record.normals = normals.output();
        device.threads("find_normals", rays.len(), &record)?;
    }

    // 2. The fine sites around that are seen, and what they receive.
    let mut coarse = Coarse { cells: far_cells, far, bounce, fans: &how.fans };
    let links = match how.alone {
        true => None,
        false => {
            let links = fine_cells.links(device, &places)?;
            let new = fine_cells.value(device, &places, &links)?;
            fine.extend(device, fine_cells, new, &mut coarse)?;
            fine_cells.settle(device, &places, &links)?;
            Some(links)
        }
    };

    // 3. The mean. Where there is none, the point counts as a fine site itself.
    let record = match &links {
        Some(links) => GatherPoints { lookup: fine_cells.lookup(device, &places, links), fine: fine.input(), ..record },
        None => GatherPoints { all_alone: 1, ..record },
    };
    let both = GatherPoints { count: places.len() as u32, ..record };
    device.threads("mean_light", places.len(), &both)?;
    let count = read_count(&alone_count)?;
    let at_once = device.at_once(if how.alone { how.fans.far[0] } else { how.fans.near });
    for first in (0..count).step_by(at_once) {
        let count = at_once.min(count - first);
        let sites = cuda.pool().room("surface points that see no site", count)?;
        let asked = cuda.pool().room("these as places that ask", count)?;
        let some = GatherPoints {
            sites: sites.output(),
            asked: asked.output(),
            first_alone: first as u32,
            count: count as u32,
            ..record
        };
        device.threads("take_alone", count, &some)?;
        if how.alone {
            let far = far::plain(device, coarse.bounce, sites, how.fans.far)?;
            device.threads("give_alone", count, &GatherPoints { far: far.input(), ..some })?;
        } else {
            let own = fine::plain(device, Asking { sites, places: asked }, &mut coarse)?;
            device.threads("give_alone", count, &GatherPoints { own: own.input(), ..some })?;
        }
    }
    device.threads("add_means", rays.len(), &record)
}
