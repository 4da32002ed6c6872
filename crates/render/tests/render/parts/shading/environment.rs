use glam::Vec3;
use lightmesh_render::internals::shading::radiance;
use lightmesh_scene::{Environment, Sun, Up};

fn panorama(size: [u32; 2]) -> Environment {
    let texels = (0..size[0] * size[1]).map(|index| [index as f32, (index % size[0]) as f32, 1.0]).collect();
    Environment::new("", size, texels, Up::Z).turned(40.0)
}

#[test]
fn middles_of_texels_are_seen_as_they_are() {
    let map = panorama([16, 8]);
    for (column, row) in (0..8).flat_map(|row| (0..16).map(move |column| (column, row))) {
        let found = radiance(&map, map.direction(column, row), 0.0, 1.0);
        let expected = Vec3::new((row * 16 + column) as f32, column as f32, 1.0);
        assert!((found - expected).length() < 1e-3, "{column}, {row}: {found}");
    }
    let poles = [Vec3::Z, Vec3::NEG_Z].map(|pole| radiance(&map, pole, 0.0, 1.0));
    assert!(poles.iter().all(|seen| seen.is_finite() && seen.z == 1.0));
    assert!(
        (radiance(&map, map.direction(15, 3), 0.0, 1.0) - radiance(&map, -map.direction(15, 3), 0.0, 1.0)).length()
            > 1.0
    );
}

#[test]
fn wide_cones_see_means() {
    let map = panorama([16, 8]);
    let last = Vec3::from_array(map.levels().last().unwrap().texels[0]);
    for spread in [7.0, 1e9, f32::INFINITY] {
        assert_eq!(radiance(&map, Vec3::X, spread, 1.0), last, "{spread}");
    }
    let two = map.levels()[0].texels[3 * 8 + 2];
    let between = map.direction(4, 6) + map.direction(5, 6) + map.direction(4, 7) + map.direction(5, 7);
    let texel = std::f32::consts::PI / 8.0;
    let found = radiance(&map, between.normalize(), 2.0 * texel, 1.0);
    assert!((found - Vec3::from_array(two)).length() < 0.2, "{found}, not {two:?}");
}

#[test]
fn the_sun_is_a_disc_with_an_edge() {
    let black = Environment::new("", [1; 2], vec![[0.0; 3]], Up::Y);
    let sun = Sun::new(Vec3::X, 10.0, Vec3::ONE);
    let map = black.with_sun(Some(sun));
    let at = |degrees: f32, spread: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        radiance(&map, Vec3::new(cos, sin, 0.0), spread, 1.0).x / sun.radiance.x
    };
    assert_eq!([at(0.0, 0.0), at(4.9, 0.0), at(5.1, 0.0), at(180.0, 0.0)], [1.0, 1.0, 0.0, 0.0]);
    assert!((at(5.0, 0.01) - 0.5).abs() < 0.05 && at(4.6, 0.01) > 0.99 && at(5.4, 0.01) == 0.0);
    // Wide cones see as much light.
    let all = |spread: f32| (0..1800).map(|step| (step as f32 + 0.5) * at(0.05 * step as f32, spread)).sum::<f32>();
    assert!((all(1.0) / all(0.0) - 1.0).abs() < 0.1, "{} of {}", all(1.0), all(0.0));
}
