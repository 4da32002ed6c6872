//! Surface points without a light point cast their own shadow rays.

use glam::{DVec3, Vec3};
use lightmesh_render::Mode;
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::{Picture, pile, render};

use crate::light_mesh;

const LIGHT: LightKind = LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 };

/// The scene's images by the method with hardly any light points, and by ray tracing.
fn with_few_light_points(scene: &Scene, radius: f32) {
    let settings = light_mesh([48, 48], 1.3, radius);
    let sparse = render(scene, &settings);
    let traced = render(scene, &settings.with_mode(Mode::RayTrace));
    let (sparse_picture, traced) = (Picture::new(&sparse), Picture::new(&traced));
    let empty: Vec<usize> = sparse_picture.hits().filter(|&pixel| sparse_picture.layers().used[pixel] == 0).collect();
    assert!(empty.len() > 100, "{} surface points without light points", empty.len());
    let share = &sparse.stats.counts.fallback_share;
    assert!(*share > 0.0 && *share <= 1.0, "{share}");
    let (mut lit, mut dark) = (0, 0);
    for pixel in empty {
        let value = sparse_picture.layers().visibility[0][pixel];
        assert_eq!(value, traced.layers().visibility[0][pixel], "at {}", traced.position(pixel));
        lit += usize::from(value == 1.0);
        dark += usize::from(value == 0.0);
    }
    assert!(lit > 0 && dark > 0, "{lit} lit, {dark} dark");
}

#[test]
fn surface_points_without_light_points_trace_their_own_rays() {
    for radius in [0.5, 0.7] {
        with_few_light_points(&pile(DVec3::ZERO, &[LIGHT]), radius);
    }
}
