//! Unusable values, checked once a whole scene is read: cameras and lights without a valid position, coefficients without a finite
//! value, mirrors that add light. One warning for each kind gives their number.

use glam::{DVec3, Vec3};

use crate::{Dielectric, Facets, Material, NormalMap, Opacity, OpacityMode, draft::LARGEST_COORDINATE, quote::list};

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

/// Replaces infinite, NaN and negative coefficients by 0.
pub(crate) fn keep_finite(materials: &mut [Material]) -> Option<String> {
    let mut count = 0;
    for material in materials {
        let Material {
            ka,
            kd,
            ks,
            ks_tinted,
            facets,
            emission,
            emission_tinted,
            normal_texture,
            opacity,
            dielectric,
            ..
        } = material;
        let mut odd = false;
        for color in [ka, kd, ks, ks_tinted, emission, emission_tinted] {
            let usable = color.is_finite_mask() & color.cmpge(Vec3::ZERO);
            odd |= !usable.all();
            *color = Vec3::select(usable, *color, Vec3::ZERO);
        }
        if let Some(NormalMap { scale, .. }) = normal_texture {
            odd |= !scale.is_finite();
            *scale = if scale.is_finite() { *scale } else { 0.0 };
        }
        let mut keep = |number: &mut f32, most: f32| {
            odd |= !(0.0..=most).contains(number);
            *number = if number.is_finite() { number.clamp(0.0, most) } else { 0.0 };
        };
        if let Some(Facets { roughness, metallic, grazing }) = facets {
            [roughness, metallic, grazing].into_iter().for_each(|share| keep(share, 1.0));
        }
        if let Some(Opacity { factor, mode, .. }) = opacity {
            match mode {
                OpacityMode::Mask { cutoff } => {
                    keep(factor, f32::MAX);
                    keep(cutoff, f32::MAX);
                }
                // More than all would be light from nowhere.
                OpacityMode::Blend { filter } => {
                    keep(factor, 1.0);
                    filter.as_mut().iter_mut().for_each(|channel| keep(channel, 1.0));
                }
            }
        }
        if let Some(Dielectric { ior, absorption, .. }) = dielectric {
            let usable = absorption.is_finite_mask() & absorption.cmpge(Vec3::ZERO);
            let bends = ior.is_finite() && *ior > 0.0;
            odd |= !(usable.all() && bends);
            *absorption = Vec3::select(usable, *absorption, Vec3::ZERO);
            *ior = if bends { *ior } else { 1.0 };
        }
        count += usize::from(odd);
    }
    (count > 0)
        .then(|| format!("{count} materials have infinite, undefined or negative coefficients, which count as 0"))
}

/// Names the materials of triangles that are nowhere opaque and filter nothing.
pub(crate) fn unseen(materials: &[Material], of_triangles: &[u32]) -> Option<String> {
    let nowhere = (0..).zip(materials).filter(|(_, material)| material.is_nowhere());
    let used = nowhere.filter(|(index, _)| of_triangles.contains(index));
    let names: Vec<String> = used.map(|(_, material)| format!("`{}`", material.name)).collect();
    let of = if names.len() == 1 { "material is" } else { "materials are" };
    let listed = list(names.iter().map(String::as_str));
    (!names.is_empty()).then(|| format!("{} {of} not seen, for lack of opacity: {listed}", names.len()))
}

/// Lowers specular coefficients above 1: between such mirrors light would grow beyond every number.
pub(crate) fn keep_passive(materials: &mut [Material]) -> Option<String> {
    let mut adding = Vec::new();
    for material in materials {
        let (Some(excess), name) = (material.excess(), &material.name) else { continue };
        adding.push(format!("`{name}` (ks = {} {} {})", excess.x, excess.y, excess.z));
        material.ks = material.ks.min(Vec3::ONE);
        material.ks_tinted = material.ks_tinted.min(Vec3::ONE - material.ks);
    }
    let count = adding.len();
    (count > 0).then(|| {
        format!(
            "{count} materials reflect more than they receive, so their ks is lowered to 1: {}",
            list(adding.iter().map(String::as_str))
        )
    })
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
    fn mirrors_that_add_light_are_lowered_and_named() {
        let tinted = Material::default().with_ks([0.5; 3]).with_ks_tinted([0.75, 0.25, 0.5]).named("gold");
        let usual = Material::matt([1.0; 3]).with_ks([1.0; 3]);
        let mut materials = [Material::default().with_ks([1.5, 1.0, 0.5]).named("box"), tinted, usual.clone()];
        let warning = keep_passive(&mut materials).unwrap();
        assert_eq!(
            warning,
            "2 materials reflect more than they receive, so their ks is lowered to 1: `box` (ks = 1.5 1 0.5), `gold` (ks = 1.25 0.75 1)"
        );
        assert_eq!((materials[0].ks, materials[1].ks), (Vec3::new(1.0, 1.0, 0.5), Vec3::splat(0.5)));
        assert_eq!((materials[1].ks_tinted, &materials[2]), (Vec3::new(0.5, 0.25, 0.5), &usual));
        assert_eq!(keep_passive(&mut materials), None);
    }

    #[test]
    fn opacities_out_of_range_are_brought_back() {
        let of = |factor: f32| Material { opacity: Some(Opacity::blend(factor)), ..Material::default() };
        let mut materials = [0.5, 2.0, -1.0, f32::INFINITY, f32::NAN].map(of);
        assert!(keep_finite(&mut materials).is_some_and(|warning| warning.starts_with("4 materials have infinite")));
        assert_eq!(materials.map(|material| material.opacity.unwrap().factor), [0.5, 1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn what_is_nowhere_opaque_is_named() {
        let of = |opacity: Opacity, name: &str| Material { opacity: Some(opacity), ..Material::default() }.named(name);
        let foil = of(Opacity::blend(0.0).with_filter([1.0, 0.0, 0.0]), "foil");
        let mut materials = vec![foil, of(Opacity::blend(0.5), "pane"), Material::default()];
        assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None);
        materials.push(of(Opacity::blend(0.0), "glass").with_dielectric(Dielectric::new(1.5)));
        assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None);
        materials.push(of(Opacity::blend(0.0), "air"));
        assert_eq!(unseen(&materials, &[0, 1, 2, 3]), None, "nothing is made of it");
        assert_eq!(
            unseen(&materials, &[4, 4, 0]).as_deref(),
            Some("1 material is not seen, for lack of opacity: `air`")
        );
    }

    #[test]
    fn coefficients_without_a_value_count_as_0() {
        let odd = Material { kd: Vec3::new(f32::INFINITY, 0.5, -0.25), ks: Vec3::NAN, ..Material::default() };
        let mut materials = [Material::default(), odd];
        let warning = keep_finite(&mut materials);
        assert_eq!((materials[1].kd, materials[1].ks), (Vec3::new(0.0, 0.5, 0.0), Vec3::ZERO));
        assert!(warning.is_some_and(|warning| warning.starts_with("1 materials have infinite")));
        assert_eq!((keep_finite(&mut materials), &materials[0]), (None, &Material::default()));
    }
}
