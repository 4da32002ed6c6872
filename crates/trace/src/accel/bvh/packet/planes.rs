//! The box tests of a packet against the children of a node.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::Vec3A;

use super::rays::{Interval, Packet, PacketSlabs};
use super::size::GROUPS;
use crate::accel::bvh::tree::Node;
use crate::accel::packet::LANES;

/// The planes of a node's children, by axis: those that the rays cross first, and those that they cross last.
pub(super) struct Planes {
    near: [[f32; 8]; 3],
    far: [[f32; 8]; 3],
}

/// A node's frame in units of the ray parameters of a group.
#[derive(Clone, Copy)]
pub(super) struct Frame<S: Simd> {
    scale: [f32x8<S>; 3],
    near: [f32x8<S>; 3],
    far: [f32x8<S>; 3],
}

impl<S: Simd> Frame<S> {
    #[inline(always)]
    fn new(node: &Node, slabs: &PacketSlabs<S>) -> Frame<S> {
        let extent = node.compute_extent();
        let [ox, oy, oz] = slabs.origin;
        let (ox, oy, oz) = (node.p.x - ox, node.p.y - oy, node.p.z - oz);
        let distance = (ox.abs() + 256.0 * extent.x).max(oy.abs() + 256.0 * extent.y).max(oz.abs() + 256.0 * extent.z);
        let [ix, iy, iz] = slabs.inverse;
        let [mx, my, mz] = slabs.margin;
        let (mx, my, mz) = (distance * mx, distance * my, distance * mz);
        let (sx, sy, sz) = (ox * ix, oy * iy, oz * iz);
        Frame {
            scale: [extent.x * ix, extent.y * iy, extent.z * iz],
            near: [sx - mx, sy - my, sz - mz],
            far: [sx + mx, sy + my, sz + mz],
        }
    }
}

impl Planes {
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, node: &Node, packet: &Packet<S>) -> Planes {
        let (near_x, far_x) = by_sign(packet.negative[0], &node.child_min_x, &node.child_max_x);
        let (near_y, far_y) = by_sign(packet.negative[1], &node.child_min_y, &node.child_max_y);
        let (near_z, far_z) = by_sign(packet.negative[2], &node.child_min_z, &node.child_max_z);
        Planes {
            near: [floats(simd, near_x), floats(simd, near_y), floats(simd, near_z)],
            far: [floats(simd, far_x), floats(simd, far_y), floats(simd, far_z)],
        }
    }

    /// The frames of the groups that have a ray in `lanes`.
    #[inline(always)]
    pub(super) fn frames<S: Simd>(&self, simd: S, node: &Node, packet: &Packet<S>, lanes: u64) -> [Frame<S>; GROUPS] {
        let none = [f32x8::splat(simd, 0.0); 3];
        let mut frames = [Frame { scale: none, near: none, far: none }; GROUPS];
        for (group, frame) in frames.iter_mut().enumerate() {
            if lanes >> (group * LANES) & 0xff != 0 {
                *frame = Frame::new(node, &packet.groups[group].slabs);
            }
        }
        frames
    }

    /// Bit k: some ray of the packet may meet the box of slot k between 0 and `limit`.
    #[inline(always)]
    pub(super) fn reachable<S: Simd>(&self, simd: S, node: &Node, interval: &Interval, limit: f32) -> (u32, [f32; 8]) {
        let extent = node.compute_extent();
        let p = Vec3A::from(node.p);
        let (near, far) = (p - interval.near_origin, p - interval.far_origin);
        let margin = (near.abs().max(far.abs()) + 256.0 * extent).max_element() * interval.margin;
        let (least_scale, most_scale) = (extent * interval.least, extent * interval.most);
        let (least_near, most_near) = (near * interval.least - margin, near * interval.most - margin);
        let (least_far, most_far) = (far * interval.least + margin, far * interval.most + margin);
        let mut enter = f32x8::splat(simd, 0.0);
        let mut leave = f32x8::splat(simd, limit);
        for axis in 0..3 {
            let planes = f32x8::from_slice(simd, &self.near[axis]);
            enter = enter
                .max((planes * least_scale[axis] + least_near[axis]).min(planes * most_scale[axis] + most_near[axis]));
            let planes = f32x8::from_slice(simd, &self.far[axis]);
            leave = leave
                .min((planes * least_scale[axis] + least_far[axis]).max(planes * most_scale[axis] + most_far[axis]));
        }
        (enter.simd_le(leave).to_bitmask() as u32, enter.into())
    }

    /// Bit k: ray k of a group meets the box of a slot between 0 and its limit.
    #[inline(always)]
    pub(super) fn meet<S: Simd>(&self, simd: S, frame: &Frame<S>, slot: usize, limit: f32x8<S>) -> u32 {
        let Planes { near, far } = self;
        let enter = (frame.scale[0] * near[0][slot] + frame.near[0])
            .max(frame.scale[1] * near[1][slot] + frame.near[1])
            .max((frame.scale[2] * near[2][slot] + frame.near[2]).max(f32x8::splat(simd, 0.0)));
        let leave = (frame.scale[0] * far[0][slot] + frame.far[0])
            .min(frame.scale[1] * far[1][slot] + frame.far[1])
            .min((frame.scale[2] * far[2][slot] + frame.far[2]).min(limit));
        enter.simd_le(leave).to_bitmask() as u32
    }
}

#[inline(always)]
fn by_sign<'a>(negative: bool, low: &'a [u8; 8], high: &'a [u8; 8]) -> (&'a [u8; 8], &'a [u8; 8]) {
    if negative { (high, low) } else { (low, high) }
}

#[inline(always)]
fn floats<S: Simd>(_: S, bytes: &[u8; 8]) -> [f32; 8] {
    let [a, b, c, d, e, f, g, h] = *bytes;
    [a as f32, b as f32, c as f32, d as f32, e as f32, f as f32, g as f32, h as f32]
}

/// Bit k: slot k has a child.
#[inline(always)]
pub(super) fn occupied(node: &Node) -> u32 {
    // Bit 5 is set for inner nodes and leaves alike. The product gathers the eight bits in the highest byte.
    let lowest = u64::from_le_bytes(node.child_meta) >> 5 & 0x0101_0101_0101_0101;
    (lowest.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
}
