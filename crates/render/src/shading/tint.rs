//! Textures and vertex colours: the coefficients of formula (1) at a surface point.
//!
//! ```text
//! t = texel(A · uv) · colour      k_a t      k_d t      k_s + k_s' t
//! ```
//!
//! Texture coordinates and colours are interpolated barycentrically. Texels are decoded from sRGB and the four nearest are
//! interpolated bilinearly. Limitation: minified textures are not filtered, and flicker.

use glam::{Vec2, Vec3};
use lightmesh_image::Transfer;
use lightmesh_scene::{Geometry, Material, Mesh, Texture, TextureUse, Wrap};

use crate::accel::Hit;

/// The coefficients of formula (1) at a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coefficients {
    pub(crate) ka: Vec3,
    pub(crate) kd: Vec3,
    pub(crate) ks: Vec3,
    pub(crate) emission: Vec3,
}

impl Coefficients {
    /// Those of `material` at `hit`.
    #[inline(always)]
    pub(crate) fn at(geometry: &Geometry, material: &Material, hit: &Hit) -> Coefficients {
        match is_tinted(geometry, material) {
            true => Coefficients::tinted(material, tint(geometry, material, hit)),
            false => Coefficients::untinted(material),
        }
    }

    /// The mean of those at some hits; `None` without any.
    pub(crate) fn mean<'h>(
        geometry: &Geometry,
        material: &Material,
        hits: impl Iterator<Item = &'h Hit>,
    ) -> Option<Coefficients> {
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for hit in hits {
            sum += tint(geometry, material, hit);
            count += 1.0;
        }
        (count > 0.0).then(|| Coefficients::tinted(material, sum / count))
    }

    /// Those of a material that is the same everywhere.
    #[inline(always)]
    pub(crate) fn untinted(material: &Material) -> Coefficients {
        Coefficients {
            ka: material.ka,
            kd: material.kd,
            ks: material.ks + material.ks_tinted,
            emission: material.emission + material.emission_tinted,
        }
    }

    fn tinted(material: &Material, tint: Vec3) -> Coefficients {
        Coefficients {
            ka: material.ka * tint,
            kd: material.kd * tint,
            ks: material.ks + material.ks_tinted * tint,
            emission: material.emission + material.emission_tinted * tint,
        }
    }
}

/// Whether surface points of `material` may differ in colour.
#[inline(always)]
pub(crate) fn is_tinted(geometry: &Geometry, material: &Material) -> bool {
    let has_texture = || material.texture.is_some() && texture_of(geometry, material).is_some();
    !material.catcher && (!geometry.mesh.colors.is_empty() || has_texture())
}

/// The texture of `material`, if it has one that can be looked up.
pub(crate) fn texture_of<'s>(geometry: &'s Geometry, material: &Material) -> Option<(TextureUse, &'s Texture)> {
    let uses = material.texture.filter(|_| !geometry.mesh.uvs.is_empty())?;
    let texture = geometry.textures.get(uses.texture as usize)?;
    let count = u64::from(texture.size[0]) * u64::from(texture.size[1]);
    (count > 0 && texture.texels.len() as u64 == count).then_some((uses, texture))
}

/// The product of texture and vertex colour at `hit`.
#[inline(never)]
fn tint(geometry: &Geometry, material: &Material, hit: &Hit) -> Vec3 {
    let texel = texture_of(geometry, material).map_or(Vec3::ONE, |(uses, texture)| {
        let place = uses.transform.transform_point2(uv_at(&geometry.mesh, hit));
        sampled(texture, uses.wrap, place)
    });
    if geometry.mesh.colors.is_empty() { texel } else { texel * color_at(&geometry.mesh, hit) }
}

fn uv_at(mesh: &Mesh, hit: &Hit) -> Vec2 {
    let [a, b, c] = mesh.triangles[hit.triangle as usize].map(|vertex| mesh.uvs[vertex as usize]);
    (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c
}

fn color_at(mesh: &Mesh, hit: &Hit) -> Vec3 {
    let [a, b, c] = mesh.triangles[hit.triangle as usize].map(|vertex| mesh.colors[vertex as usize]);
    (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c
}

/// The image's colour at `place`: (0, 0) is its upper left corner, (1, 1) its lower right one.
fn sampled(texture: &Texture, wrap: [Wrap; 2], place: Vec2) -> Vec3 {
    let (columns, x) = neighbours(place.x, texture.size[0], wrap[0]);
    let (rows, y) = neighbours(place.y, texture.size[1], wrap[1]);
    let texel =
        |column: u32, row: u32| linear(texture.texels[row as usize * texture.size[0] as usize + column as usize]);
    let [upper, lower] = rows.map(|row| between(texel(columns[0], row), texel(columns[1], row), x));
    between(upper, lower, y)
}

/// From `a` to `b`; exactly `a` where both are the same.
fn between(a: Vec3, b: Vec3, share: f32) -> Vec3 {
    a + share * (b - a)
}

fn linear(texel: [u8; 4]) -> Vec3 {
    let [r, g, b, _] = texel;
    Vec3::new(Transfer::Srgb.decode(r), Transfer::Srgb.decode(g), Transfer::Srgb.decode(b))
}

/// The two texels of a row or column of `size` whose centres are on either side of `place`, and the fraction of the way to the
/// second.
fn neighbours(place: f32, size: u32, wrap: Wrap) -> ([u32; 2], f32) {
    // 1. Into the image.
    let inside = match wrap {
        Wrap::Repeat => place - place.floor(),
        Wrap::Mirror => {
            let twice = place - 2.0 * (0.5 * place).floor();
            if twice > 1.0 { 2.0 - twice } else { twice }
        }
        Wrap::Clamp => place,
    };
    // Also if the position is infinite or NaN.
    let inside = if inside > 0.0 { if inside < 1.0 { inside } else { 1.0 } } else { 0.0 };
    // 2. In texels, counted from the centre of the first.
    let middle = inside * size as f32 - 0.5;
    let first = middle.floor();
    // 3. Beyond the border the image continues with its opposite side, or with itself. From -1 to the size.
    let last = size as i32 - 1;
    let (first_texel, second_texel) = (first as i32, first as i32 + 1);
    let texel = |index: i32| match wrap {
        Wrap::Repeat if index < 0 => last,
        Wrap::Repeat if index > last => 0,
        _ => index.clamp(0, last),
    };
    ([texel(first_texel) as u32, texel(second_texel) as u32], middle - first)
}

#[cfg(test)]
mod tests {
    use glam::Affine2;

    use super::*;

    fn texture(size: [u32; 2], texels: &[[u8; 3]]) -> Texture {
        Texture { name: String::new(), size, texels: texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect() }
    }

    #[test]
    fn middles_of_texels_are_their_colours_and_between_lies_the_linear_mean() {
        let picture = texture([2, 1], &[[0, 0, 0], [255, 128, 0]]);
        let at = |u| sampled(&picture, [Wrap::Clamp; 2], Vec2::new(u, 0.5));
        let right = Vec3::new(1.0, Transfer::Srgb.decode(128), 0.0);
        assert_eq!([at(0.25), at(0.75), at(0.5)], [Vec3::ZERO, right, 0.5 * right]);
        assert_eq!([at(-7.0), at(0.0), at(1.0), at(8.0)], [Vec3::ZERO, Vec3::ZERO, right, right]);
    }

    #[test]
    fn rows_run_down() {
        let picture = texture([1, 2], &[[255; 3], [0; 3]]);
        let at = |v| sampled(&picture, [Wrap::Clamp; 2], Vec2::new(0.5, v)).x;
        assert_eq!([at(0.0), at(0.25), at(0.5), at(1.0)], [1.0, 1.0, 0.5, 0.0]);
    }

    #[test]
    fn beyond_the_edge_the_picture_goes_on_as_it_is_told() {
        let (black, white) = ([0; 3], [255; 3]);
        let picture = texture([4, 1], &[black, black, black, white]);
        let at = |wrap, u: f32| sampled(&picture, [wrap, Wrap::Repeat], Vec2::new(u, 0.0)).x;
        let repeated = [-1.125, -0.125, 0.0, 0.875, 1.875, 5.875].map(|u| at(Wrap::Repeat, u));
        assert_eq!(repeated, [1.0, 1.0, 0.5, 1.0, 1.0, 1.0]);
        let mirrored = [-1.125, -0.875, -0.125, 0.875, 1.0, 1.125, 1.875, 2.875].map(|u| at(Wrap::Mirror, u));
        assert_eq!(mirrored, [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0]);
        let clamped = [-1.125, 0.875, 1.125, 1.875].map(|u| at(Wrap::Clamp, u));
        assert_eq!(clamped, [0.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn no_place_is_outside_of_the_picture() {
        let far = [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, -f32::MAX, -1e-30, 1e-30, -0.0, 0.99999994, 1e9];
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for size in [1, 2, 3, 16384] {
                for place in far {
                    let ([a, b], share) = neighbours(place, size, wrap);
                    assert!(
                        a < size && b < size && (0.0..=1.0).contains(&share),
                        "{place} {size} {wrap:?}: {a} {b} {share}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_picture_of_one_colour_is_that_colour_exactly() {
        let picture = texture([3, 3], &[[77, 3, 200]; 9]);
        for step in 0..100 {
            let place = Vec2::new(0.037 * step as f32, -0.91 * step as f32);
            assert_eq!(sampled(&picture, [Wrap::Repeat; 2], place), linear([77, 3, 200, 255]));
        }
    }

    /// A triangle with corners of all kinds, hit in the middle of its first edge.
    fn scene(colors: bool) -> (lightmesh_scene::Scene, Hit) {
        let positions = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y];
        let uvs = [Vec2::ZERO, Vec2::new(0.5, 0.0), Vec2::Y];
        let colors = if colors { &[Vec3::X, Vec3::Y, Vec3::Z][..] } else { &[] };
        let part = lightmesh_scene::MeshPart {
            positions: &positions,
            uvs: &uvs,
            colors,
            triangles: &[[0, 1, 2]],
            ..Default::default()
        };
        let mut builder = lightmesh_scene::SceneBuilder::new();
        builder.add(part, &glam::DMat4::IDENTITY, |_| 0).unwrap();
        let mut scene = builder.finish_scene("triangle");
        scene.geometry_mut().textures.push(texture([2, 1], &[[255, 255, 0], [0, 255, 255]]));
        (scene, Hit { t: 1.0, u: 0.5, v: 0.0, triangle: 0 })
    }

    #[test]
    fn every_coefficient_takes_its_part_of_the_tint() {
        let (mut scene, hit) = scene(true);
        let (ka, kd, ks) = (Vec3::splat(0.25), Vec3::splat(0.5), Vec3::splat(0.125));
        let shift = Affine2::from_translation(Vec2::new(0.5, 0.0));
        let material =
            Material::matt(kd).with_ka(ka).with_ks(ks).with_ks_tinted(2.0 * kd).with_emission_tinted(4.0 * kd);
        let material = material.with_texture(TextureUse { transform: shift, ..TextureUse::new(0) });
        // The texture's right half, and half red half green.
        let tint = Vec3::new(0.0, 1.0, 1.0) * Vec3::new(0.5, 0.5, 0.0);
        let coefficients = Coefficients::at(&scene.geometry, &material, &hit);
        let expected =
            Coefficients { ka: ka * tint, kd: kd * tint, ks: ks + 2.0 * kd * tint, emission: 4.0 * kd * tint };
        assert_eq!(coefficients, expected);
        scene.geometry_mut().mesh.colors.clear();
        assert_eq!(Coefficients::at(&scene.geometry, &material, &hit).kd, kd * Vec3::new(0.0, 1.0, 1.0));
    }

    #[test]
    fn a_texture_that_cannot_be_looked_up_is_none() {
        let (mut scene, hit) = scene(false);
        let material = Material::default().with_texture(TextureUse::new(0)).with_ks_tinted(Vec3::X);
        let untinted = Coefficients::untinted(&material);
        assert_eq!(untinted.ks, Vec3::X);
        assert_ne!(Coefficients::at(&scene.geometry, &material, &hit), untinted);
        let other = material.clone().with_texture(TextureUse::new(7));
        assert_eq!(Coefficients::at(&scene.geometry, &other, &hit), untinted);
        scene.geometry_mut().textures[0].texels.pop();
        assert_eq!(Coefficients::at(&scene.geometry, &material, &hit), untinted);
        scene.geometry_mut().textures[0] = texture([0, 1], &[]);
        assert_eq!(Coefficients::at(&scene.geometry, &material, &hit), untinted);
    }
}
