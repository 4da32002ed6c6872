//! A patch is cut into pieces in its plane, along the sides of the smallest rectangle around it.
//!
//! 1. No piece is longer than a quarter of the scene's diagonal: so far from it, the light of its parts arrives as from one rectangle. A ceiling
//!    that glows has up to 16 pieces, a panel or a strip in a room one or two.
//! 2. If an image makes the patch uneven, its longer side has at least four pieces.
//! 3. A piece that fills little of the rectangle around it, such as a frame or an L, is cut further: where that leaves a side that fills its own, or
//!    else where the rectangles around both sides are smallest.
//! 4. Triangles are clipped at the edges of pieces (Sutherland and Hodgman 1974).

use glam::{DVec2, DVec3};

use super::{connected::Triangle, extent::Extent, glow::Glow, patches::Patch};
use crate::Geometry;

/// The longest side of a piece, as a share of the scene's diagonal.
const LONGEST: f64 = 0.25;
/// Pieces along the longer side of an image.
const OF_IMAGE: f64 = 4.0;
/// An image is even if the radiance of pieces differs less, as a share of the largest.
const EVEN: f64 = 0.02;
/// A piece is cut further if it fills less than this share of the rectangle around it,
const LOOSE: f64 = 0.45;
/// and what it leaves empty is more than this share of the patch,
const MISSED: f64 = 0.05;
/// if that makes the part of its rectangle that is not full smaller by this share.
const GAIN: f64 = 0.03;
/// One cut is better than another if it leaves less than this share of what that leaves: ties are not decided by rounding.
const CLEARLY: f64 = 1.0 - 1e-6;
/// A side that fills this share of its rectangle is full.
const FULL: f64 = 0.95;
/// Pieces of a patch that is cut so, at most, and places where a cut is tried along each axis.
const CUTS: [usize; 2] = [16, 48];
/// What is a smaller share of a triangle is none of it.
const TOUCHING: f64 = 1e-9;
/// Patches with more triangles are not cut so.
const SIMPLE: usize = 4096;
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
    let pieces = plane.cut(counts);
    if patch.triangles.len() > SIMPLE { pieces } else { plane.tightened(pieces) }
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

impl Sum {
    const NONE: Sum = Sum {
        least: DVec2::INFINITY,
        most: DVec2::NEG_INFINITY,
        weighted: DVec2::ZERO,
        area: 0.0,
        height: f64::MIN,
        surface: 0.0,
        strength: DVec3::ZERO,
    };

    fn piece(self, is_whole: bool) -> Piece {
        Piece {
            center: 0.5 * (self.least + self.most),
            half: 0.5 * (self.most - self.least),
            middle: self.weighted / self.area,
            area: self.area,
            height: self.height,
            surface: self.surface,
            strength: self.strength,
            is_whole,
        }
    }
}

impl Piece {
    /// The area of the rectangle around it.
    fn rectangle(&self) -> f64 {
        4.0 * self.half.x * self.half.y
    }

    fn filled(&self) -> f64 {
        self.area / self.rectangle()
    }
}

impl Plane<'_> {
    fn flat(&self, corner: DVec3) -> DVec2 {
        let from = corner - self.start;
        DVec2::new(self.axes[0].dot(from), self.axes[1].dot(from))
    }

    /// Pieces that fill most of the rectangles around them.
    fn tightened(&self, mut pieces: Vec<Piece>) -> Vec<Piece> {
        let all: f64 = pieces.iter().map(|piece| piece.area).sum();
        let mut done = 0;
        while done < pieces.len() && pieces.len() < CUTS[0] {
            let piece = &pieces[done];
            let is_loose = piece.filled() < LOOSE && piece.rectangle() - piece.area > MISSED * all;
            match is_loose.then(|| self.halves(piece)).flatten() {
                Some(halves) => {
                    pieces.splice(done..=done, halves);
                }
                None => done += 1,
            }
        }
        pieces
    }

    /// The two parts of a piece where it is cut best, unless nothing is gained.
    fn halves(&self, piece: &Piece) -> Option<[Piece; 2]> {
        let [low, high] = [piece.center - piece.half, piece.center + piece.half];
        let loose = |part: &Piece| if part.filled() < FULL { part.rectangle() } else { 0.0 };
        let mut best: Option<(f64, [[DVec2; 2]; 2])> = None;
        for axis in 0..2 {
            for place in self.places(axis, [low, high]) {
                let (mut end, mut start) = (high, low);
                end[axis] = place;
                start[axis] = place;
                let parts = [[low, end], [start, high]];
                let pieces = parts.map(|part| self.within(part, false));
                let left = pieces.iter().map(loose).sum();
                if pieces.iter().all(|piece| piece.area > 0.0) && best.is_none_or(|(least, _)| left < CLEARLY * least) {
                    best = Some((left, parts));
                }
            }
        }
        let (left, parts) = best?;
        (left < (1.0 - GAIN) * piece.rectangle()).then(|| parts.map(|part| self.within(part, true)))
    }

    /// Where corners of triangles lie within a rectangle, along an axis: every so manyth if they are many.
    fn places(&self, axis: usize, [low, high]: [DVec2; 2]) -> Vec<f64> {
        let hair = 1e-6 * (high - low)[axis];
        let corners = self.patch.triangles.iter().flat_map(|triangle| triangle.corners);
        let places = corners.map(|corner| self.flat(corner)[axis]);
        let mut places: Vec<f64> =
            places.filter(|&place| place > low[axis] + hair && place < high[axis] - hair).collect();
        places.push(0.5 * (low + high)[axis]);
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| *a - *b < hair);
        let step = places.len().div_ceil(CUTS[1]);
        places.into_iter().step_by(step).collect()
    }

    /// The part within a rectangle.
    fn within(&self, [low, high]: [DVec2; 2], strength: bool) -> Piece {
        let mut sum = Sum::NONE;
        for &triangle in &self.patch.triangles {
            let corners = triangle.corners.map(|corner| self.flat(corner));
            let lean = self.lean(triangle);
            if lean < STEEP {
                let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                // Each lies in one part: the sides of parts are shared.
                if middle.cmpge(low).all() && middle.cmplt(high).all() {
                    self.add(&mut sum, triangle, &triangle_of(corners), None, strength);
                }
                continue;
            }
            self.add(&mut sum, triangle, &clipped(corners, low, high), Some(lean), strength);
        }
        sum.piece(false)
    }

    /// The share of a triangle's surface that is seen from the patch's front.
    fn lean(&self, triangle: &Triangle) -> f64 {
        triangle.outward().normalize_or_zero().dot(self.patch.normal()).abs()
    }

    /// Pieces of equal size, row by row, without empty ones.
    fn cut(&self, counts: [u32; 2]) -> Vec<Piece> {
        let [columns, rows] = counts;
        let mut sums = vec![Sum::NONE; (columns * rows) as usize];
        let sides = 2.0 * self.half / DVec2::new(columns.into(), rows.into());
        let number = |place: DVec2| -> [u32; 2] {
            let number = (place + self.half) / sides;
            [(number.x as u32).min(columns - 1), (number.y as u32).min(rows - 1)]
        };
        for &triangle in &self.patch.triangles {
            let corners = triangle.corners.map(|corner| self.flat(corner));
            let lean = self.lean(triangle);
            if lean < STEEP {
                let [column, row] = number((corners[0] + corners[1] + corners[2]) / 3.0);
                let whole = triangle_of(corners);
                self.add(&mut sums[(row * columns + column) as usize], triangle, &whole, None, true);
                continue;
            }
            let least = number(corners[0].min(corners[1]).min(corners[2]));
            let most = number(corners[0].max(corners[1]).max(corners[2]));
            for (row, column) in (least[1]..=most[1]).flat_map(|row| (least[0]..=most[0]).map(move |c| (row, c))) {
                let low = DVec2::new(column.into(), row.into()) * sides - self.half;
                let clipped = if least == most { triangle_of(corners) } else { clipped(corners, low, low + sides) };
                self.add(&mut sums[(row * columns + column) as usize], triangle, &clipped, Some(lean), true);
            }
        }
        let is_whole = columns * rows == 1;
        sums.into_iter().filter(|sum| sum.area > 0.0).map(|sum| sum.piece(is_whole)).collect()
    }

    /// A part of a triangle; `lean` is the share of its surface that is seen from the front, if it is not too small.
    /// What it emits is left out if only its shape is wanted.
    fn add(&self, sum: &mut Sum, triangle: &Triangle, part: &[Corner], lean: Option<f64>, strength: bool) {
        let normal = self.patch.normal();
        let double = |index: usize| (part[index - 1].0 - part[0].0).perp_dot(part[index].0 - part[0].0).abs();
        // A part that only touches a cut is none.
        if lean.is_some() && (2..part.len()).map(double).sum::<f64>() <= TOUCHING * triangle.area() {
            return;
        }
        for &(place, shares) in part {
            let corner: DVec3 = (0..3).map(|corner| shares[corner] * triangle.corners[corner]).sum();
            (sum.least, sum.most) = (sum.least.min(place), sum.most.max(place));
            sum.height = sum.height.max(normal.dot(corner));
        }
        // Triangles about the first corner.
        for index in 2..part.len() {
            let [a, b, c] = [part[0], part[index - 1], part[index]];
            let area = 0.5 * double(index);
            sum.area += area;
            sum.weighted += area * (a.0 + b.0 + c.0) / 3.0;
            let surface = lean.map_or_else(|| triangle.area(), |lean| area / lean);
            sum.surface += surface;
            if strength {
                sum.strength += surface * self.glow.mean(&self.geometry.mesh, triangle.stored, [a.1, b.1, c.1]);
            }
        }
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
