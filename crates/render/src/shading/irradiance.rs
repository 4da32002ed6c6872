//! Light that is near or wide: the irradiance of a whole light in closed form, if nothing is in the way. Twin: `irradiance.cuh`.
//!
//! A few points stand for a light that is far. Near by, each of them would show as a spot of light. With L = 1, for what is above the horizon:
//!
//! * A **polygon** that is Lambertian (Lambert: *Photometria*, 1760): E = ½ |Σ θᵢ n·gᵢ| over its edges, gᵢ the unit normal of the plane through
//!   the edge and the point, θᵢ the angle at which the edge is seen.
//! * A polygon that shines **evenly**, ∫ cos/d² dA: the attraction of a plate of that form, n·N Ω − Σ n·mᵢ ln((a + b + l)/(a + b − l)); Ω its solid
//!   angle, N its normal, away from the point, mᵢ the outward normal of an edge of length l in its plane, a and b the distances of its ends.
//! * A **disc** that is Lambertian and above the horizon: n · (π r² [(S + z² + r² − ρ²) N + 2 z ρ e] / ((A + S) S)), A = z² + ρ² + r²,
//!   S² = (z² + (ρ − r)²)(z² + (ρ + r)²); z is the point's distance from the disc's plane, ρ from its axis. Other discs are polygons of
//!   [`DISC_CORNERS`] corners, of the same area: within 1 % near the edge, and within 0.1 % at a distance of a tenth of the radius.
//! * A **ball** or a **wide sun**, both of which are caps of directions with the half-angle α around one at the angle θ from the normal: π sin²α cosθ
//!   above the horizon; else, with x = cot α, y = −x cot θ, q = √(1 − y²), sin²α (cosθ arccos y − x q sinθ) + arctan(q sinθ / x)
//!   (Lagarde and de Rousiers: *Moving Frostbite to PBR*, 2014).
//!
//! Lights without falloff, those of the thesis, are their points at any distance, but wide suns shine as strongly as narrow ones.

use glam::Vec3;
use lightmesh_layout::constants::{
    CORNER_COSINE, CORNER_RADIUS, CORNER_SINE, DISC_CORNERS, FRAC_1_PI, NEAR_LIGHT, PI, TAU, UNIT_ROUNDOFF, WIDE_SUN,
};
use lightmesh_scene::{Falloff, Light, LightKind};

use super::turns::{angle, logarithm, turns};
use crate::sampling::disk_radius;
use crate::shadow::size;

/// How much of a light's irradiance follows the closed form: from 0 of a light that is far or narrow to 1 of one that is near or wide. `way` is the
/// way to its centre.
#[inline(always)]
pub fn nearness(light: &Light, way: Vec3) -> f32 {
    if let LightKind::Directional { angle, .. } = light.kind {
        return if disk_radius(angle) > WIDE_SUN { 1.0 } else { 0.0 };
    }
    let size = size(light, 1.0);
    let far = NEAR_LIGHT * way.length();
    if light.falloff == Falloff::None || size <= far {
        return 0.0;
    }
    // From there to half of the distance.
    ((size - far) / far.max(f32::MIN_POSITIVE)).min(1.0)
}

/// Whether a light is near or wide for any surface point.
pub(crate) fn may_be_near(light: &Light) -> bool {
    match light.kind {
        LightKind::Directional { angle, .. } => disk_radius(angle) > WIDE_SUN,
        _ => light.falloff == Falloff::InverseSquare && light.has_size(),
    }
}

/// The irradiance of a light of intensity 1 on a surface with the unit `normal`, over π where that is the light's unit: as the mean of
/// [`strength`](super::strength) times the cosine over all of the light. A spot's cone is left out.
pub fn irradiance(light: &Light, way: Vec3, normal: Vec3) -> f32 {
    match light.kind {
        LightKind::Directional { direction, angle } => {
            let radius = disk_radius(angle);
            let cosine = 1.0 / (1.0 + radius * radius).sqrt();
            let sine = radius * cosine;
            let share = cap(-normal.dot(direction), sine, cosine) / (PI * (sine * sine));
            if light.falloff == Falloff::InverseSquare { FRAC_1_PI * share } else { share }
        }
        LightKind::Sphere { radius, .. } | LightKind::Spot { radius, .. } => {
            let distance = way.length();
            let sine = if distance > radius { radius / distance } else { 1.0 };
            let cosine = (1.0 - sine * sine).max(0.0).sqrt();
            let toward = if distance > 0.0 { normal.dot(way) / distance } else { 1.0 };
            cap(toward, sine, cosine) * (FRAC_1_PI * FRAC_1_PI) / (radius * radius)
        }
        LightKind::Disk { normal: axis, radius, .. } => {
            let (tangent, bitangent) = axis.any_orthonormal_pair();
            let axis = light.surface.unwrap_or(axis);
            let plate = Plate {
                center: way,
                half_u: radius * tangent,
                half_v: radius * bitangent,
                place: (CORNER_RADIUS, 0.0),
                turn: (CORNER_COSINE, CORNER_SINE),
                corners: DISC_CORNERS,
            };
            let seen = match light.surface {
                Some(front) if front.dot(way) >= 0.0 => 0.0,
                Some(_) if is_above(way, axis, radius, normal) => lambertian_disc(way, axis, radius, normal),
                Some(_) => plate.lambertian(normal),
                None => plate.even(normal, axis),
            };
            seen * (FRAC_1_PI * FRAC_1_PI) / (radius * radius)
        }
        LightKind::Rectangle { half_u, half_v, .. } => {
            let plate = Plate { center: way, half_u, half_v, place: (1.0, 1.0), turn: (0.0, 1.0), corners: 4 };
            let across = half_u.cross(half_v);
            let quarter = across.length();
            let seen = match light.surface {
                Some(front) if front.dot(way) >= 0.0 => 0.0,
                Some(_) => plate.lambertian(normal),
                None => plate.even(normal, across / quarter),
            };
            seen * FRAC_1_PI / (4.0 * quarter)
        }
        LightKind::Point { .. } => 0.0,
    }
}

/// The irradiance of a cap of directions, given the cosine between its middle and the normal, and the sine and cosine of its half-angle.
#[inline(always)]
fn cap(toward: f32, sine: f32, cosine: f32) -> f32 {
    if toward >= sine {
        return PI * (sine * sine) * toward;
    }
    if toward <= -sine {
        return 0.0;
    }
    let aside = (1.0 - toward * toward).max(0.0).sqrt();
    let x = cosine / sine;
    let y = if aside > 0.0 { (-x * toward / aside).clamp(-1.0, 1.0) } else { 0.0 };
    let q = (1.0 - y * y).sqrt();
    sine * sine * (toward * angle(q, y) - x * q * aside) + angle(q * aside, x)
}

/// Whether all of a disc is above the horizon.
#[inline(always)]
fn is_above(way: Vec3, axis: Vec3, radius: f32, normal: Vec3) -> bool {
    let leaning = normal.dot(axis);
    normal.dot(way) >= radius * (1.0 - leaning * leaning).max(0.0).sqrt()
}

/// The irradiance of a Lambertian disc above the horizon.
#[inline(always)]
fn lambertian_disc(way: Vec3, axis: Vec3, radius: f32, normal: Vec3) -> f32 {
    let height = axis.dot(way);
    let axis = if height < 0.0 { -axis } else { axis };
    let z = height.abs();
    let aside = way - z * axis;
    let (rho_square, square) = (aside.length_squared(), radius * radius);
    let rho = rho_square.sqrt();
    let (near, far) = (rho - radius, rho + radius);
    let root = ((z * z + near * near) * (z * z + far * far)).sqrt();
    let all = z * z + rho_square + square + root;
    let along = root + (z * z + square - rho_square);
    let light = normal.dot(axis) * along + 2.0 * z * normal.dot(aside);
    if all * root > 0.0 { (PI * square * light / (all * root)).max(0.0) } else { 0.0 }
}

/// A flat light with corners, one after the other: each is the one before, turned in the light's own coordinates.
struct Plate {
    center: Vec3,
    half_u: Vec3,
    half_v: Vec3,
    /// The first corner, in halves.
    place: (f32, f32),
    /// The cosine and sine of the angle to the next.
    turn: (f32, f32),
    corners: u32,
}

impl Plate {
    /// Calls `take` with the ends of each edge of what is above the horizon.
    #[inline(always)]
    fn each_edge(&self, normal: Vec3, mut take: impl FnMut(Vec3, Vec3)) {
        let corner = |(x, y): (f32, f32)| self.center + (x * self.half_u + y * self.half_v);
        let (cosine, sine) = self.turn;
        let mut place = self.place;
        let mut start = corner(place);
        let mut from = normal.dot(start);
        // Where the polygon leaves, and where it comes back to, what is above.
        let (mut left, mut back, mut cut) = (Vec3::ZERO, Vec3::ZERO, false);
        for _ in 0..self.corners {
            place = (cosine * place.0 - sine * place.1, sine * place.0 + cosine * place.1);
            let end = corner(place);
            let to = normal.dot(end);
            if from >= 0.0 || to >= 0.0 {
                let crossing = start + (from / (from - to)) * (end - start);
                if from < 0.0 {
                    back = crossing;
                    take(crossing, end);
                } else if to < 0.0 {
                    (left, cut) = (crossing, true);
                    take(start, crossing);
                } else {
                    take(start, end);
                }
            }
            (start, from) = (end, to);
        }
        if cut {
            take(left, back);
        }
    }

    /// The irradiance if it is Lambertian.
    fn lambertian(&self, normal: Vec3) -> f32 {
        let mut sum = 0.0;
        self.each_edge(normal, |a, b| {
            let across = a.cross(b);
            let length = across.length();
            if length > 0.0 {
                sum += angle(length, a.dot(b)) * (normal.dot(across) / length);
            }
        });
        0.5 * sum.abs()
    }

    /// The same if it shines evenly; its corners turn around `axis`.
    fn even(&self, normal: Vec3, axis: Vec3) -> f32 {
        let height = axis.dot(self.center);
        let away = if height < 0.0 { -axis } else { axis };
        let (mut solid, mut aside) = (0.0, 0.0);
        let (mut first, mut begun) = (Vec3::ZERO, false);
        self.each_edge(normal, |a, b| {
            if !begun {
                (first, begun) = (a, true);
            }
            let (da, db) = (a.length(), b.length());
            // The triangle of the edge and the first corner (Van Oosterom and Strackee 1983).
            let d = first.length();
            let volume = first.dot(a.cross(b)).abs();
            let corner = d * da * db + first.dot(a) * db + first.dot(b) * da + a.dot(b) * d;
            solid += 2.0 * (TAU * turns(volume, corner));
            let edge = b - a;
            let length = edge.length();
            let (sum, rest) = (da + db + length, (da + db - length).max(2.0 * UNIT_ROUNDOFF * (da + db + length)));
            if length > 0.0 {
                aside += normal.dot(edge.cross(axis)) / length * logarithm((sum / rest).max(1.0));
            }
        });
        (normal.dot(away) * solid - aside).max(0.0)
    }
}
