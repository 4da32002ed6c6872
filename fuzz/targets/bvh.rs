//! The BVH over shapes that are hard to sort into a tree. Each record of an input adds a shape of some family, anywhere and of any
//! size, or triangles of any numbers. Whatever they are, the tree is shallow, holds each distinct triangle once and is hit like a
//! list; work out of proportion exceeds the fuzzer's limit of time.
#![no_main]

use std::collections::HashMap;

use glam::Vec3;
use libfuzzer_sys::fuzz_target;
use lightmesh::render::accel::{Accelerator, BruteForce, Bvh, Hit, Ray, Region, Triangle};
use lightmesh::scene::Bounds;
use lightmesh_testkit::FAMILIES;

/// Most triangles in a tree: a build whose work grows with their square would take a minute.
const MOST: usize = 1 << 15;
/// Triangles of a record that is meant to be large, and of others: large trees are slow.
const MANY: usize = 1 << 14;
const SOME: [usize; 8] = [1, 2, 4, 8, 32, 128, 512, 1024];
/// Most levels: the stack of the kernels.
const LEVELS: usize = 64;
/// Bytes of a record: kind, number, size, and place on three axes.
const RECORD: usize = 6;
/// Rays that are compared: few are walked alone, many in packets.
const RAYS: usize = 48;

fuzz_target!(|bytes: &[u8]| {
    let corners = shapes(bytes);
    let triangles: Vec<_> = corners.iter().zip(0..).map(|(&corners, index)| Triangle::new(corners, index)).collect();
    let tree = Bvh::new(&triangles);
    let expected = distinct(&triangles);
    assert!(tree.cost().levels <= LEVELS && (tree.cost().levels > 0) != expected.is_empty());
    assert_eq!(held(&tree), expected);
    let (list, rays) = (BruteForce::new(&triangles), rays(&triangles));
    for rays in [&rays[..], &rays[..rays.len().min(3)]] {
        compare(&tree, &list, rays);
    }
});

/// The triangles of all records.
fn shapes(bytes: &[u8]) -> Vec<[Vec3; 3]> {
    let (mut corners, mut rest) = (Vec::new(), bytes);
    while let Some((&[kind, number, size, x, y, z], behind)) = rest.split_first_chunk::<RECORD>() {
        rest = behind;
        let space = MOST - corners.len();
        let Some(family) = FAMILIES.get(usize::from(kind) % (FAMILIES.len() + 1)) else {
            rest = any_numbers(rest, usize::from(number).min(space), &mut corners);
            continue;
        };
        let count = if number == u8::MAX { MANY } else { SOME[usize::from(number / 32)] + usize::from(number % 32) };
        let count = count.min(space);
        let size = (f32::from(size as i8) / 4.0).exp2();
        let place = Vec3::from([x, y, z].map(|shift| f32::from(shift as i8))) * size;
        corners.extend(family.triangles(count).into_iter().map(|corners| corners.map(|corner| size * corner + place)));
    }
    corners
}

/// Adds triangles with the numbers that follow; returns what is behind them.
fn any_numbers<'a>(mut rest: &'a [u8], count: usize, corners: &mut Vec<[Vec3; 3]>) -> &'a [u8] {
    for _ in 0..count {
        let Some((numbers, behind)) = rest.split_first_chunk::<36>() else { break };
        let number = |at: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| numbers[4 * at + byte]));
        corners.push([0, 3, 6].map(|at| Vec3::new(number(at), number(at + 1), number(at + 2))));
        rest = behind;
    }
    rest
}

/// The smallest index of each distinct usable triangle, ascending.
fn distinct(triangles: &[Triangle]) -> Vec<u32> {
    let mut first = HashMap::new();
    for triangle in triangles.iter().filter(|triangle| triangle.is_usable()) {
        let bits = triangle.corners().map(|corner| corner.to_array().map(f32::to_bits));
        first.entry(bits).or_insert(triangle.index());
    }
    let mut indices: Vec<_> = first.into_values().collect();
    indices.sort_unstable();
    indices
}

/// The triangles in all leaves, ascending.
fn held(tree: &Bvh) -> Vec<u32> {
    let everywhere = Vec3::splat(2.0 * Triangle::MAX_COORDINATE);
    let mut indices = Vec::new();
    tree.search(&Region::within(Bounds { min: -everywhere, max: everywhere }), &mut |piece| {
        indices.extend_from_slice(piece);
        true
    });
    indices.sort_unstable();
    indices
}

/// Rays to points on some of the triangles, to shared corners and edges as well, from points near and far.
fn rays(triangles: &[Triangle]) -> Vec<Ray> {
    let usable: Vec<_> = triangles.iter().filter(|triangle| triangle.is_usable()).collect();
    let step = usable.len().div_ceil(RAYS).max(1);
    let ray = |(index, triangle): (usize, &&Triangle)| {
        let [a, b, c] = triangle.corners();
        let target = [a, 0.5 * (a + b), (a + b + c) / 3.0][index % 3];
        let size = (b - a).abs().max_element() + (c - a).abs().max_element();
        let turn = index as f32;
        let way =
            Vec3::new((1.3 * turn).sin(), (0.7 * turn).cos(), (2.1 * turn).sin()) * size * [0.5, 100.0][index % 2];
        let t_max = [f32::INFINITY, 1.0, 2.0][index / 2 % 3];
        Ray { origin: target + way, direction: -way, t_max }
    };
    usable.into_iter().step_by(step).collect::<Vec<_>>().iter().enumerate().map(ray).collect()
}

/// Tree and list give the same bits.
fn compare(tree: &Bvh, list: &BruteForce, rays: &[Ray]) {
    let mut hits = [vec![Hit::MISS; rays.len()], vec![Hit::MISS; rays.len()]];
    tree.closest_hits(rays, &mut hits[0]);
    list.closest_hits(rays, &mut hits[1]);
    let bits = |hit: &Hit| ([hit.t, hit.u, hit.v].map(f32::to_bits), hit.triangle);
    assert!(hits[0].iter().map(bits).eq(hits[1].iter().map(bits)), "{hits:?}");
    let mut occluded = [vec![false; rays.len()], vec![false; rays.len()]];
    tree.occluded(rays, &mut occluded[0]);
    list.occluded(rays, &mut occluded[1]);
    assert_eq!(occluded[0], occluded[1]);
}
