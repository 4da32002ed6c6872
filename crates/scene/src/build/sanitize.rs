//! Unusable values, checked once a whole scene is read: cameras and lights without a valid position, coefficients without a finite
//! value, mirrors that add light. One warning for each kind gives their number.

use glam::{DVec3, Vec3};

use super::quote::list;
use crate::model::transforms::is_place;
use crate::{Dielectric, Facets, Material, Mesh, NormalMap, Opacity, OpacityMode};

/// The square of the area that two such edges span is nearly the largest number of single precision.
const LONGEST_EDGE: f32 = 4e9;

/// Removes the cameras or lights at unusable positions.
pub fn drop_invalid_positions<T>(items: &mut Vec<(T, DVec3)>, kind: &str) -> Option<String> {
    let before = items.len();
    items.retain(|&(_, world)| is_place(world));
    let count = before - items.len();
    (count > 0).then(|| format!("{count} {kind} with infinite, undefined or far too large coordinates were ignored"))
}

/// Replaces infinite, NaN and negative coefficients by 0.
pub fn keep_finite(materials: &mut [Material]) -> Option<String> {
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
pub fn unseen(materials: &[Material], of_triangles: &[u32]) -> Option<String> {
    let nowhere = (0..).zip(materials).filter(|(_, material)| material.is_nowhere());
    let used = nowhere.filter(|(index, _)| of_triangles.contains(index));
    let names: Vec<String> = used.map(|(_, material)| format!("`{}`", material.name)).collect();
    let of = if names.len() == 1 { "material is" } else { "materials are" };
    let listed = list(names.iter().map(String::as_str));
    (!names.is_empty()).then(|| format!("{} {of} not seen, for lack of opacity: {listed}", names.len()))
}

/// Says how many triangles have edges whose products exceed the largest number: they have no normals, and cast no shadows.
pub fn too_long(mesh: &Mesh) -> Option<String> {
    let is_far = |position: &Vec3| position.abs().max_element() > 0.25 * LONGEST_EDGE;
    if !mesh.positions.iter().any(is_far) {
        return None;
    }
    let is_too_long = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
        [a.distance(b), b.distance(c), c.distance(a)].into_iter().any(|edge| edge > LONGEST_EDGE)
    };
    let count = mesh.triangles.iter().filter(is_too_long).count();
    let have = if count == 1 { "triangle has" } else { "triangles have" };
    (count > 0).then(|| {
        format!("{count} {have} edges longer than {LONGEST_EDGE:e} units, which are dark and cast no shadows; use a larger unit of length")
    })
}

/// Lowers specular coefficients above 1: between such mirrors light would grow beyond every number.
pub fn clamp_reflectance(materials: &mut [Material]) -> Option<String> {
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
