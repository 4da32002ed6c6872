use glam::Vec3;
use lightmesh_scene::internals::environment::{clear, luminance, sun_illuminance};
use lightmesh_scene::{SunPosition, Up};

#[test]
fn the_sun_gives_what_is_measured_on_clear_days() {
    // IES: 133.8 klx · exp(-0.21 m) on a clear day, which has about this turbidity.
    for elevation in [15.0f32, 30.0, 45.0, 60.0, 90.0] {
        let found = luminance(sun_illuminance(elevation.to_radians(), 2.0));
        let expected = 133_800.0 * (-0.21 / elevation.to_radians().sin()).exp();
        assert!((0.85..1.15).contains(&(found / expected)), "{elevation}: {found}, not {expected}");
    }
    let [noon, evening] = [60.0f32, 3.0].map(|elevation| sun_illuminance(elevation.to_radians(), 3.0));
    assert!(evening.x / evening.z > 4.0 * noon.x / noon.z, "{noon}, {evening}: evenings are red");
}

#[test]
fn the_sky_gives_what_is_measured_on_clear_days() {
    // IES: 0.8 + 15.5 √sin h klx on a horizontal surface.
    for elevation in [15.0f64, 30.0, 45.0, 60.0] {
        let sun = SunPosition { elevation, azimuth: 120.0 };
        let environment = clear(sun, 2.5, Vec3::splat(0.2), Up::Z).unwrap();
        let sun_of_sky = luminance(environment.sun().unwrap().irradiance());
        let scale = luminance(sun_illuminance(elevation.to_radians() as f32, 2.5)) / sun_of_sky;
        let found = scale * luminance(environment.irradiance(Vec3::Z));
        let expected = 800.0 + 15_500.0 * (elevation.to_radians().sin() as f32).sqrt();
        assert!((0.6..1.6).contains(&(found / expected)), "{elevation}: {found}, not {expected}");
    }
}
