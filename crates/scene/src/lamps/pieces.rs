//! A patch is cut into pieces in its plane, along the sides of the smallest rectangle around it.
//!
//! 1. No piece is longer than a quarter of the scene's diagonal: so far from it, the light of its parts arrives as from one rectangle. A ceiling
//!    that glows has up to 16 pieces, a panel or a strip in a room one or two.
//! 2. If an image makes the patch uneven, its longer side has at least four pieces.
//! 3. Triangles are clipped at the edges of pieces (Sutherland and Hodgman 1974).

use glam::{DVec2, DVec3, Vec2};

use super::{Extent, connected::Triangle, glow::Glow, patches::Patch};
use crate::Geometry;

/// The longest side of a piece, as a share of the scene's diagonal.
const LONGEST: f64 = 0.25;
/// Pieces along the longer side of an image.
const OF_IMAGE: f64 = 4.0;
/// An image is even if the radiance of pieces differs less, as a share of the largest.
const EVEN: f64 = 0.02;
/// Triangles that lean more against their patch, by cosine, are not cut: they are where their middle is.
const STEEP: f64 = 0.05;

/// A part of a patch; places are in its plane, from the middle of its rectangle.
#[derive(Clone)]
pub(super) struct Piece {
    /// The middle of the smallest rectangle around it along the patch's sides, and half the lengths of its sides.
    pub(super) center: DVec2,
    pub(super) half: DVec2,
    /// The middle of its area.
    pub(super) middle: DVec2,
    /// As seen from its front.
    pub(super) area: f64,
    /// Its highest place along the normal.
    pub(super) height: f64,
    /// The area of the surface, also where it is not seen from its front.
    pub(super) surface: f64,
    /// Radiance times that area.
    pub(super) strength: DVec3,
    /// Whether the patch is not cut.
    pub(super) is_whole: bool,
}

/// A corner of a clipped triangle: its place in the plane, and its shares of the triangle's corners.
type Corner = (DVec2, DVec3);

/// The pieces of a patch in the plane of these axes about `start`, where half its sides are `half`.
pub(super) fn pieces(
    patch: &Patch,
    glow: &Glow,
    geometry: &Geometry,
    (start, axes, half): (DVec3, [DVec3; 2], DVec2),
    scene: &Extent,
    cuts_image: bool,
) -> Vec<Piece> {
    let plane = Plane { patch, glow, geometry, start, axes, half };
    let counts = half.to_array().map(|half| (2.0 * half / (LONGEST * scene.diagonal)).ceil().clamp(1.0, 8.0) as u32);
    let long = half.max_element();
    let of_image = half.to_array().map(|half| (OF_IMAGE * half / long).round().max(1.0) as u32);
    if cuts_image {
        let pieces = plane.cut([0, 1].map(|axis| counts[axis].max(of_image[axis])));
        let radiance = |piece: &Piece| piece.strength / piece.area;
        let most = pieces.iter().map(radiance).fold(DVec3::ZERO, DVec3::max);
        let least = pieces.iter().map(radiance).fold(DVec3::INFINITY, DVec3::min);
        if (most - least).max_element() > EVEN * most.max_element() {
            return pieces;
        }
    }
    plane.cut(counts)
}

struct Plane<'p> {
    patch: &'p Patch<'p>,
    glow: &'p Glow<'p>,
    geometry: &'p Geometry,
    start: DVec3,
    axes: [DVec3; 2],
    half: DVec2,
}

/// What is known of a piece before all triangles are.
#[derive(Clone)]
struct Sum {
    least: DVec2,
    most: DVec2,
    weighted: DVec2,
    area: f64,
    height: f64,
    surface: f64,
    strength: DVec3,
}

impl Plane<'_> {
    fn flat(&self, corner: DVec3) -> DVec2 {
        let from = corner - self.start;
        DVec2::new(self.axes[0].dot(from), self.axes[1].dot(from))
    }

    /// Pieces of equal size, row by row, without empty ones.
    fn cut(&self, counts: [u32; 2]) -> Vec<Piece> {
        let [columns, rows] = counts;
        let none = Sum {
            least: DVec2::INFINITY,
            most: DVec2::NEG_INFINITY,
            weighted: DVec2::ZERO,
            area: 0.0,
            height: f64::MIN,
            surface: 0.0,
            strength: DVec3::ZERO,
        };
        let mut sums = vec![none; (columns * rows) as usize];
        let sides = 2.0 * self.half / DVec2::new(columns.into(), rows.into());
        let number = |place: DVec2| -> [u32; 2] {
            let number = (place + self.half) / sides;
            [(number.x as u32).min(columns - 1), (number.y as u32).min(rows - 1)]
        };
        for &triangle in &self.patch.triangles {
            let corners = triangle.corners.map(|corner| self.flat(corner));
            let lean = triangle.outward().normalize_or_zero().dot(self.patch.normal()).abs();
            if lean < STEEP {
                let [column, row] = number((corners[0] + corners[1] + corners[2]) / 3.0);
                let whole = triangle_of(corners);
                self.add(&mut sums[(row * columns + column) as usize], triangle, &whole, None);
                continue;
            }
            let least = number(corners[0].min(corners[1]).min(corners[2]));
            let most = number(corners[0].max(corners[1]).max(corners[2]));
            for (row, column) in (least[1]..=most[1]).flat_map(|row| (least[0]..=most[0]).map(move |c| (row, c))) {
                let low = DVec2::new(column.into(), row.into()) * sides - self.half;
                let clipped = if least == most { triangle_of(corners) } else { clipped(corners, low, low + sides) };
                self.add(&mut sums[(row * columns + column) as usize], triangle, &clipped, Some(lean));
            }
        }
        let is_whole = columns * rows == 1;
        let piece = |sum: Sum| Piece {
            center: 0.5 * (sum.least + sum.most),
            half: 0.5 * (sum.most - sum.least),
            middle: sum.weighted / sum.area,
            area: sum.area,
            height: sum.height,
            surface: sum.surface,
            strength: sum.strength,
            is_whole,
        };
        sums.into_iter().filter(|sum| sum.area > 0.0).map(piece).collect()
    }

    /// A part of a triangle; `lean` is the share of its surface that is seen from the front, if it is not too small.
    fn add(&self, sum: &mut Sum, triangle: &Triangle, part: &[Corner], lean: Option<f64>) {
        let normal = self.patch.normal();
        for &(place, shares) in part {
            let corner: DVec3 = (0..3).map(|corner| shares[corner] * triangle.corners[corner]).sum();
            (sum.least, sum.most) = (sum.least.min(place), sum.most.max(place));
            sum.height = sum.height.max(normal.dot(corner));
        }
        // Triangles about the first corner.
        for index in 2..part.len() {
            let [a, b, c] = [part[0], part[index - 1], part[index]];
            let area = 0.5 * (b.0 - a.0).perp_dot(c.0 - a.0).abs();
            sum.area += area;
            sum.weighted += area * (a.0 + b.0 + c.0) / 3.0;
            let surface = lean.map_or_else(|| triangle.area(), |lean| area / lean);
            sum.surface += surface;
            sum.strength += surface * self.radiance(triangle, [a.1, b.1, c.1]);
        }
    }

    /// The mean radiance between three places with these shares of a triangle's corners.
    fn radiance(&self, triangle: &Triangle, shares: [DVec3; 3]) -> DVec3 {
        let mesh = &self.geometry.mesh;
        if !self.glow.has_image() {
            return self.glow.of_triangle(mesh, triangle.stored);
        }
        let uvs = mesh.triangles[triangle.stored].map(|vertex| mesh.uvs[vertex as usize]);
        let uv = |shares: DVec3| (0..3).map(|corner| shares[corner] as f32 * uvs[corner]).sum::<Vec2>();
        self.glow.mean(shares.map(uv))
    }
}

fn triangle_of(corners: [DVec2; 3]) -> Vec<Corner> {
    corners.into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]).collect()
}

/// The part of a triangle that is between two corners of a piece.
fn clipped(corners: [DVec2; 3], low: DVec2, high: DVec2) -> Vec<Corner> {
    let mut part = triangle_of(corners);
    let heights: [&dyn Fn(DVec2) -> f64; 4] =
        [&|p| p.x - low.x, &|p| high.x - p.x, &|p| p.y - low.y, &|p| high.y - p.y];
    for height in heights {
        let mut kept: Vec<Corner> = Vec::with_capacity(part.len() + 1);
        for index in 0..part.len() {
            let (from, to) = (part[index], part[(index + 1) % part.len()]);
            let (a, b) = (height(from.0), height(to.0));
            if a >= 0.0 {
                kept.push(from);
            }
            if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                let share = a / (a - b);
                kept.push((from.0.lerp(to.0, share), from.1.lerp(to.1, share)));
            }
        }
        part = kept;
    }
    part
}
