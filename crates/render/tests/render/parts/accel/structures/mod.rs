//! Property tests: all structures give the same bits, on rays and scenes chosen to be hard.

use glam::Vec3;
use lightmesh_render::accel::{Accelerator, Bvh, Grid, GridOptions, Levels, Triangle};
use lightmesh_render::internals::accel::AlphaMask;

mod agreement;
mod closed;
mod instances;
mod rays;
mod regions;
mod scenes;

/// Random numbers that are the same on every machine (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In 0..count.
    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// In [0, 1).
    fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In [-1, 1)³.
    fn signed(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

fn grid(triangles: &[Triangle], dims: Option<[u32; 3]>, levels: Levels) -> Grid {
    Grid::new(triangles, &GridOptions { dims, levels, ..GridOptions::default() }).unwrap()
}

/// Grids of several shapes.
fn grids(triangles: &[Triangle]) -> [Grid; 3] {
    [
        grid(triangles, None, Levels::One),
        grid(triangles, Some([7, 5, 9]), Levels::One),
        grid(triangles, Some([3, 2, 4]), Levels::Two),
    ]
}

type Named = (&'static str, Box<dyn Accelerator>);

/// Every structure but the reference, in several shapes, with a name for messages.
fn structures(triangles: &[Triangle]) -> Vec<Named> {
    structures_over(triangles, &AlphaMask::default())
}

/// The same over triangles some of which are cut out.
fn structures_over(triangles: &[Triangle], alpha_mask: &AlphaMask) -> Vec<Named> {
    let bvh = Bvh::new(triangles).with_alpha_mask(alpha_mask);
    let slow = bvh.clone().at_level(fearless_simd::Level::baseline());
    let mut all: Vec<Named> = vec![("bvh", Box::new(bvh)), ("bvh at the lowest SIMD level", Box::new(slow))];
    let grids = grids(triangles).map(|grid| grid.with_alpha_mask(alpha_mask));
    all.extend(grids.map(|grid| ("grid", Box::new(grid) as Box<dyn Accelerator>)));
    all
}
