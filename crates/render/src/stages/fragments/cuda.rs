//! Fragments on a CUDA device.

use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::geometry::{ListedRay, Rays};
use lightmesh_layout::stages::PixelSamples;

use crate::antialiasing::Antialiasing;
use crate::error::RenderError;
use crate::gpu::film::DeviceFilm;
use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceWave};
use crate::gpu::samples::{DeviceSampled, DeviceSamples};
use crate::gpu::{BLOCK, BLOCK_SIDE, Cuda, Work, blocks_for};

const CONTRAST: Kernel = Kernel { module: "fragments", name: "find_contrast" };
const COUNT: Kernel = Kernel { module: "fragments", name: "count_fragments" };
const EMIT: Kernel = Kernel { module: "fragments", name: "emit_fragments" };
/// Number of blocks in the first launch.
const FIRST: u64 = 256;

/// Rays with what they see.
type Fragments<R> = (DeviceRays<R>, DeviceHits<R>);

/// How many each block has of each list.
type Counts<R> = [Buffer<R, u32>; 3];

/// A launch of a kernel for each of a wave's blocks, which counts as so much progress.
fn launch<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    (kernel, progress): (Kernel, usize),
    record: &PixelSamples,
) -> Result<(), RenderError> {
    let blocks = wave.rays.blocks(BLOCK_SIDE);
    let work = Work { units: blocks, cost: u64::from(record.samples[1]), first: FIRST, progress: progress as u64 };
    cuda.in_pieces(wave.context, kernel, work, |piece| {
        cuda.launch(kernel, blocks_for(&piece, BLOCK), &PixelSamples { first_block: piece.start, ..*record })
    })
}

/// Room for the counts of a wave's blocks, and the arguments of kernels with it.
fn counting<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    samples: &DeviceSamples<R>,
    film: &DeviceFilm<R>,
) -> Result<(Counts<R>, PixelSamples), RenderError> {
    let (pool, blocks) = (cuda.pool(), wave.rays.blocks(BLOCK_SIDE) as usize);
    let counts = [
        pool.room("counts of shared fragments", blocks + 1)?,
        pool.room("counts of single samples", blocks + 1)?,
        pool.room("counts of mirror samples", blocks + 1)?,
    ];
    let inner = film.kept_places().map(|place| place as u32);
    let record = PixelSamples { counts: counts.each_ref().map(Buffer::output), inner, ..samples.record };
    Ok((counts, record))
}

/// How many there will be of each list, but for pixels that will be split.
pub(crate) fn fragment_counts<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    samples: &DeviceSamples<R>,
    film: &DeviceFilm<R>,
) -> Result<[usize; 3], RenderError> {
    let (counts, record) = counting(cuda, wave, samples, film)?;
    launch(cuda, wave, (COUNT, 0), &record)?;
    cuda.scan_totals(counts.each_ref())
}

/// The shared fragments, the single samples and the mirror samples of the pixels that count, with what they see.
pub(crate) fn fragments<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    samples: &mut DeviceSamples<R>,
    film: &mut DeviceFilm<R>,
    all: &Antialiasing,
) -> Result<[Fragments<R>; 3], RenderError> {
    let (pool, rays) = (cuda.pool(), wave.rays);
    let (counts, mut record) = counting(cuda, wave, samples, film)?;

    // 1. Which shared pixels are split?
    if !all.apart {
        launch(cuda, wave, (CONTRAST, 0), &record)?;
    }
    // 2. How many fragments does each block have, and where do they begin?
    launch(cuda, wave, (COUNT, rays.len()), &record)?;
    let totals = cuda.scan_totals(counts.each_ref())?;
    // 3. The fragments.
    let lists = [
        pool.room::<ListedRay>("shared fragments", totals[0])?,
        pool.room::<ListedRay>("single samples", totals[1])?,
        pool.room::<ListedRay>("mirror samples", totals[2])?,
    ];
    let room = |total: usize| pool.room("hits of fragments", total);
    let hits = [room(totals[0])?, room(totals[1])?, room(totals[2])?];
    record.fragments = lists.each_ref().map(Buffer::output);
    record.fragment_hits = hits.each_ref().map(Buffer::output);
    launch(cuda, wave, (EMIT, 0), &record)?;
    let sampled = || DeviceSampled {
        hits: samples.hits.clone(),
        first: rays.record.first_pixel,
        pixels: rays.len() as u64,
        count: record.samples[1],
    };
    let fragments = |list: Buffer<R, ListedRay>, hits| {
        let several = DeviceRays {
            record: Rays { list: list.input(), first_pixel: 0, count: list.len() as u32, ..rays.record },
            list: Some(list),
            cones: None,
            spacing: rays.spacing,
            several: true,
            are_fragments: true,
            sampled: (!all.apart).then(sampled),
        };
        (several, DeviceHits { hits })
    };
    let ([shared, single, mirror], [shared_hits, single_hits, mirror_hits]) = (lists, hits);
    Ok([fragments(shared, shared_hits), fragments(single, single_hits), fragments(mirror, mirror_hits)])
}
