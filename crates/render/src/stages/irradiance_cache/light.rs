//! Light that arrives at a surface point. Twin: `light.cuh`.

use glam::Vec3;
use lightmesh_layout::constants::MIN_TILT_COSINE;

use super::directions::{BINS, bin};

/// Light by the direction that a surface faces, near the one that it faces.
#[derive(Clone, Copy, Default)]
pub(super) struct Light {
    /// Mean radiance, by the cosine: irradiance by π.
    pub(super) mean: Vec3,
    /// How it changes as the normal turns: along x, y and z.
    pub(super) tilt: [Vec3; 3],
    /// The most radiance that comes from any direction, channel by channel: no mean is more.
    pub(super) most: Vec3,
}

impl Light {
    pub(super) const NONE: Light = Light { mean: Vec3::ZERO, tilt: [Vec3::ZERO; 3], most: Vec3::ZERO };

    /// The mean radiance on a surface whose normal differs by this.
    #[inline(always)]
    pub(super) fn at(&self, turned: Vec3) -> Vec3 {
        (self.mean + turned.x * self.tilt[0] + turned.y * self.tilt[1] + turned.z * self.tilt[2]).min(self.most)
    }

    /// Adds a share of other light, on a surface whose normal differs by this.
    #[inline(always)]
    pub(super) fn add(&mut self, share: f32, other: &Light, turned: Vec3) {
        self.mean += share * other.at(turned);
        for (sum, tilt) in self.tilt.iter_mut().zip(other.tilt) {
            *sum += share * tilt;
        }
        self.most = self.most.max(other.most);
    }

    /// Adds radiance that arrives along a direction, times its weight.
    #[inline(always)]
    pub(super) fn take(&mut self, normal: Vec3, direction: Vec3, weighted: Vec3) {
        let cosine = direction.dot(normal);
        let across = (direction - cosine * normal) / cosine.max(MIN_TILT_COSINE);
        self.mean += weighted;
        self.tilt[0] += across.x * weighted;
        self.tilt[1] += across.y * weighted;
        self.tilt[2] += across.z * weighted;
    }
}

/// Radiance by direction: sums and numbers of rays.
#[derive(Clone, Copy)]
pub(super) struct Bins {
    pub(super) sums: [Vec3; BINS],
    pub(super) counts: [f32; BINS],
}

impl Bins {
    pub(super) const EMPTY: Bins = Bins { sums: [Vec3::ZERO; BINS], counts: [0.0; BINS] };

    #[inline(always)]
    pub(super) fn take(&mut self, direction: Vec3, radiance: Vec3, count: f32) {
        let bin = bin(direction);
        self.sums[bin] += count * radiance;
        self.counts[bin] += count;
    }

    /// Adds other rays; those so far count this much.
    pub(super) fn join(&mut self, share: f32, other: &Bins) {
        for (sum, other) in self.sums.iter_mut().zip(&other.sums) {
            *sum = share * *sum + *other;
        }
        for (count, other) in self.counts.iter_mut().zip(&other.counts) {
            *count = share * *count + *other;
        }
    }

    /// The sum in a bin, and the number of its rays.
    #[inline(always)]
    pub(super) fn of(&self, bin: usize) -> (Vec3, f32) {
        (self.sums[bin], self.counts[bin])
    }
}
