//! The samples of pixels on a CUDA device.

use std::sync::Arc;

use bytemuck::Zeroable;
use lightmesh_kernels::{Kernel, Runtime};
use lightmesh_layout::stages::PixelSamples;

use super::SampleRange;
use crate::counters::Tally;
use crate::data::wave::Wave;
use crate::error::RenderError;
use crate::footprint::Cone;
use crate::gpu::film::DeviceFilm;
use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceWave};
use crate::gpu::samples::{DeviceSampled, DeviceSamples};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, PerModule, PerStructure, Work, blocks_for, per_module, per_structure};

const CAST: PerStructure = per_structure!("pixel_samples", "pixel_samples");
const NEAREST: PerModule = per_module!("pixel_samples", "nearest_samples");
const IDS: PerModule = per_module!("pixel_samples", "count_ids");
const MERGE: PerModule = per_module!("pixel_samples", "merge_samples");
/// Logarithm of the number of samples of a pixel that neighbouring threads cast.
const MAX_TOGETHER: u32 = 3;
/// Number of blocks in the first launch.
const FIRST: u64 = 256;

/// Samples, and the rays and hits of the centres of pixels.
type Sampled<R> = (DeviceSamples<R>, DeviceRays<R>, DeviceHits<R>);

/// What the samples of pixels see; and the wave's rays and hits, those of the centres, without the hits of what is not shared.
pub(crate) fn pixel_samples<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    film: &mut DeviceFilm<R>,
    range: &SampleRange,
) -> Result<Sampled<R>, RenderError> {
    let SampleRange { all, numbers } = range;
    let Wave { context, scene, .. } = *wave;
    let mut rays = DeviceRays::new(wave.rays.record, None, wave.rays.spacing);
    let centers = cuda.pool().room("hits of centres", rays.len())?;
    cuda.copy(&wave.hits.hits, &centers, rays.len())?;
    if scene.host.has_cones() {
        rays.record.cone = bytemuck::cast(Cone::of_sample(rays.spacing, all.samples, all.breadth));
    }
    let (pixels, count) = (rays.len(), numbers.len());
    let planes = cuda.pool().room("hits of samples", pixels * count)?;
    let state = cuda.pool().room("states of pixels", pixels)?;
    let owners = cuda.pool().room("owners of samples", if all.apart { 0 } else { pixels * count })?;
    let mut record = PixelSamples {
        scene: scene.record,
        rays: rays.record,
        hits: planes.output(),
        centers: centers.output(),
        state: state.output(),
        owners: owners.output(),
        tally: cuda.tally()?,
        seed: all.seed,
        spacing: rays.spacing,
        samples: [numbers.start, count as u32],
        all_samples: all.samples,
        together: 1 << (count as u32).trailing_zeros().min(MAX_TOGETHER),
        lanes: (count as u32).next_power_of_two(),
        weight: 1.0 / all.samples as f32,
        contrast: all.contrast,
        apart: u32::from(all.apart),
        mirrors: u32::from(all.mirrors),
        keeps: u32::from(all.keeps),
        quantiles: all.quantiles,
        ..PixelSamples::zeroed()
    };
    film.expose_to_samples(&mut record);

    // 1. What each sample sees.
    let kernel = CAST.of(scene);
    let blocks = rays.blocks(BLOCK_SIDE);
    let work = Work { units: blocks * count as u64, cost: 1, first: FIRST, progress: (pixels * count) as u64 };
    cuda.in_pieces(context, kernel, work, |piece| {
        cuda.launch(kernel, blocks_for(&piece, BLOCK), &PixelSamples { first_block: piece.start, ..record })
    })?;
    Tally::add(&context.tally.rays, (pixels * count) as u64);

    // What is it called? Coverage and layers.
    let launch = |kernel: Kernel| {
        let work = Work { units: blocks, cost: count as u64, first: FIRST, progress: 0 };
        cuda.in_pieces(context, kernel, work, |piece| {
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &PixelSamples { first_block: piece.start, ..record })
        })
    };
    if film.has_mattes() {
        launch(IDS.of(scene))?;
    }
    if film.keeps_samples() {
        launch(NEAREST.of(scene))?;
    }

    // 2. Which pixels are shared, and which samples of the others lie on one surface?
    if all.apart {
        state.clear()?;
    } else {
        let work = Work { units: blocks * u64::from(record.lanes), cost: 1, first: FIRST, progress: 0 };
        let merge = MERGE.of(scene);
        cuda.in_pieces(context, merge, work, |piece| {
            cuda.launch(merge, blocks_for(&piece, BLOCK), &PixelSamples { first_block: piece.start, ..record })
        })?;
    }
    let hits = Arc::new(planes);
    if !all.apart {
        let sampled = DeviceSampled {
            hits: Arc::clone(&hits),
            first: rays.record.first_pixel,
            pixels: pixels as u64,
            count: count as u32,
        };
        rays.sampled = Some(sampled);
    }
    Ok((DeviceSamples { hits, _state: state, _owners: owners, record }, rays, DeviceHits { hits: centers }))
}
