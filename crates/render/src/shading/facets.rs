//! Facets: rough surfaces, metals and others, as glTF describes them. Twin: `facets.cuh`.
//!
//! ```text
//! f = D V F      D = α² / (π x²),  x = α² (N·H)² + |N×H|²      V = ½ / (N·L √(N·E² (1 − α²) + α²) + N·E √(N·L² (1 − α²) + α²))
//!                F = f₀ + (f₉₀ − f₀) (1 − E·H)⁵                H halfway between L, to the light, and E, to the eye
//! ```
//!
//! (Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, EGSR 2007; Heitz, *Understanding the Masking-Shadowing Function*,
//! JCGT 3(2), 2014; Schlick, *An Inexpensive BRDF Model*, Eurographics 1994.) α is the square of the roughness.
//!
//! 1. **Light from all sides.** What is reflected of it, f₀ a + f₉₀ b, depends on roughness and N·E: a table has a and b, integrated once.
//! 2. **Repeated reflection** between facets, which f leaves out, returns 1 + f₀ (1 / (a + b) − 1) times as much (Turquin, *Practical
//!    Multiple Scattering Compensation for Microfacet Models*, 2019): a white surface reflects all.
//! 3. **Below the layer**, what it does not reflect is scattered, but of a metal nothing is.
//! 4. **Lobes** are as wide as what they stand for: the part of a light that one of its points stands for, and the part of the surface that a
//!    sample sees (Tokuyoshi, Kaplanyan, *Improved Geometric Specular Antialiasing*, I3D 2019). So highlights are neither dots nor noise.
//! 5. **Mirrors.** Where mirror rays are followed, they show what facets reflect up to a roughness of 0.5, and less and less up to 0.6; the rest is
//!    as if the light from all sides was the mean that is gathered. Of lights they show less and less from 0.05 to 0.17: highlights have no noise.
//! 6. **Directions** of mirror rays are distributed as the facets that are seen reflect the view (Heitz, *Sampling the GGX Distribution of
//!    Visible Normals*, JCGT 7(4), 2018), by points on a spherical cap (Dupuy, Benyoub, *Sampling Visible GGX Normals with Spherical Caps*, HPG
//!    2023). A ray's share is what remains of f N·L over its probability: F times what the other side's shadowing leaves.

use std::f64::consts::PI;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};
use lightmesh_layout::constants::{
    FACET_PLACES, FRAC_PI_2, LIGHTS_END, LIGHTS_FADE, MAX_CONES, MAX_DIRECTIONS, MIN_FACET_WIDTH, MIN_SMOOTH_SQUARE,
    MIN_VIEW_COSINE, MIRROR_ENDS, MIRROR_FADES, PARTS_OF_FADE, WIDE_LOBE, WIDTH_OF_LOBE,
};
use lightmesh_scene::Facets;

use super::tint::Coefficients;
use crate::footprint::Cone;
use crate::textures::between;

/// Directions along each axis of a cell of the table.
const DIRECTIONS: u32 = 24;

/// How a surface point with facets is seen.
pub struct Sight {
    /// The cosine of the angle between the normal and the direction to the eye.
    pub cosine: f32,
    /// The range of mirrored directions over what a sample sees of the surface, an angle.
    pub spread: f32,
    /// Whether its mirror ray is followed.
    pub followed: bool,
    /// Whether it is seen in a mirror.
    pub mirrored: bool,
}

/// What a surface point with facets does to light from one direction.
pub struct Lobe {
    /// f₀ and f₉₀.
    ends: [Vec3; 2],
    /// What repeated reflection adds, a factor.
    pub gain: Vec3,
    /// α².
    square: f32,
    /// The same for the part of the surface that is seen.
    seen_square: f32,
    /// N·E.
    cosine: f32,
    /// The width of the facets' distribution, 0 for a smooth mirror.
    width: f32,
    /// The share of reflections that mirror rays show.
    pub shown: f32,
    /// The same of what an image alone shows: also where the last mirror ray ends.
    pub boxed: f32,
    /// The share of the reflections of lights that they do not show.
    pub unmirrored: f32,
}

impl Lobe {
    /// The lobe of a surface point whose coefficients are those of its material with its tint; they become those of its reflections.
    pub fn new(facets: &Facets, coefficients: &mut Coefficients, sight: &Sight) -> Lobe {
        let Coefficients { kd: base, ks: layer, opacity, .. } = *coefficients;
        let cosine = sight.cosine.max(MIN_VIEW_COSINE);
        // 1. and 2.
        let [a, b] = of_all(facets.roughness, cosine);
        let again = 1.0 / (a + b) - 1.0;
        let whole = |f0: Vec3, f90: f32| (a * f0 + Vec3::splat(b * f90)) * (Vec3::ONE + again * f0);
        let by_layer = whole(layer, facets.grazing);
        let metallic = facets.metallic;
        let all = between(by_layer, whole(base, 1.0), metallic);
        let ends = [between(layer, base, metallic), Vec3::splat((1.0 - metallic) * facets.grazing + metallic)];
        let once = a * ends[0] + b * ends[1];
        let gain = Vec3::select(once.cmpgt(Vec3::ZERO), all / once, Vec3::ONE);

        // 3.
        coefficients.kd = (opacity * (1.0 - metallic)) * (base * (Vec3::ONE - by_layer));
        // 5.
        let mirrors = mirrored_share(facets.roughness);
        let shown = if sight.followed { mirrors } else { 0.0 };
        let boxed = if sight.mirrored { mirrors } else { shown };
        coefficients.mirrored = (opacity * shown) * all;
        coefficients.all = coefficients.kd + (opacity * (1.0 - shown)) * all;
        coefficients.ka = coefficients.all;

        // 4.
        let square = square_of(facets.roughness);
        let seen = 0.25 * sight.spread;
        let seen_square = square + seen * seen;
        let lights = if sight.followed { 1.0 - faded(facets.roughness) as f32 / PARTS_OF_FADE as f32 } else { 0.0 };
        let unmirrored = 1.0 - lights;
        let width = facets.roughness * facets.roughness;
        Lobe { ends, gain: opacity * gain, square, seen_square, cosine, width, shown, boxed, unmirrored }
    }

    /// 6. The direction in which the facets that `u` in [0, 1)² selects reflect the view, and the share of the radiance there that the eye sees; zero
    ///    where they reflect it into the surface. The mean over all u is what is mirrored.
    pub fn drawn(&self, normal: Vec3, view: Vec3, u: [f32; 2]) -> (Vec3, Vec3) {
        // Along the surface to the eye, and across.
        let slope = view - normal.dot(view) * normal;
        let square = slope.length_squared();
        let along = if square > MIN_SMOOTH_SQUARE {
            slope / square.sqrt()
        } else {
            let axis = if normal.x.abs() < 0.5 { Vec3::X } else { Vec3::Y };
            let aside = normal.cross(axis);
            aside / aside.length()
        };
        let across = normal.cross(along);
        let (cosine, width) = (self.cosine, self.width);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();

        // The facet, where the surface is stretched to a ball.
        let length = (width * sine * (width * sine) + cosine * cosine).sqrt();
        let (x, z) = (width * sine / length, cosine / length);
        let [turned, aside] = around(u[0]);
        let height = (1.0 - u[1]) * (1.0 + z) - z;
        let ring = (1.0 - height * height).max(0.0).sqrt();
        let half = Vec3::new(width * (ring * turned + x), width * (ring * aside), height + z);
        let half = half / half.length();

        // The view, reflected.
        let facing = sine * half.x + cosine * half.z;
        let reflected = 2.0 * facing * half - Vec3::new(sine, 0.0, cosine);
        let light = reflected.z;
        if !(light > 0.0 && facing > 0.0) {
            return (normal, Vec3::ZERO);
        }
        let direction = reflected.x * along + reflected.y * across + light * normal;

        // What the other side's shadowing leaves, and Fresnel's equations.
        let own = width * width;
        let shadowing = |cosine: f32| (cosine * cosine * (1.0 - own) + own).sqrt();
        let (seen, lit) = (light * shadowing(cosine), cosine * shadowing(light));
        let left = light * (cosine + shadowing(cosine)) / (seen + lit);
        let away = (1.0 - facing).max(0.0);
        let square = away * away;
        let [f0, f90] = self.ends;
        let fresnel = between(f0, f90, square * square * away);
        (direction / direction.length(), (self.shown * left) * (fresnel * self.gain))
    }

    /// π f for light from a direction, where half of the part of the light that it stands for is `part` wide: an angle.
    #[inline(always)]
    pub fn toward(&self, normal: Vec3, view: Vec3, direction: Vec3, part: f32) -> Vec3 {
        let sum = direction + view;
        let length = sum.length();
        if length == 0.0 {
            return Vec3::ZERO;
        }
        let half = sum / length;
        let (facing, light) = (normal.dot(half), normal.dot(direction));
        // 4.
        let wide = self.seen_square + 0.25 * (part * part);
        let x = wide * (facing * facing) + normal.cross(half).length_squared();
        let rest = 1.0 - self.square;
        let seen = light * (self.cosine * self.cosine * rest + self.square).sqrt();
        let lit = self.cosine * (light * light * rest + self.square).sqrt();
        let away = (1.0 - view.dot(half)).max(0.0);
        let square = away * away;
        let [f0, f90] = self.ends;
        let fresnel = between(f0, f90, square * square * away);
        (wide / (x * x) * 0.5 / (seen + lit)) * (fresnel * self.gain)
    }
}

/// The cosine and the sine of a share of a full turn.
#[inline(always)]
fn around(turn: f32) -> [f32; 2] {
    // An eighth of a turn to either side, by the series of the sine.
    let quarters = 4.0 * turn;
    let quarter = (quarters as u32).min(3);
    let angle = (quarters - quarter as f32 - 0.5) * FRAC_PI_2;
    let square = angle * angle;
    let sine = angle * (1.0 - square * (1.0 / 6.0) * (1.0 - square * (1.0 / 20.0)));
    let cosine = (1.0 - sine * sine).sqrt();
    match quarter {
        0 => [cosine, sine],
        1 => [-sine, cosine],
        2 => [-cosine, -sine],
        _ => [sine, -cosine],
    }
}

/// In how many directions a mirror with facets reflects a ray, a power of two; the share `weight` of their radiance reaches the pixel.
pub(crate) fn directions(weight: f32, roughness: f32) -> u32 {
    let wide = (roughness * roughness / WIDE_LOBE).min(1.0);
    let wanted = MAX_DIRECTIONS as f32 * wide * weight.sqrt();
    let mut count = 1;
    while count < MAX_DIRECTIONS && (count as f32) < wanted {
        count *= 2;
    }
    count
}

/// The cone that a mirror with facets reflects in each of `count` directions, if a smooth one reflects `cone`; `weight` is the share of a ray.
/// Together they are as wide as the lobe.
pub(crate) fn blurred(cone: Cone, roughness: f32, count: u32, weight: f32) -> Cone {
    let all = (count as f32 / weight).clamp(1.0, MAX_CONES);
    Cone { spread: cone.spread.abs() + WIDTH_OF_LOBE * (roughness * roughness) / all.sqrt(), ..cone }
}

/// How much of lights mirror rays do not show, in [`PARTS_OF_FADE`] parts.
pub(crate) fn faded(roughness: f32) -> u32 {
    let share = ((LIGHTS_END - roughness) / (LIGHTS_END - LIGHTS_FADE)).clamp(0.0, 1.0);
    (PARTS_OF_FADE as f32 * (1.0 - share * share * (3.0 - 2.0 * share)) + 0.5) as u32
}

/// The share of what facets reflect that mirror rays show.
pub(crate) fn mirrored_share(roughness: f32) -> f32 {
    let share = ((MIRROR_ENDS - roughness) / (MIRROR_ENDS - MIRROR_FADES)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// α².
fn square_of(roughness: f32) -> f32 {
    let width = (roughness * roughness).max(MIN_FACET_WIDTH);
    width * width
}

/// a and b: f₀ a + f₉₀ b of light from all sides is reflected.
fn of_all(roughness: f32, cosine: f32) -> [f32; 2] {
    const LAST: f32 = FACET_PLACES as f32 - 1.0;
    let (table, side) = (table(), FACET_PLACES as usize);
    let (x, y) = (roughness * LAST, cosine.min(1.0).sqrt() * LAST);
    let (column, row) = ((x as usize).min(side - 2), (y as usize).min(side - 2));
    let (across, along) = (x - column as f32, y - row as f32);
    let mix = |a: f32, b: f32, share: f32| a + share * (b - a);
    [0, 1].map(|term| {
        let at = |row: usize| {
            let [a, b] = [column, column + 1].map(|column| table[row * side + column][term]);
            mix(a, b, across)
        };
        mix(at(row), at(row + 1), along)
    })
}

/// a and b by roughness, from 0 to 1, and below each other by the root of the cosine, from 0 to 1.
pub(crate) fn table() -> &'static [[f32; 2]] {
    static TABLE: OnceLock<Vec<[f32; 2]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let place = |index: u32| f64::from(index) / f64::from(FACET_PLACES - 1);
        let entry = |index: u32| {
            let (roughness, root) = (place(index % FACET_PLACES), place(index / FACET_PLACES));
            integrated(roughness, (root * root).max(f64::from(MIN_VIEW_COSINE)))
        };
        (0..FACET_PLACES * FACET_PLACES).map(entry).collect()
    })
}

/// a and b by numbers: the mean over the facets that are seen (Dupuy, Benyoub, *Sampling Visible GGX Normals with Spherical Caps*, HPG 2023).
fn integrated(roughness: f64, cosine: f64) -> [f32; 2] {
    let width = (roughness * roughness).max(f64::from(MIN_FACET_WIDTH));
    let eye = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let stretched = DVec3::new(width * eye.x, 0.0, eye.z).normalize();
    let shadowing = |cosine: f64| (cosine * cosine * (1.0 - width * width) + width * width).sqrt();
    let mut sums = [0.0; 2];
    for (i, j) in (0..DIRECTIONS).flat_map(|i| (0..DIRECTIONS).map(move |j| (i, j))) {
        let [u, v] = [i, j].map(|index| (f64::from(index) + 0.5) / f64::from(DIRECTIONS));
        // Both halves of the circle are alike.
        let (sin, cos) = (PI * u).sin_cos();
        let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let cap = DVec3::new(radius * cos, radius * sin, z) + stretched;
        let half = DVec3::new(width * cap.x, width * cap.y, cap.z).normalize();
        let facing = eye.dot(half);
        let light = (2.0 * facing * half - eye).z;
        if light <= 0.0 {
            continue;
        }
        // The share of light that neither side shadows, of what is seen.
        let left = light * (cosine + shadowing(cosine)) / (light * shadowing(cosine) + cosine * shadowing(light));
        let away = (1.0 - facing).max(0.0).powi(5);
        sums[0] += left * (1.0 - away);
        sums[1] += left * away;
    }
    sums.map(|sum| (sum / f64::from(DIRECTIONS * DIRECTIONS)) as f32)
}
