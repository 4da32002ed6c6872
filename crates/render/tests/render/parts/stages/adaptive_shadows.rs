use std::collections::BTreeSet;

use lightmesh_layout::constants::{FIRST_TARGETS, NEIGHBORHOOD};
use lightmesh_render::internals::stages::{RIM, place_of, places};

#[test]
fn every_neighborhood_has_all_places() {
    for (x, y) in [(0, 0), (3, 1), (7, 12), (-3, 2), (-11, -65_536)] {
        let side = NEIGHBORHOOD as i32;
        let pixels = (0..side).flat_map(|row| (0..side).map(move |column| (x + column, y + row)));
        let found: BTreeSet<u32> = pixels.map(|(x, y)| place_of([x, y])).collect();
        assert!(found.into_iter().eq(0..FIRST_TARGETS), "{x}, {y}");
    }
}

#[test]
fn sixteen_places_are_at_the_rim() {
    let [discs, rectangles] = places();
    let at_rim = |lengths: Vec<f32>| {
        assert!(lengths.iter().all(|length| *length < RIM + 1e-6), "{lengths:?}");
        lengths.iter().filter(|length| **length > RIM - 1e-6).count()
    };
    assert_eq!(at_rim(discs.iter().map(|[x, y]| x.hypot(*y)).collect()), 16);
    assert_eq!(at_rim(rectangles.iter().map(|[x, y]| x.abs().max(y.abs())).collect()), 16);
    assert_eq!(discs[FIRST_TARGETS as usize / 2], [0.0; 2]);
}
