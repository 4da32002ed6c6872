//! The walk of many coherent rays at once: one ray per lane, [`GROUPS`](size::GROUPS) vectors of lanes; nodes and triangles are uniform.
//!
//! # Theory
//!
//! Rays whose directions have the same signs enter a box through the same three planes. So one walk serves them all:
//!
//! * A node's planes are decoded once. An interval test (Boulos, Wald, Shirley: *Geometric and Arithmetic Culling Methods for
//!   Entire Ray Packets*, 2006) discards, eight children at a time, those that no ray of the packet can reach; it treats all
//!   origins and all reciprocal directions as intervals.
//! * The remaining children are tested ray by ray, eight rays at a time. Rays that miss a child are masked out below it; if only
//!   few are left, they continue [alone](super::walk).
//!
//! # Practice
//!
//! [`order::Order`] groups rays that may share a packet: same signs, and same dominant axis, so that the watertight test permutes
//! the axes in the same way. Neighbours in a batch should be neighbours in space.
//!
//! Both box tests have the margin that [`walk`](super::walk) derives, with S the largest in the packet for the interval test; the
//! rest is decided by [`PacketShear`], so that every result has the same bits as that of a single ray.

mod order;
mod planes;
mod rays;
mod size;

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::tree::Bvh;
use super::walk::{Stack, Walked, enter, walk};
use crate::accel::packet::{AnyPacket, ClosestPacket, LANES, PacketVisitor};
use crate::accel::visit::Visitor;
use crate::accel::{Hit, Ray};
use order::Order;
use planes::{Planes, occupied};
use rays::Packet;
use size::{GROUPS, RAYS};

/// Rays that are sorted together.
const CHUNK: usize = 512;
/// Up to this many rays are faster alone.
pub(super) const FEW: usize = 3;

/// A node to enter later: the rays that meet it, and a bound on where the first of them meets it.
#[derive(Clone, Copy, Default)]
struct Entry {
    lanes: u64,
    node: u32,
    enter: f32,
}

struct Stacks {
    single: Stack,
    packet: Vec<Entry>,
}

impl Stacks {
    fn new(depth: usize) -> Stacks {
        Stacks { single: Stack::new(depth), packet: vec![Entry::default(); 7 * depth + 1] }
    }
}

#[simd]
pub(super) fn closest_hits<S: Simd>(simd: S, bvh: &Bvh, rays: &[Ray], hits: &mut [Hit]) {
    let (mut order, mut stacks) = (Order::default(), Stacks::new(bvh.depth));
    hits.fill(Hit::MISS);
    for (rays, hits) in rays.chunks(CHUNK).zip(hits.chunks_mut(CHUNK)) {
        order.sort(&bvh.ray_clamp, rays);
        let mut start = 0;
        while start < order.rays.len() {
            let packet = Packet::new(simd, &order, order.packet(start));
            start += packet.indices.len();
            let group = &packet.groups[0];
            let mut closest = [ClosestPacket::new(simd, &bvh.alpha_mask, group.shear, group.t_max); GROUPS];
            for (closest, group) in closest.iter_mut().zip(&packet.groups) {
                *closest = ClosestPacket::new(simd, &bvh.alpha_mask, group.shear, group.t_max);
            }
            walk_packet(simd, bvh, &packet, &mut stacks, &mut closest);
            let mut found = [Hit::MISS; RAYS];
            for group in 0..GROUPS {
                found[group * LANES..group * LANES + LANES].copy_from_slice(&closest[group].hits());
            }
            for lane in 0..packet.indices.len() {
                hits[packet.index(lane)] = packet.ray(lane).finish(found[lane]);
            }
        }
    }
}

#[simd]
pub(super) fn occluded<S: Simd>(simd: S, bvh: &Bvh, segments: &[Ray], occluded: &mut [bool]) {
    let (mut order, mut stacks) = (Order::default(), Stacks::new(bvh.depth));
    occluded.fill(false);
    for (segments, occluded) in segments.chunks(CHUNK).zip(occluded.chunks_mut(CHUNK)) {
        order.sort(&bvh.ray_clamp, segments);
        let mut start = 0;
        while start < order.rays.len() {
            let packet = Packet::new(simd, &order, order.packet(start));
            start += packet.indices.len();
            let group = &packet.groups[0];
            let mut any = [AnyPacket::new(&bvh.alpha_mask, group.shear, group.t_max); GROUPS];
            for (any, group) in any.iter_mut().zip(&packet.groups) {
                *any = AnyPacket::new(&bvh.alpha_mask, group.shear, group.t_max);
            }
            walk_packet(simd, bvh, &packet, &mut stacks, &mut any);
            for lane in 0..packet.indices.len() {
                occluded[packet.index(lane)] = any[lane / LANES].hit >> (lane % LANES) & 1 == 1;
            }
        }
    }
}

/// Visits the triangles of all leaves whose boxes some ray meets between 0 and its limit, near octants first.
#[inline(always)]
fn walk_packet<S: Simd, V: PacketVisitor<S>>(
    simd: S,
    bvh: &Bvh,
    packet: &Packet<S>,
    stacks: &mut Stacks,
    visitors: &mut [V; GROUPS],
) where
    V::Single: Visitor,
{
    if bvh.nodes.is_empty() {
        return;
    }
    let octant = packet.octant;
    let stack = &mut stacks.packet[..];
    stack[0] = Entry { lanes: u64::MAX >> (64 - packet.indices.len()), node: 0, enter: 0.0 };
    let mut height = 1;
    while height > 0 {
        // 1. Take the nearest node, unless all its rays are done.
        height -= 1;
        let Entry { mut lanes, node: index, enter } = stack[height];
        let mut limit = visitors[0].limit();
        for (group, visitor) in visitors.iter().enumerate() {
            lanes &= !(u64::from(visitor.done()) << (group * LANES));
            limit = limit.max(visitor.limit());
        }
        let limit = limit.reduce_max();
        if lanes == 0 || enter > limit {
            continue;
        }
        if lanes.count_ones() as usize <= FEW {
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let near = packet.ray(lane);
                visitors[lane / LANES].alone(
                    simd,
                    lane % LANES,
                    near,
                    #[inline(always)]
                    |single| {
                        let ray = Walked::new(near.origin, near.direction, 0.0);
                        walk(simd, bvh, index, &ray, stacks.single.entries(), single);
                    },
                );
            }
            continue;
        }

        // 2. Which children may some ray reach?
        let node = &bvh.nodes[index as usize];
        let planes = Planes::new(simd, node, packet);
        let (reachable, enters) = planes.reachable(simd, node, &packet.interval, limit);
        let reachable = reachable & occupied(node);
        let frames = planes.frames(simd, node, packet, lanes);
        let inner = u32::from(node.imask);

        // 3. Test the triangles of those that are leaves, nearest first.
        let mut slots = in_order(reachable & !inner, octant);
        while slots != 0 {
            let nearest = 31 - slots.leading_zeros();
            slots &= !(1 << nearest);
            let slot = (nearest ^ octant) as usize & 7;
            let meta = u32::from(node.child_meta[slot]);
            let first = (node.primitive_base_idx + (meta & 0b1_1111)) as usize;
            let triangles = &bvh.triangles[first..first + (meta >> 5).count_ones() as usize];
            for group in 0..GROUPS {
                let own = (lanes >> (group * LANES)) as u32 & 0xff;
                if own == 0 {
                    continue;
                }
                let met = own & planes.meet(simd, &frames[group], slot, visitors[group].limit());
                if met != 0 {
                    for triangle in triangles {
                        match triangle.instance() {
                            None => visitors[group].triangle(simd, triangle, met),
                            Some(number) => each_alone(simd, bvh, number, packet, group, met, &mut visitors[group]),
                        }
                    }
                }
            }
        }

        // 4. Keep those that are nodes, farthest first.
        let mut slots = in_order(reachable & inner, octant);
        while slots != 0 {
            let slot = (slots.trailing_zeros() ^ octant) as usize & 7;
            slots &= slots - 1;
            let mut met = 0;
            for group in 0..GROUPS {
                let own = (lanes >> (group * LANES)) as u32 & 0xff;
                if own != 0 {
                    let own = own & planes.meet(simd, &frames[group], slot, visitors[group].limit());
                    met |= u64::from(own) << (group * LANES);
                }
            }
            if met != 0 {
                let before = inner & ((1 << slot) - 1);
                stack[height] =
                    Entry { lanes: met, node: node.child_base_idx + before.count_ones(), enter: enters[slot] };
                height += 1;
            }
        }
    }
}

/// The rays `met` of a group visit an instance, each alone.
#[inline(never)]
fn each_alone<S: Simd, V: PacketVisitor<S>>(
    simd: S,
    bvh: &Bvh,
    instance: usize,
    packet: &Packet<S>,
    group: usize,
    mut met: u32,
    visitor: &mut V,
) where
    V::Single: Visitor,
{
    met &= !visitor.done();
    while met != 0 {
        let lane = met.trailing_zeros() as usize;
        met &= met - 1;
        let near = packet.ray(group * LANES + lane);
        visitor.alone(
            simd,
            lane,
            near,
            #[inline(always)]
            |single| {
                enter(simd, bvh, instance, &Walked::new(near.origin, near.direction, 0.0), single);
            },
        );
    }
}

/// Moves bit k to bit k xor `octant`: traversal order, nearest highest.
#[inline(always)]
fn in_order(mut slots: u32, octant: u32) -> u32 {
    if octant & 1 != 0 {
        slots = (slots & 0x55) << 1 | (slots & 0xaa) >> 1;
    }
    if octant & 2 != 0 {
        slots = (slots & 0x33) << 2 | (slots & 0xcc) >> 2;
    }
    if octant & 4 != 0 {
        slots = (slots & 0x0f) << 4 | (slots & 0xf0) >> 4;
    }
    slots
}
