use glam::Vec3;
use lightmesh_layout::constants::{MIN_MIRRORED_COSINE, NORMAL_CODE_ONE, NORMAL_CODE_ZERO};
use lightmesh_render::internals::shading::{Relief, mirroring};

#[test]
fn code_128_is_0_and_255_is_1() {
    let decode = |code: u8| (255.0 * (f32::from(code) / 255.0) - NORMAL_CODE_ZERO) / NORMAL_CODE_ONE;
    assert_eq!([128, 255].map(decode), [0.0, 1.0]);
}

/// Unit vectors of all directions above a horizon.
fn above() -> impl Iterator<Item = Vec3> + Clone {
    (0..400).map(|index| {
        let (height, turn) = ((index as f32 + 0.5) / 400.0, 2.4 * index as f32);
        let radius = (1.0 - height * height).sqrt();
        Vec3::new(radius * turn.cos(), height, radius * turn.sin())
    })
}

#[test]
fn what_is_mirrored_leaves_the_surface() {
    for (normal, view) in above().flat_map(|normal| above().map(move |view| (normal, view))) {
        let turned = mirroring(normal, Vec3::Y, view);
        let direction = 2.0 * turned.dot(view) * turned - view;
        assert!(turned.is_normalized() && direction.y > 0.0, "{normal} {view}: {turned}");
        let plain = 2.0 * normal.dot(view) * normal - view;
        assert_eq!(turned == normal, plain.y >= MIN_MIRRORED_COSINE.min(0.5 * view.y));
        // A little more is turned a little more.
        if (plain.y - MIN_MIRRORED_COSINE).abs() < 1e-3 && normal.dot(view) > 0.1 {
            assert!(turned.dot(normal) > 0.999, "{normal} {view}: {turned}");
        }
    }
}

#[test]
fn only_low_light_is_softened() {
    let relief = Relief { smooth: Vec3::Y };
    let low = |sine: f32| Vec3::new((1.0 - sine * sine).sqrt(), sine, 0.0);
    assert_eq!(relief.softened(low(0.2), 0.7), 0.7);
    assert_eq!(relief.softened(low(0.05), 0.04), 0.04, "leaning away");
    assert!((relief.softened(low(0.05), 0.45) - 0.25).abs() < 1e-6, "half-way");
    assert_eq!([0.0, -0.3].map(|sine| relief.softened(low(sine), 0.5)), [0.0; 2]);
}
