//! The rays of a packet, side by side.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::{BVec3A, Vec3A};
use lightmesh_layout::constants::{BVH_MARGIN, MIN_COMPONENT};

use super::order::Order;
use super::size::GROUPS;
use crate::accel::packet::{LANES, PacketShear};
use crate::accel::ray_clamp::ClampedRay;

/// Rays of one kind.
pub(super) struct Packet<'a, S: Simd> {
    order: &'a Order,
    pub(super) indices: &'a [u16],
    pub(super) groups: [Group<S>; GROUPS],
    pub(super) interval: Interval,
    /// Whether each axis is walked downwards.
    pub(super) negative: [bool; 3],
    pub(super) octant: u32,
}

/// Eight rays of a packet.
#[derive(Clone, Copy)]
pub(super) struct Group<S: Simd> {
    pub(super) shear: PacketShear<S>,
    pub(super) slabs: PacketSlabs<S>,
    /// Negative if there is no ray.
    pub(super) t_max: f32x8<S>,
}

/// Eight rays prepared for the slab tests; the twin of [`Slabs`](super::Slabs).
#[derive(Clone, Copy)]
pub(super) struct PacketSlabs<S: Simd> {
    pub(super) origin: [f32x8<S>; 3],
    pub(super) inverse: [f32x8<S>; 3],
    pub(super) margin: [f32x8<S>; 3],
}

impl<'a, S: Simd> Packet<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, order: &'a Order, indices: &'a [u16]) -> Packet<'a, S> {
        let kind = usize::from(order.kind(indices[0]));
        let negative = [kind & 1 != 0, kind & 2 != 0, kind & 4 != 0];
        let octant = u32::from(!negative[0]) << 2 | u32::from(!negative[1]) << 1 | u32::from(!negative[2]);
        let mut groups = [Group::new(simd, order, &indices[..indices.len().min(LANES)], kind >> 3); GROUPS];
        for group in 1..GROUPS {
            if group * LANES < indices.len() {
                let end = indices.len().min(group * LANES + LANES);
                groups[group] = Group::new(simd, order, &indices[group * LANES..end], kind >> 3);
            } else {
                groups[group].t_max = f32x8::splat(simd, -1.0);
            }
        }
        let interval = Interval::new(&groups, negative);
        Packet { order, indices, groups, interval, negative, octant }
    }

    #[inline(always)]
    pub(super) fn ray(&self, lane: usize) -> &ClampedRay {
        &self.order.rays[usize::from(self.indices[lane])].0
    }

    /// Index in the chunk.
    #[inline(always)]
    pub(super) fn index(&self, lane: usize) -> usize {
        self.order.rays[usize::from(self.indices[lane])].1
    }
}

impl<S: Simd> Group<S> {
    #[inline(always)]
    fn new(simd: S, order: &Order, indices: &[u16], axis: usize) -> Group<S> {
        // 1. The rays side by side; empty lanes repeat the first.
        let (mut origin, mut direction) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        let mut t_max = [-1.0; LANES];
        for lane in 0..LANES {
            let filled = lane < indices.len();
            let (near, _) = &order.rays[usize::from(indices[if filled { lane } else { 0 }])];
            for axis in 0..3 {
                origin[axis][lane] = near.origin[axis];
                direction[axis][lane] = near.direction[axis];
            }
            t_max[lane] = if filled { near.t_max } else { -1.0 };
        }
        let [x, y, z] = &origin;
        let origin = [f32x8::from_slice(simd, x), f32x8::from_slice(simd, y), f32x8::from_slice(simd, z)];
        let [x, y, z] = &direction;
        let direction = [f32x8::from_slice(simd, x), f32x8::from_slice(simd, y), f32x8::from_slice(simd, z)];

        // 2. Prepared for both tests.
        Group {
            shear: PacketShear::new(&origin, &direction, axis),
            slabs: PacketSlabs::new(simd, origin, direction, axis),
            t_max: f32x8::from_slice(simd, &t_max),
        }
    }
}

impl<S: Simd> PacketSlabs<S> {
    #[inline(always)]
    fn new(simd: S, origin: [f32x8<S>; 3], direction: [f32x8<S>; 3], axis: usize) -> PacketSlabs<S> {
        let least = direction[axis].abs() * MIN_COMPONENT;
        let [x, y, z] = direction;
        let one = f32x8::splat(simd, 1.0);
        let inverse = [
            one / x.abs().max(least).copysign(x),
            one / y.abs().max(least).copysign(y),
            one / z.abs().max(least).copysign(z),
        ];
        let [x, y, z] = inverse;
        PacketSlabs { origin, inverse, margin: [x.abs() * BVH_MARGIN, y.abs() * BVH_MARGIN, z.abs() * BVH_MARGIN] }
    }
}

/// The bounds between which all rays of a packet lie.
pub(super) struct Interval {
    /// The bounds of the origins that give the smallest and the largest distance to a plane.
    pub(super) near_origin: Vec3A,
    pub(super) far_origin: Vec3A,
    /// Smallest and largest reciprocal directions.
    pub(super) least: Vec3A,
    pub(super) most: Vec3A,
    pub(super) margin: Vec3A,
}

impl Interval {
    #[inline(always)]
    fn new<S: Simd>(groups: &[Group<S>; GROUPS], negative: [bool; 3]) -> Interval {
        let first = &groups[0].slabs;
        let (mut low, mut high, mut least, mut most) = (first.origin, first.origin, first.inverse, first.inverse);
        for group in &groups[1..] {
            for axis in 0..3 {
                low[axis] = low[axis].min(group.slabs.origin[axis]);
                high[axis] = high[axis].max(group.slabs.origin[axis]);
                least[axis] = least[axis].min(group.slabs.inverse[axis]);
                most[axis] = most[axis].max(group.slabs.inverse[axis]);
            }
        }
        let (low, high, least, most) = (minimum(low), maximum(high), minimum(least), maximum(most));
        let negative = BVec3A::from_array(negative);
        Interval {
            near_origin: Vec3A::select(negative, low, high),
            far_origin: Vec3A::select(negative, high, low),
            least,
            most,
            margin: BVH_MARGIN * least.abs().max(most.abs()),
        }
    }
}

#[inline(always)]
fn minimum<S: Simd>([x, y, z]: [f32x8<S>; 3]) -> Vec3A {
    Vec3A::new(x.reduce_min(), y.reduce_min(), z.reduce_min())
}

#[inline(always)]
fn maximum<S: Simd>([x, y, z]: [f32x8<S>; 3]) -> Vec3A {
    Vec3A::new(x.reduce_max(), y.reduce_max(), z.reduce_max())
}
