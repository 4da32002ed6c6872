//! Unusable values, checked once a whole scene is read: cameras and lights without a valid position, coefficients without a finite
//! value. One warning for each kind gives their number.

use glam::{DVec3, Vec3};

use crate::{Material, draft::LARGEST_COORDINATE};

/// Whether a world position is usable.
pub(crate) fn is_place(world: DVec3) -> bool {
    world.abs().cmple(DVec3::splat(LARGEST_COORDINATE)).all()
}

/// Removes the cameras or lights at unusable positions.
pub(crate) fn keep_placed<T>(items: &mut Vec<(T, DVec3)>, kind: &str) -> Option<String> {
    let before = items.len();
    items.retain(|&(_, world)| is_place(world));
    let count = before - items.len();
    (count > 0).then(|| format!("{count} {kind} with infinite, undefined or far too large coordinates were ignored"))
}

/// Replaces infinite and NaN coefficients by 0.
pub(crate) fn keep_finite(materials: &mut [Material]) -> Option<String> {
    let mut count = 0;
    for Material { ka, kd, ks, ks_tinted, emission, emission_tinted, .. } in materials {
        let mut odd = false;
        for color in [ka, kd, ks, ks_tinted, emission, emission_tinted] {
            odd |= !color.is_finite();
            *color = Vec3::select(color.is_finite_mask(), *color, Vec3::ZERO);
        }
        count += usize::from(odd);
    }
    (count > 0).then(|| format!("{count} materials have infinite or undefined coefficients, which count as 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_place_is_left_out_and_counted() {
        let mut items =
            vec![(1, DVec3::ONE), (2, DVec3::new(0.0, f64::NAN, 0.0)), (3, DVec3::NEG_INFINITY), (4, 1e19 * DVec3::X)];
        let warning = keep_placed(&mut items, "lights");
        assert_eq!(items, [(1, DVec3::ONE)]);
        assert_eq!(
            warning.as_deref(),
            Some("3 lights with infinite, undefined or far too large coordinates were ignored")
        );
        assert_eq!(keep_placed(&mut items, "lights"), None);
    }

    #[test]
    fn coefficients_without_a_value_count_as_0() {
        let odd = Material { kd: Vec3::new(f32::INFINITY, 0.5, 0.25), ks: Vec3::NAN, ..Material::default() };
        let mut materials = [Material::default(), odd];
        let warning = keep_finite(&mut materials);
        assert_eq!((materials[1].kd, materials[1].ks), (Vec3::new(0.0, 0.5, 0.25), Vec3::ZERO));
        assert!(warning.is_some_and(|warning| warning.starts_with("1 materials have infinite")));
        assert_eq!((keep_finite(&mut materials), &materials[0]), (None, &Material::default()));
    }
}
