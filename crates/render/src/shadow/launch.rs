//! What the launches of kernels that test samples share.

use std::sync::Arc;

use bytemuck::Zeroable;
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::Out;
use lightmesh_layout::constants::WARP;
use lightmesh_layout::scene::SampleRows;
use lightmesh_layout::stages::{Shadows, Weighed};

use super::ShadowTarget;
use super::rows::Rows;
use crate::error::RenderError;
use crate::gpu::rays::{DeviceVisibility, DeviceWave};
use crate::gpu::{Cuda, PerStructure, Work, sampling, warps_for};
use crate::shading::irradiance::may_be_near;

/// The samples of an image, set by set.
pub(crate) struct SampleSets {
    rows: Arc<Rows>,
    /// Number of sets.
    pub(crate) count: u32,
}

impl SampleSets {
    pub(crate) fn new(rows: Arc<Rows>) -> SampleSets {
        let count = rows.disc.len().max(rows.rectangle.len()) as u32;
        SampleSets { rows, count }
    }

    /// Those of discs and of rectangles in a set.
    fn of(&self, set: u32) -> [SampleRows; 2] {
        let of = |rows: &[SampleRows]| rows.get(set as usize).copied().unwrap_or_else(SampleRows::zeroed);
        [of(&self.rows.disc), of(&self.rows.rectangle)]
    }

    /// The largest number of samples in a set.
    pub(crate) fn most(&self, set: u32) -> u64 {
        self.of(set).iter().map(|set| set.count.iter().map(|&count| u64::from(count)).sum()).max().unwrap_or(0)
    }

    /// The arguments of kernels for a set, and the lights of the wave.
    pub(crate) fn record<R: Runtime>(
        &self,
        cuda: &Cuda<R>,
        wave: &DeviceWave<R>,
        visibility: &DeviceVisibility<R>,
        set: u32,
    ) -> Result<Shadows, RenderError> {
        let sets = self.of(set);
        Ok(Shadows { share: visibility.planes(), sets, set, set_count: self.count, ..arguments(cuda, wave)? })
    }
}

/// The arguments of kernels for the lights of a wave, without samples.
pub(crate) fn arguments<R: Runtime>(cuda: &Cuda<R>, wave: &DeviceWave<R>) -> Result<Shadows, RenderError> {
    let lights = wave.group();
    Ok(Shadows {
        scene: wave.scene.record,
        rays: wave.rays.record,
        hits: wave.hits.hits.input(),
        sampling: sampling(wave.sampling()),
        tally: cuda.tally()?,
        first_light: lights.start as u32,
        end_light: lights.end as u32,
        ..Shadows::zeroed()
    })
}

/// Kernels by the largest number of words of samples.
pub(crate) type ByWords = [(u32, PerStructure); 3];

/// Warps of a launch that take one unit of work after another: several times as many as run at once.
const TAKERS: u64 = 8192;

/// The work of warps that test samples row by row.
pub(crate) struct WarpWork<'a, R: Runtime> {
    /// Number of units of work: warps, unless warps take them.
    pub(crate) units: u64,
    /// Where warps count what they take; `None`: each warp has a unit of its own.
    pub(crate) taken: Option<&'a Buffer<R, u32>>,
    /// Units of the very first launch.
    pub(crate) first: u64,
    /// Pieces of progress that they are.
    pub(crate) progress: u64,
    /// Words of shared memory of a warp, apart from a search and the rows of samples.
    pub(crate) words: u32,
}

/// Launches `kernels` for each set of samples. `complete` adds arguments.
pub(crate) fn test_samples<R: Runtime>(
    cuda: &Cuda<R>,
    wave: &DeviceWave<R>,
    target: &ShadowTarget,
    (kernels, work): (&ByWords, WarpWork<R>),
    complete: impl Fn(Shadows) -> Shadows,
) -> Result<DeviceVisibility<R>, RenderError> {
    let scene = wave.scene;
    let dark = DeviceVisibility::dark(cuda, wave.rays.len(), wave.group())?;
    let visibility = DeviceVisibility { weighed: true, ..dark };
    let sets = SampleSets::new(wave.rows(target));
    // What is seen of near lights by several sets.
    let lights = &scene.host.scene.lights;
    let sums = match sets.count > 1 && lights.iter().any(may_be_near) {
        true => Some(cuda.pool().room::<Weighed>("weighed samples", wave.rays.len() * visibility.lights.len())?),
        false => None,
    };
    let weighed = sums.as_ref().map_or(Out::NULL, |sums| {
        let before = visibility.lights.start as u64 * wave.rays.len() as u64 * size_of::<Weighed>() as u64;
        Out::to(sums.output().address().wrapping_sub(before))
    });
    let progress = |done: u32| work.progress * u64::from(done) / u64::from(sets.count);
    for set in 0..sets.count {
        let record = Shadows { weighed, ..complete(sets.record(cuda, wave, &visibility, set)?) };
        let most = |number: fn(&SampleRows) -> u32| record.sets.iter().map(number).max().unwrap_or(0);
        let (words, rows) = (most(|set| set.words), most(|set| set.rows));
        let (_, kernels) = kernels.iter().find(|(room, _)| *room >= words).unwrap_or(&kernels[2]);
        let kernel = kernels.of(scene);
        let progress = progress(set + 1) - progress(set);
        let pieces =
            Work { units: work.units, cost: visibility.lights.len().max(1) as u64, first: work.first, progress };
        cuda.in_pieces(wave.context, kernel, pieces, |piece| {
            let shared = work.words + scene.search_words() + WARP * rows;
            let count = piece.end - piece.start;
            let warps = match work.taken {
                Some(taken) => {
                    taken.clear()?;
                    count.min(TAKERS)
                }
                None => count,
            };
            let arguments = Shadows { first: piece.start, count, ..record };
            cuda.launch(kernel, warps_for(&(0..warps), 1, shared), &arguments)
        })?;
    }
    Ok(visibility)
}
