//! Every build takes little work and gives a shallow tree.

use glam::Vec3;
use lightmesh_render::accel::{Accelerator, Bvh, Hit, Ray, Triangle};
use lightmesh_render::internals::accel::{Child, LEVELS, Work, children, depth, extent, planes, tree};
use lightmesh_scene::Bounds;
use lightmesh_testkit::{FAMILIES, Family};
use obvhs::cwbvh::CwBvh;

/// The tree over a family, its levels, and the boxes looked at per triangle.
fn work(family: &Family, count: usize) -> (CwBvh, usize, f64) {
    let corners = family.triangles(count);
    let triangles: Vec<_> = corners.iter().zip(0..).map(|(&corners, index)| Triangle::new(corners, index)).collect();
    let mut work = Work::default();
    let tree = tree(&triangles, &mut work);
    let levels = depth(&tree.nodes);
    (tree, levels, work.boxes as f64 / count as f64)
}

/// Boxes of which each holds all smaller ones, or which are all alike, used to be joined one pair at a time.
#[test]
fn work_is_bounded_however_triangles_lie() {
    for family in FAMILIES {
        for count in [1, 2, 3, 7, 100, 2_000, 30_000] {
            let (tree, levels, looked_at) = work(&family, count);
            assert!(looked_at < 600.0, "{}: {looked_at} boxes per triangle of {count}", family.name);
            assert!((1..=LEVELS).contains(&levels), "{}: {levels} levels over {count}", family.name);
            let mut indices = tree.primitive_indices;
            indices.sort_unstable();
            assert!(indices.into_iter().eq(0..count as u32), "{}: each of {count} once", family.name);
        }
    }
}

/// Trees stay as good as they are without the bounds on work: nodes that a ray enters.
#[test]
fn trees_are_shallow_where_triangles_lie_apart() {
    for (name, most) in [("strip", 40.0), ("stairs", 60.0), ("pipe", 40.0), ("grid", 16.0), ("two clusters", 8.0)] {
        let family = FAMILIES.iter().find(|family| family.name == name).unwrap();
        let corners = family.triangles(30_000);
        let triangles: Vec<_> =
            corners.iter().zip(0..).map(|(&corners, index)| Triangle::new(corners, index)).collect();
        let cost = Bvh::new(&triangles).cost();
        assert!(cost.levels <= 10 && cost.nodes < most, "{name}: {cost:?}");
    }
}

#[test]
fn identical_triangles_are_held_once() {
    let triangles: Vec<_> = (0..20_000).map(|index| Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y], index)).collect();
    let bvh = Bvh::new(&triangles);
    assert_eq!(bvh.triangles().len(), 1);
    let ray = Ray { origin: Vec3::new(0.2, 0.3, 1.0), direction: Vec3::NEG_Z, t_max: 2.0 };
    let mut hit = [Hit::MISS];
    bvh.closest_hits(&[ray], &mut hit);
    assert_eq!((hit[0].t, hit[0].triangle), (1.0, 0));
}

#[test]
fn every_box_holds_its_triangles() {
    let corner = |index: u32| Vec3::new((index % 37) as f32, (index % 11) as f32 * 0.3, (index % 5) as f32) * 1.7;
    let triangles: Vec<_> =
        (0..999).map(|index| Triangle::new([0, 1, 2].map(|turn| corner(index + turn)), index)).collect();
    let bvh = Bvh::new(&triangles);
    let mut leaves = 0;
    for node in bvh.nodes() {
        for (slot, child) in children(node) {
            let Child::Leaf(range) = child else { continue };
            leaves += range.len();
            let content = Bounds::around(bvh.triangles()[range].iter().flat_map(Triangle::corners));
            for axis in 0..3 {
                let (start, step, (low, high)) = (node.p.as_dvec3()[axis], extent(node)[axis], planes(node, axis));
                assert!(start + step * f64::from(low[slot]) <= f64::from(content.min[axis]));
                assert!(start + step * f64::from(high[slot]) >= f64::from(content.max[axis]));
            }
        }
    }
    assert_eq!(leaves, triangles.len());
}
