//! Formula (3) on a CUDA device: a warp for each item, then long tests where no light point counts.

use lightmesh_layout::constants::{ITEM_WARPS, MOST_LIGHTS};
use lightmesh_layout::stages::Interpolate;

use crate::RenderError;
use crate::backend::cuda::{
    BLOCK, Cuda, DeviceHits, DeviceRays, DeviceVisibility, Work, blocks_for, kernel_of, sampling, warps_for,
};
use crate::cuda::{Kernel, Runtime};
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::stages::light_points::cuda::{DevicePoints, window_bricks};
use crate::stages::long_tests::cuda::DeviceLit;
use crate::stages::short_tests::cuda::DeviceMasks;

/// What formula (3) needs.
pub(crate) struct Interpolation<'a, R: Runtime> {
    pub(crate) cuda: &'a Cuda<R>,
    pub(crate) job: &'a Job<'a>,
    pub(crate) scene: &'a PreparedScene<'a>,
    pub(crate) rays: &'a DeviceRays<R>,
    pub(crate) hits: &'a DeviceHits<R>,
    pub(crate) masks: &'a DeviceMasks<R>,
    pub(crate) points: &'a DevicePoints<R>,
    pub(crate) lit: &'a DeviceLit<R>,
    pub(crate) mesh: &'a LightMesh,
}

const INTERPOLATE: Kernel = Kernel { module: "interpolate", name: "interpolate" };
/// Items, and blocks of rays, of the first launches ever.
const FIRST_ITEMS: u64 = 4096;
const FIRST_BLOCKS: u64 = 256;

impl<R: Runtime> Interpolation<'_, R> {
    pub(crate) fn run(&self) -> Result<DeviceVisibility<R>, RenderError> {
        let Interpolation { cuda, job, scene, rays, hits, masks, points, lit, mesh } = *self;
        let lights = scene.scene.lights.len();
        let scene = cuda.scene(scene)?;
        let share = cuda.pool().zeros("shares of lights", rays.len() * lights)?;
        let used = cuda.pool().zeros("light points used", rays.len())?;
        let fallback_rays = cuda.pool().room("rays that fall back", rays.len())?;
        let fallback_count = cuda.pool().zeros("number of rays that fall back", 1)?;
        let record = Interpolate {
            scene: scene.record,
            rays: rays.record,
            hits: hits.hits.input(),
            mesh: cuda.mesh(mesh)?,
            members: masks.members.input(),
            items: masks.items.input(),
            masks: masks.masks.input(),
            points: points.record(),
            slots: points.slots.input(),
            lit: lit.lit.input(),
            share: share.output(),
            used: used.output(),
            fallback_rays: fallback_rays.output(),
            fallback_count: fallback_count.output(),
            sampling: sampling(job),
            tally: cuda.tally()?,
            first: 0,
            count: 0,
        };
        // 1. The weighted means.
        let cost = lights.max(1) as u64;
        let work = Work { units: masks.count as u64, cost, first: FIRST_ITEMS, progress: rays.len() as u64 };
        cuda.in_pieces(job, INTERPOLATE, work, |piece| {
            let count = piece.end - piece.start;
            let words = window_bricks(mesh.template.reach()) + MOST_LIGHTS * mesh.template.words() as u32;
            cuda.launch(
                INTERPOLATE,
                warps_for(&piece, ITEM_WARPS, words),
                &Interpolate { first: piece.start, count, ..record },
            )
        })?;
        // 2. Object points without light points take their own long tests.
        let names = ["fallback_bvh", "fallback_grid", "fallback_brute_force"];
        let kernel = kernel_of("interpolate", names, scene.structure);
        let blocks = (rays.len() as u64).div_ceil(u64::from(BLOCK));
        cuda.in_pieces(job, kernel, Work { units: blocks, cost, first: FIRST_BLOCKS, progress: 0 }, |piece| {
            let count = piece.end - piece.start;
            cuda.launch(kernel, blocks_for(&piece, BLOCK), &Interpolate { first: piece.start, count, ..record })
        })?;
        Ok(DeviceVisibility { share, used: Some(used), direct: None })
    }
}
