//! What a material emits, as the mean of the texels of its image.

use glam::{DVec3, Vec2, Vec3};

use crate::{Geometry, Mesh, Texture, TextureUse, Wrap, formats::colors::linear};

/// Places at which a part of an image is looked up: one for each texel, but at least and at most so many.
const PLACES: [f32; 2] = [256.0, 16384.0];

/// The emission of a material.
pub(super) struct Glow<'g> {
    emission: DVec3,
    image: Option<(&'g Texture, TextureUse, [f32; 256])>,
    pub(super) name: &'g str,
}

impl<'g> Glow<'g> {
    /// That of material number `material`.
    pub(super) fn of(geometry: &'g Geometry, material: u32) -> Glow<'g> {
        let material = &geometry.materials[material as usize];
        let opacity = material.opacity.filter(|opacity| opacity.filter().is_some() && opacity.texture.is_none());
        let share = opacity.map_or(1.0, |opacity| opacity.factor.min(1.0));
        let levels = || std::array::from_fn(|code| linear(Vec3::splat(code as f32 / 255.0)).x);
        let image = material.emission_texture.filter(|_| !geometry.mesh.uvs.is_empty());
        let image = image.and_then(|uses| Some((geometry.textures.get(uses.texture as usize)?, uses, levels())));
        let name = if material.name.is_empty() { "lamp" } else { &material.name };
        Glow { emission: (share * material.emission).as_dvec3(), image, name }
    }

    /// Whether it differs from place to place.
    pub(super) fn has_image(&self) -> bool {
        self.image.is_some()
    }

    /// The mean radiance of a stored triangle.
    pub(super) fn of_triangle(&self, mesh: &Mesh, stored: usize) -> DVec3 {
        match &self.image {
            None => self.emission,
            Some(_) => self.mean(mesh.triangles[stored].map(|vertex| mesh.uvs[vertex as usize])),
        }
    }

    /// The mean radiance between three texture coordinates.
    pub(super) fn mean(&self, uvs: [Vec2; 3]) -> DVec3 {
        let Some((texture, uses, levels)) = &self.image else { return self.emission };
        let size = Vec2::new(texture.size[0] as f32, texture.size[1] as f32);
        let [a, b, c] = uvs.map(|uv| size * uses.transform.transform_point2(uv));
        // 1. As many places as texels, in rows of a parallelogram of which the triangle is one half: the other one is turned onto it.
        let texels = 0.5 * (b - a).perp_dot(c - a).abs();
        #[allow(clippy::manual_clamp, reason = "`clamp` would keep NaN")]
        let side = texels.max(PLACES[0]).min(PLACES[1]).sqrt().ceil() as u32;
        let step = 1.0 / side as f32;
        let mut sum = DVec3::ZERO;
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let (s, t) = (step * (column as f32 + 0.5), step * (row as f32 + 0.5));
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            // 2. The texel there.
            let place = a + s * (b - a) + t * (c - a);
            let [x, y] = [0, 1].map(|axis| within(place[axis], texture.size[axis], uses.wrap[axis]));
            let [r, g, b, _] = texture.texels[y as usize * texture.size[0] as usize + x as usize];
            sum += Vec3::new(levels[r as usize], levels[g as usize], levels[b as usize]).as_dvec3();
        }
        self.emission * sum / f64::from(side * side)
    }
}

/// The texel at a place on an axis of an image that has `size`.
fn within(place: f32, size: u32, wrap: Wrap) -> u32 {
    let length = size as f32;
    let inside = match wrap {
        Wrap::Clamp => place,
        Wrap::Repeat => place.rem_euclid(length),
        Wrap::Mirror => {
            let twice = place.rem_euclid(2.0 * length);
            if twice > length { 2.0 * length - twice } else { twice }
        }
    };
    // Negative and undefined places become 0.
    (inside as u32).min(size - 1)
}
