//! What a material emits, as the mean of the texels of its image, where its opacity leaves something of the surface.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::model::colors::linear;
use crate::{Geometry, Mesh, Opacity, OpacityChannel, OpacityMode, Texture, TextureUse, Wrap};

/// Texels of a part of an image that count, at most, and along each axis: of more, so many squares of several do, as the texels in their middles.
const TEXELS: [f64; 2] = [1048576.0, 16384.0];
/// Corners of a triangle that is cut by the four sides of a texel, at most.
const CORNERS: usize = 7;

/// The emission of a material.
pub(super) struct Glow<'g> {
    emission: DVec3,
    image: Option<Image<'g>>,
    levels: [f32; 256],
    /// What there is of the surface, with an image of that.
    opacity: Opacity,
    holes: Option<Image<'g>>,
    pub(super) name: &'g str,
}

/// An image on a material.
#[derive(Clone, Copy)]
struct Image<'g> {
    texture: &'g Texture,
    uses: TextureUse,
}

impl<'g> Glow<'g> {
    /// That of material number `material`.
    pub(super) fn of(geometry: &'g Geometry, material: u32) -> Glow<'g> {
        let material = &geometry.materials[material as usize];
        let image = |uses: Option<TextureUse>| {
            let uses = uses.filter(|_| !geometry.mesh.uvs.is_empty())?;
            geometry.textures.get(uses.texture as usize).map(|texture| Image { texture, uses })
        };
        let opacity = material.opacity.unwrap_or_default();
        let name = if material.name.is_empty() { "lamp" } else { &material.name };
        Glow {
            emission: material.emission.as_dvec3(),
            image: image(material.emission_texture),
            levels: std::array::from_fn(|code| linear(Vec3::splat(code as f32 / 255.0)).x),
            opacity,
            holes: image(opacity.texture),
            name,
        }
    }

    /// Whether it differs from place to place.
    pub(super) fn has_image(&self) -> bool {
        self.image.is_some() || self.holes.is_some()
    }

    /// The mean radiance of a stored triangle.
    pub(super) fn of_triangle(&self, mesh: &Mesh, stored: usize) -> DVec3 {
        self.mean(mesh, stored, [DVec3::X, DVec3::Y, DVec3::Z])
    }

    /// The mean radiance between three places of a stored triangle, with these shares of its corners.
    pub(super) fn mean(&self, mesh: &Mesh, stored: usize, shares: [DVec3; 3]) -> DVec3 {
        let opacities =
            mesh.triangles[stored].map(|vertex| mesh.opacities.get(vertex as usize).copied().unwrap_or(1.0));
        let own = f64::from(opacities.iter().sum::<f32>()) / 3.0;
        let images = [self.image, self.holes];
        let corners = images.map(|image| image.map(|image| image.corners(mesh, stored, shares)));
        // 1. The texels of the image that has more of them there count; the other one's are those in their middles.
        let texels =
            |corners: Option<[DVec2; 3]>| corners.map_or(-1.0, |[a, b, c]| 0.5 * (b - a).perp_dot(c - a).abs());
        let finer = usize::from(texels(corners[1]) > texels(corners[0]));
        let Some(all) = corners[finer] else {
            return self.emission * self.left(own, None);
        };
        let seen = |shares: DVec3| {
            let texel = |which: usize| {
                let at = |corners: [DVec2; 3]| (0..3).map(|corner| shares[corner] * corners[corner]).sum::<DVec2>();
                images[which].zip(corners[which]).map(|(image, corners)| image.texel(at(corners)))
            };
            let radiance = texel(0).map_or(DVec3::ONE, |[r, g, b, _]| {
                Vec3::new(self.levels[r as usize], self.levels[g as usize], self.levels[b as usize]).as_dvec3()
            });
            self.emission * radiance * self.left(own, texel(1))
        };
        // 2. Each with the area of its part of the triangle.
        let (mut sum, mut area) = (DVec3::ZERO, 0.0);
        each_texel(all, |shares, part| {
            sum += part * seen(shares);
            area += part;
        });
        if area > 0.0 { sum / area } else { seen(DVec3::splat(1.0 / 3.0)) }
    }

    /// How much of the surface there is where its vertices and its image say so.
    fn left(&self, own: f64, texel: Option<[u8; 4]>) -> f64 {
        let image = texel.map_or(1.0, |texel| f64::from(OpacityChannel::of(texel, self.opacity.channel)) / 255.0);
        let opacity = f64::from(self.opacity.factor) * own * image;
        match self.opacity.mode {
            OpacityMode::Mask { cutoff } => f64::from(u8::from(opacity >= f64::from(cutoff))),
            OpacityMode::Blend { .. } => opacity.clamp(0.0, 1.0),
        }
    }
}

impl Image<'_> {
    /// Three places of a triangle, in texels.
    fn corners(&self, mesh: &Mesh, stored: usize, shares: [DVec3; 3]) -> [DVec2; 3] {
        let size = Vec2::new(self.texture.size[0] as f32, self.texture.size[1] as f32);
        let corners = mesh.triangles[stored]
            .map(|vertex| (size * self.uses.transform.transform_point2(mesh.uvs[vertex as usize])).as_dvec2());
        shares.map(|shares| (0..3).map(|corner| shares[corner] * corners[corner]).sum())
    }

    fn texel(&self, place: DVec2) -> [u8; 4] {
        let [x, y] = [0, 1].map(|axis| within(place[axis], self.texture.size[axis], self.uses.wrap[axis]));
        self.texture.texels[y as usize * self.texture.size[0] as usize + x as usize]
    }
}

/// Calls `take` for each texel of which a part lies in a triangle: with the shares of the corners in its middle, and the area of that part.
fn each_texel([a, b, c]: [DVec2; 3], mut take: impl FnMut(DVec3, f64)) {
    let double = (b - a).perp_dot(c - a);
    let (least, most) = (a.min(b).min(c), a.max(b).max(c));
    let by_area = (0.5 * double.abs() / TEXELS[0]).sqrt();
    let step = by_area.max((most - least).max_element() / TEXELS[1]).ceil().max(1.0);
    if double == 0.0 || !step.is_finite() || !double.is_finite() {
        return;
    }
    let shares = |place: DVec2| {
        let (v, w) = ((place - a).perp_dot(c - a) / double, (b - a).perp_dot(place - a) / double);
        DVec3::new(1.0 - v - w, v, w)
    };
    let numbers = |low: f64, high: f64| (low / step).floor() as i64..=(high / step).floor() as i64;
    let mut below = Polygon::of(&[a, b, c]);
    for row in numbers(least.y, most.y) {
        let (band, rest) = below.cut(1, (row + 1) as f64 * step);
        below = rest;
        let (low, high) = band.ends(0);
        let mut right = band;
        for column in numbers(low, high) {
            let (texel, rest) = right.cut(0, (column + 1) as f64 * step);
            right = rest;
            let area = texel.area();
            if area > 0.0 {
                take(shares(step * DVec2::new(column as f64 + 0.5, row as f64 + 0.5)), area);
            }
        }
    }
}

/// A part of a triangle.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [DVec2; CORNERS],
    count: usize,
}

impl Polygon {
    fn of(corners: &[DVec2]) -> Polygon {
        let mut polygon = Polygon { corners: [DVec2::ZERO; CORNERS], count: 0 };
        corners.iter().for_each(|&corner| polygon.push(corner));
        polygon
    }

    fn push(&mut self, corner: DVec2) {
        if self.count < CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    fn list(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    /// The parts before and beyond a place on an axis (Sutherland and Hodgman 1974).
    fn cut(&self, axis: usize, place: f64) -> (Polygon, Polygon) {
        let (mut before, mut beyond) = (Polygon::of(&[]), Polygon::of(&[]));
        let corners = self.list();
        for (index, &from) in corners.iter().enumerate() {
            let to = corners[(index + 1) % corners.len()];
            let (a, b) = (from[axis] - place, to[axis] - place);
            if a <= 0.0 {
                before.push(from);
            }
            if a >= 0.0 {
                beyond.push(from);
            }
            if a * b < 0.0 {
                let crossing = from.lerp(to, a / (a - b));
                before.push(crossing);
                beyond.push(crossing);
            }
        }
        (before, beyond)
    }

    fn ends(&self, axis: usize) -> (f64, f64) {
        let places = self.list().iter().map(|corner| corner[axis]);
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| (low.min(place), high.max(place)))
    }

    fn area(&self) -> f64 {
        let corners = self.list();
        let Some(&first) = corners.first() else { return 0.0 };
        0.5 * corners.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum::<f64>().abs()
    }
}

/// The texel at a place on an axis of an image that has `size`.
fn within(place: f64, size: u32, wrap: Wrap) -> u32 {
    let length = f64::from(size);
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
