use glam::Vec3;
use lightmesh_render::internals::cache::meets_between;
use lightmesh_scene::Bounds;

fn at(x: f32, y: f32, z: f32, half: f32) -> Bounds {
    let middle = Vec3::new(x, y, z);
    Bounds { min: middle - half, max: middle + half }
}

#[test]
fn only_what_is_between_is_met() {
    let (points, light) = (at(0.0, 0.0, 0.0, 1.0), at(10.0, 10.0, 0.0, 0.1));
    for (other, meets) in [
        (at(5.0, 5.0, 0.0, 0.2), true),
        (at(5.0, 5.0, 1.0, 0.6), true),
        (at(5.0, 5.0, 1.5, 0.2), false),
        (at(5.0, 2.0, 0.0, 0.2), false),
        (at(0.0, 0.0, 0.0, 0.1), true),
        (at(10.0, 10.0, 0.0, 0.01), true),
        (at(11.0, 11.0, 0.0, 0.5), false),
        (at(-2.0, -2.0, 0.0, 0.5), false),
    ] {
        assert_eq!(meets_between(&points, &light, &other), meets, "{other:?}");
        assert_eq!(meets_between(&light, &points, &other), meets, "{other:?}");
    }
}

#[test]
fn a_box_that_segments_go_through_is_always_met() {
    let mut seed = 1u32;
    let mut number = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    let mut met = 0;
    for _ in 0..20_000 {
        let mut place = |scale: f32| scale * Vec3::new(number() - 0.5, number() - 0.5, number() - 0.5);
        let [a, b, c] = [place(4.0), place(4.0), place(4.0)];
        let half = place(1.0).abs();
        let (from, to) = (Bounds { min: a - half, max: a + half }, Bounds { min: b - half, max: b + half });
        let other = Bounds { min: c - 0.3, max: c + 0.3 };
        let (start, end) = (a + place(2.0).clamp(-half, half), b + place(2.0).clamp(-half, half));
        let inside = (0..=64).map(|i| start.lerp(end, i as f32 / 64.0));
        let goes_through = inside.into_iter().any(|p| p.cmpge(other.min).all() && p.cmple(other.max).all());
        met += usize::from(goes_through);
        assert!(!goes_through || meets_between(&from, &to, &other), "{from:?} {to:?} {other:?}");
    }
    assert!(met > 300, "{met}");
}
