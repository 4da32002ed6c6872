//! Where second rays go.

use lightmesh_render::internals::irradiance_cache::guided;

const SIDES: [u32; 2] = [12, 24];

/// What 12 × 12 first rays see: a bright window at the upper left, and a ball of this radiance in four of them on the other side.
fn seen(ball: f32) -> Vec<f32> {
    let value = |column: usize, row: usize| match (column, row) {
        (1..=3, 2..=4) => 1.0,
        (8..=9, 8..=9) => ball,
        _ => 0.1,
    };
    (0..144).map(|ray| value(ray % 12, ray / 12)).collect()
}

#[test]
fn the_areas_of_all_rays_are_the_square() {
    for ball in [0.1, 0.5, 40.0] {
        let rays = guided(SIDES, &seen(ball), 7);
        let area: f32 = rays.iter().map(|(_, area)| area).sum();
        assert!((area / rays.len() as f32 - 1.0).abs() < 1e-4, "{area}");
        assert!(rays.iter().all(|(place, _)| place.abs().max_element() <= 1.0));
        // Half of a window, 1/16 of the square, and what is next to it.
        let to_window = rays.iter().filter(|(place, _)| place.x < -0.3 && place.y < 0.0).count();
        assert!(ball > 1.0 || to_window > rays.len() / 3, "{to_window}");
    }
}

#[test]
fn rays_stay_where_nothing_changes() {
    let [before, after] = [0.15, 0.152].map(|ball| guided(SIDES, &seen(ball), 7));
    let stay = before.iter().filter(|(place, _)| after.iter().any(|(other, _)| other == place)).count();
    assert!(stay < before.len() && stay > before.len() * 2 / 3, "{stay} of {}", before.len());
}
