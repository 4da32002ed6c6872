//! Counts close to those of the thesis and of formula (6).

use lightmesh_render::{Frame, Lookup, Settings};
use lightmesh_scene::Scene;
use lightmesh_testkit::{render, runs_all};

use crate::light_mesh;

const SIZE: [u32; 2] = [96, 96];

fn built_in(name: &str) -> Scene {
    Scene::open(format!("builtin:{name}")).unwrap()
}

#[test]
fn half_balls_of_the_built_in_scenes_hold_62_points() {
    // Half of the ball's 4πR³/3 = 124.8 points. Surfaces and lattice planes are not aligned, which leaves some tolerance.
    for (name, step) in [("gazebo", 2.0), ("childpark", 1.0), ("garden", 0.1)] {
        let Frame { stats, .. } = render(&built_in(name), &light_mesh(SIZE, step, 3.1));
        let counts = &stats.counts;
        assert_eq!(counts.template, 232, "{name}");
        assert!((counts.half_ball_mean - 62.0).abs() < 8.0, "{name}: {}", counts.half_ball_mean);
        assert!(counts.used_mean > 0.1 * counts.half_ball_mean, "{name}: {}", counts.used_mean);
        assert!(counts.used_mean <= counts.half_ball_mean, "{name}: {}", counts.used_mean);
        assert!(10 * counts.hits > 9 * counts.pixels, "{name}: a built-in scene fills its image, {} hits", counts.hits);
        let asked = counts.short_tests + counts.short_tests_culled;
        assert_eq!(asked, (counts.half_ball_mean * counts.hits as f64).round() as u64, "{name}");
        assert_eq!(counts.long_tests, counts.light_points * stats.scene.lights as u64, "{name}");
        assert!(counts.light_points > 0 && counts.light_points <= counts.hits * counts.template, "{name}");
    }
}

#[test]
fn the_template_in_the_counts_is_that_of_the_radius() {
    let scene = built_in("gazebo");
    for (radius, template) in [(1.0, 8), (1.5, 56), (2.1, 88), (3.2, 280), (5.1, 888)] {
        let frame = render(&scene, &light_mesh([16, 16], 2.0, radius));
        assert_eq!(frame.stats.counts.template, template, "R = {radius}");
    }
}

#[test]
fn an_automatic_step_needs_fewer_light_points_than_pixels() {
    let names = ["gazebo", "childpark", "garden"];
    for name in &names[..if runs_all() { 3 } else { 2 }] {
        let settings = Settings::default().with_lookup(Lookup::HalfBall).with_size(SIZE);
        let frame = render(&built_in(name), &settings);
        let (counts, settings) = (&frame.stats.counts, &frame.stats.settings);
        assert!(settings.step_auto && settings.step.is_some_and(|step| step > 0.0));
        // The target is a quarter; the surfaces are only known by samples.
        assert!(counts.light_points < counts.pixels / 2, "{name}: {} light points", counts.light_points);
    }
}
