use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use lightmesh_render::internals::light_mesh::weight;
use lightmesh_render::internals::simd::{LANES, dispatch};
use lightmesh_scene::Weight;

fn weight_at(kind: Weight, q2: f32) -> f32 {
    let level = fearless_simd::Level::new();
    let lanes: [f32; LANES] = dispatch!(level, simd => weight(simd, kind, f32x8::splat(simd, q2)).into());
    lanes[0]
}

#[test]
fn weights_are_one_in_the_middle_and_end_at_the_rim() {
    for kind in [Weight::Constant, Weight::Quadratic, Weight::Smooth] {
        assert_eq!(weight_at(kind, 0.0), 1.0);
    }
    assert_eq!(weight_at(Weight::Constant, 0.99), 1.0);
    assert_eq!(weight_at(Weight::Quadratic, 0.25), 0.75);
    assert_eq!(weight_at(Weight::Smooth, 0.25), 0.5625);
    assert_eq!(weight_at(Weight::Smooth, 1.0 + 1e-6), 0.0);
}
