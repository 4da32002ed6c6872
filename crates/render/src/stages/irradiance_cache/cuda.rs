//! Gathered light on a CUDA device: the steps of [`super`], launch by launch.
//!
//! What is kept stays in the device's memory, in tables that grow. Which of two cells, records or nodes gets its number first may differ from
//! run to run; what belongs to it does not.

mod bounce;
mod cells;
mod coarse;
mod device;
mod fine;
mod hemisphere_rays;
mod names;
mod saved;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::geometry::Vec3;
use lightmesh_layout::irradiance_cache::{GatherPoints, LightPlace};

use super::saved::SavedLight;
use super::{Gathering, PART_KEPT};
use crate::error::RenderError;
use crate::gpu::Cuda;
use crate::gpu::rays::DeviceWave;
use crate::shading::has_reliefs;
use crate::steps::Steps;
use bounce::DeviceBounce;
use cells::DeviceCells;
use coarse::DeviceCoarse;
use device::{Device, read_count};
use fine::{Asking, CoarseRecords, DeviceFine};

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
    tables: Option<Tables<R>>,
    /// What was read from a file, until the device is at hand; there are no tables then.
    saved: Option<SavedLight>,
}

impl<R: Runtime> Default for DeviceSurfaceLight<R> {
    fn default() -> DeviceSurfaceLight<R> {
        DeviceSurfaceLight { tables: None, saved: None }
    }
}

/// All records.
struct Tables<R: Runtime> {
    fine_cells: DeviceCells<R>,
    fine: DeviceFine<R>,
    coarse_cells: DeviceCells<R>,
    coarse: DeviceCoarse<R>,
    bounce: DeviceBounce<R>,
}

impl<R: Runtime> Tables<R> {
    fn new(cuda: &Cuda<R>) -> Result<Tables<R>, RenderError> {
        Ok(Tables {
            fine_cells: DeviceCells::new(cuda)?,
            fine: DeviceFine::new(cuda)?,
            coarse_cells: DeviceCells::new(cuda)?,
            coarse: DeviceCoarse::new(cuda)?,
            bounce: DeviceBounce::new(cuda)?,
        })
    }

    fn memory(&self) -> u64 {
        let cells = self.fine_cells.memory() + self.coarse_cells.memory();
        cells + self.fine.memory() + self.coarse.memory() + self.bounce.memory()
    }
}

impl<R: Runtime> DeviceSurfaceLight<R> {
    /// Bytes in the device's memory.
    pub(crate) fn memory(&self) -> u64 {
        self.tables.as_ref().map_or(0, Tables::memory)
    }

    /// Takes out the tables: those that there are, or those of a file if it takes no more than `most` bytes.
    fn take(&mut self, device: &Device<R>, most: Option<u64>) -> Result<Tables<R>, RenderError> {
        let fits = |saved: &SavedLight| most.is_none_or(|most| TIMES_OF_SAVED * saved.memory() <= most);
        match (self.tables.take(), self.saved.take().filter(fits)) {
            (Some(tables), _) => Ok(tables),
            (None, Some(saved)) => Tables::restored(device, &saved),
            (None, None) => Tables::new(device.cuda),
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
    let sizes = (0..rays).step_by(at_once).map(|first| at_once.min(rays - first));
    let mut steps = Steps::new(wave.context, sizes, how.sharing(light.tables.is_none(), false));
    for first in (0..rays).step_by(at_once) {
        wave.context.check()?;
        let most = cuda.memory_left().map(|left| (left + light.memory()) / PART_KEPT);
        if most.is_some_and(|most| light.memory() > most) {
            light.tables = None;
        }
        // In case of an error it is lost: tables may be incomplete.
        let mut tables = light.take(&device, most)?;
        let count = at_once.min(rays - first);
        gather_part(&device, how, &mut tables, (first..first + count, &result), &mut steps)?;
        light.tables = Some(tables);
        steps.end_part();
    }
    Ok(DeviceGathered { light: result })
}

fn gather_part<R: Runtime>(
    device: &Device<R>,
    how: &Gathering,
    tables: &mut Tables<R>,
    (rays, light): (std::ops::Range<usize>, &Buffer<R, Vec3>),
    steps: &mut Steps,
) -> Result<(), RenderError> {
    let Device { cuda, wave, .. } = device;
    let Tables { fine_cells, fine, coarse_cells, coarse, bounce } = tables;
    // 1. Where light is asked for: at one level, or between two.
    let places = cuda.pool().room::<LightPlace>("places that ask for light", 2 * rays.len())?;
    let means = cuda.pool().room::<Vec3>("answers to these", 2 * rays.len())?;
    let misses = cuda.pool().room::<u32>("places without any", 2 * rays.len())?;
    let miss_count = cuda.pool().zeros::<u32>("number of places without any", 1)?;
    let mut arguments = GatherPoints {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        places: places.output(),
        means: means.output(),
        misses: misses.output(),
        miss_count: miss_count.output(),
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
        arguments.samples = sampled.hits.input();
        arguments.sample_count = sampled.count;
        arguments.first_sampled = sampled.first;
        arguments.sampled_pixels = sampled.pixels;
    }
    device.threads("ask_light", rays.len(), &arguments)?;
    let relief = has_reliefs(&wave.scene.host.scene.geometry);
    let normals = relief.then(|| cuda.pool().room::<Vec3>("normals by their images", rays.len())).transpose()?;
    if let Some(normals) = &normals {
        arguments.normals = normals.output();
        device.threads("find_normals", rays.len(), &arguments)?;
    }

    // 2. The fine records around that are seen, and what they receive.
    let mut coarse = CoarseRecords { cells: coarse_cells, values: coarse, bounce, rays: &how.rays };
    let links = match how.brute_force {
        true => None,
        false => {
            let links = fine_cells.links(device, &places)?;
            let new = fine_cells.value(device, &places, &links)?;
            fine.extend(device, fine_cells, new, &mut coarse, steps)?;
            fine_cells.settle(device, &places, &links)?;
            Some(links)
        }
    };

    // 3. The mean. Where there is none, the point counts as a fine record itself.
    let arguments = match &links {
        Some(links) => {
            GatherPoints { lookup: fine_cells.lookup(device, &places, links), fine: fine.input(), ..arguments }
        }
        None => GatherPoints { brute_force: 1, ..arguments },
    };
    let both = GatherPoints { count: places.len() as u32, ..arguments };
    device.threads("mean_light", places.len(), &both)?;
    let all = read_count(&miss_count)?;
    let at_once = device.at_once(if how.brute_force { how.rays.coarse[0] } else { how.rays.fine });
    for first in (0..all).step_by(at_once) {
        let count = at_once.min(all - first);
        let records = cuda.pool().room("surface points that see no record", count)?;
        let asked = cuda.pool().room("these as places that ask", count)?;
        let some = GatherPoints {
            records: records.output(),
            asked: asked.output(),
            first_miss: first as u32,
            count: count as u32,
            ..arguments
        };
        device.threads("take_misses", count, &some)?;
        if how.brute_force {
            let own = coarse::plain(device, coarse.bounce, records, how.rays.coarse)?;
            device.threads("answer_misses", count, &GatherPoints { coarse: own.input(), ..some })?;
            steps.tell(first + some.count as usize, all);
        } else {
            let own = fine::plain(device, Asking { records, places: asked }, &mut coarse)?;
            device.threads("answer_misses", count, &GatherPoints { own: own.input(), ..some })?;
        }
    }
    device.threads("add_means", rays.len(), &arguments)
}
