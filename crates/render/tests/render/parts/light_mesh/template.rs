use std::collections::BTreeSet;

use glam::IVec3;
use lightmesh_render::light_mesh::Template;

#[test]
fn sizes_are_those_of_the_method() {
    let sizes = [
        (1.0, 8),
        (1.5, 56),
        (2.0, 64),
        (2.1, 88),
        (2.5, 160),
        (3.0, 184),
        (3.1, 232),
        (3.2, 280),
        (3.5, 312),
        (4.0, 408),
        (4.1, 432),
        (5.0, 720),
        (5.1, 888),
        (6.1, 1352),
    ];
    for (radius, size) in sizes {
        let template = Template::new(radius).unwrap();
        assert_eq!(template.len(), size, "R = {radius}");
        assert_eq!(template.words(), size.div_ceil(32), "R = {radius}");
    }
}

#[test]
fn the_cube_s_symmetries_leave_it_alone() {
    let template = Template::new(3.1).unwrap();
    let set: BTreeSet<[i32; 3]> = template.offsets().iter().map(IVec3::to_array).collect();
    for &[x, y, z] in &set {
        // Mirror about the cell's centre (1/2) along x, and two exchanges of axes: together they generate all 48.
        assert!(set.contains(&[1 - x, y, z]) && set.contains(&[y, x, z]) && set.contains(&[y, z, x]));
    }
}

#[test]
fn bits_ascend_in_z_y_x() {
    let template = Template::new(2.1).unwrap();
    assert!(template.offsets().is_sorted_by_key(|offset| (offset.z, offset.y, offset.x)));
}

#[test]
fn rows_are_the_points_between_two_bounds() {
    for radius in [0.5, 1.5, 3.1, 4.0] {
        let template = Template::new(radius).unwrap();
        let reach = template.reach();
        let side = 1 - reach..=reach;
        for (y, z) in side.clone().flat_map(|y| side.clone().map(move |z| (y, z))) {
            for (low, high) in [(1 - reach, reach), (0, 0), (-1, 2), (2, 1), (-99, 99), (reach + 1, reach + 2)] {
                let expected: Vec<usize> = (0..template.len())
                    .filter(|&bit| {
                        let offset = template.offsets()[bit];
                        offset.y == y && offset.z == z && (low..=high).contains(&offset.x)
                    })
                    .collect();
                let row: Vec<usize> = template.row(y, z, low, high).collect();
                assert_eq!(row, expected, "R = {radius}, y = {y}, z = {z}, {low}..={high}");
            }
        }
    }
}

#[test]
fn the_reach_is_that_of_the_farthest_offset() {
    for radius in [1.0, 1.5, 2.1, 3.0, 3.1, 5.1] {
        let template = Template::new(radius).unwrap();
        let farthest = template.offsets().iter().map(|offset| offset.max_element()).max();
        assert_eq!(farthest, Some(template.reach()), "R = {radius}");
    }
}

#[test]
fn radii_without_sense_are_refused() {
    for radius in [0.0, -1.0, 0.49, 16.1, f32::NAN, f32::INFINITY] {
        assert!(Template::new(radius).is_err(), "R = {radius}");
    }
}
