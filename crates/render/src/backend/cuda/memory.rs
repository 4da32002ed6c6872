//! The plan of memory: what each buffer will take, before the first is allocated.

use lightmesh_layout::geometry::{Hit, ListedRay, Vec3};
use lightmesh_layout::mesh::Item;

use super::Cuda;
use crate::RenderError;
use crate::cuda::Runtime;
use crate::modes::bands::film_bytes;
use crate::modes::{Plan, Technique};
use crate::prepared::PreparedScene;
use crate::stages::light_points::cuda::window_bricks;

/// Object points that an item is expected to have: a cell's points fill warps of 32, and cells are cut at the borders of tiles.
const POINTS_PER_ITEM: u64 = 8;
/// Share of free memory that is left to others.
const RESERVE: u64 = 16;

impl<R: Runtime> Cuda<R> {
    /// Rows that fit into what is free, or under the limit, beside the scene.
    ///
    /// The estimate of light points and items is an expectation. Where a picture has more, allocation fails and the band is
    /// begun again with half of its rows.
    pub(super) fn rows_that_fit(&self, scene: &PreparedScene, plan: &Plan) -> Result<u32, RenderError> {
        let free = self.pool.runtime().free_memory().map(|free| free - free / RESERVE);
        let free = match plan.memory_limit {
            Some(limit) => {
                let rest = limit.saturating_sub(self.pool.taken());
                Some(free.map_or(rest, |free| free.min(rest)))
            }
            None => free,
        };
        let Some(free) = free else { return Ok(plan.size[1]) };
        let row = u64::from(plan.size[0]) * bytes_per_ray(plan, scene.scene.lights.len() as u64);
        match free / row {
            0 => Err(RenderError::DeviceMemory {
                device: self.pool.runtime().name(),
                buffer: "one row of the picture",
                needed: row,
                free: Some(free),
            }),
            rows => Ok(rows.min(u64::from(plan.size[1])) as u32),
        }
    }
}

/// Bytes per ray when most is held.
fn bytes_per_ray(plan: &Plan, lights: u64) -> u64 {
    let listed = if plan.bounces > 0 { 2 * size_of::<ListedRay>() as u64 } else { 0 };
    let hit = size_of::<Hit>() as u64;
    let share = 4 * lights;
    let technique = match &plan.technique {
        Technique::LightMesh(mesh) => {
            // Members and items of tiles; items with their masks, and the used points and slots of the bricks around them.
            let grouping = 4 + size_of::<Item>() as u64;
            let bricks = (8 + 4) * window_bricks(mesh.template.reach()) as usize;
            let masks = (size_of::<Item>() + 32 * 4 * mesh.template.words() + bricks) as u64 / POINTS_PER_ITEM;
            // Half a light point a pixel: its entry and share, and its part of a brick that is a quarter full.
            let points = (8 + 2 * lights + 2 * (8 + 8 + 4 + 8 * lights) / 16) / 2;
            // Light points used, and the list of rays that fall back.
            grouping + masks + points + 4 + 4
        }
        Technique::RayTrace => 0,
        Technique::Area => size_of::<Vec3>() as u64,
    };
    film_bytes(plan) + listed + hit + share + technique
}
