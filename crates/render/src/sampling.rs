//! End points of the shadow rays towards an area light: stratified points on or in the light.
//!
//! Points are an Owen-scrambled Sobol sequence (Burley: *Practical Hash-based Owen Scrambling*, JCGT 2020): any first N of them
//! are well distributed, and each surface point or light point gets its own scrambling from a hash, so that errors do not form
//! patterns and the result depends on the seed alone.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, u32x8};
use glam::Vec3;
use lightmesh_layout::constants::{
    BEFORE_BODY, GOLDEN_RATIO, LAST_DIGIT, MIX_1, MIX_2, OWEN_1, OWEN_2, OWEN_3, OWEN_4, SAMPLE_DIGITS, UPPER_BITS,
    UPPER_BYTES, UPPER_NIBBLES, UPPER_PAIRS,
};
use lightmesh_scene::{Light, LightKind};

/// A stream of stratified points in the unit cube, different for each key.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    seeds: [u32; 4],
}

impl Pattern {
    /// The pattern that belongs to `key` (a pixel or light point), light number `light` and the user's `seed`.
    #[inline(always)]
    pub fn new(seed: u64, key: u64, light: usize) -> Pattern {
        let base = random_bits(seed, key, light);
        let word = |i: u64| mix(base.wrapping_add(i)) as u32;
        Pattern { seeds: [word(0), word(1), word(2), word(3)] }
    }

    /// Point `index` of the sequence, each component in [0, 1).
    #[inline(always)]
    pub fn point(&self, index: u32) -> Vec3 {
        let index = scramble(index.reverse_bits(), self.seeds[0]).reverse_bits();
        let first_digits = |digits: u32| digits.reverse_bits() >> (u32::BITS - SAMPLE_DIGITS);
        let axis = |digits: u32, seed: u32| first_digits(scramble(digits, seed)) as f32 * LAST_DIGIT;
        Vec3::new(axis(index, self.seeds[1]), axis(sobol_1(index), self.seeds[2]), axis(sobol_2(index), self.seeds[3]))
    }

    /// The first two components of eight points, the same bits as [`Pattern::point`].
    #[inline(always)]
    pub(crate) fn planar_points<S: Simd>(&self, simd: S, index: u32x8<S>) -> [f32x8<S>; 2] {
        let index = reversed(simd, scrambled(simd, reversed(simd, index), self.seeds[0]));
        let second = second_dimension(simd, index);
        [first_digits(simd, index, self.seeds[1]), first_digits(simd, second, self.seeds[2])]
    }
}

#[inline(always)]
fn first_digits<S: Simd>(simd: S, digits: u32x8<S>, seed: u32) -> f32x8<S> {
    let first = reversed(simd, scrambled(simd, digits, seed)) >> (u32::BITS - SAMPLE_DIGITS);
    first.to_float::<f32x8<S>>() * f32x8::splat(simd, LAST_DIGIT)
}

/// [`u32::reverse_bits`]
#[inline(always)]
fn reversed<S: Simd>(simd: S, digits: u32x8<S>) -> u32x8<S> {
    let swap = |digits: u32x8<S>, upper: u32, shift: u32| {
        let upper = u32x8::splat(simd, upper);
        (digits & upper) >> shift | (digits << shift) & upper
    };
    let digits = swap(digits, UPPER_BITS, 1);
    let digits = swap(digits, UPPER_PAIRS, 2);
    let digits = swap(digits, UPPER_NIBBLES, 4);
    let digits = swap(digits, UPPER_BYTES, 8);
    digits >> 16 | digits << 16
}

/// [`scramble`]
#[inline(always)]
fn scrambled<S: Simd>(simd: S, digits: u32x8<S>, seed: u32) -> u32x8<S> {
    let mut x = digits + u32x8::splat(simd, seed);
    x = x ^ (x * u32x8::splat(simd, OWEN_1));
    x = x ^ (x * u32x8::splat(simd, OWEN_2));
    x = x ^ (x * u32x8::splat(simd, OWEN_3));
    x ^ (x * u32x8::splat(simd, OWEN_4))
}

/// [`sobol_1`]
#[inline(always)]
fn second_dimension<S: Simd>(simd: S, index: u32x8<S>) -> u32x8<S> {
    let mut digits = index;
    digits = digits ^ digits >> 16;
    digits = digits ^ (digits & u32x8::splat(simd, UPPER_BYTES)) >> 8;
    digits = digits ^ (digits & u32x8::splat(simd, UPPER_NIBBLES)) >> 4;
    digits = digits ^ (digits & u32x8::splat(simd, UPPER_PAIRS)) >> 2;
    digits ^ (digits & u32x8::splat(simd, UPPER_BITS)) >> 1
}

/// Random bits of `key` (a pixel or light point), light number `light` and the user's `seed`.
#[inline(always)]
pub(crate) fn random_bits(seed: u64, key: u64, light: usize) -> u64 {
    mix(seed ^ mix(key ^ mix(light as u64 + 1)))
}

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
#[inline(always)]
fn mix(value: u64) -> u64 {
    let value = value.wrapping_add(GOLDEN_RATIO);
    let value = (value ^ (value >> 30)).wrapping_mul(MIX_1);
    let value = (value ^ (value >> 27)).wrapping_mul(MIX_2);
    value ^ (value >> 31)
}

// Here the first binary digit after the point is the least significant bit. So the first dimension of Sobol's sequence, van der
// Corput's, is the index itself.

/// Owen scrambling of binary digits (Laine and Karras 2011).
#[inline(always)]
fn scramble(digits: u32, seed: u32) -> u32 {
    let mut x = digits.wrapping_add(seed);
    x ^= x.wrapping_mul(OWEN_1);
    x ^= x.wrapping_mul(OWEN_2);
    x ^= x.wrapping_mul(OWEN_3);
    x ^= x.wrapping_mul(OWEN_4);
    x
}

/// Second dimension of Sobol's sequence: a bit j of the index adds the polynomial (1 + x)^j over GF(2), whose coefficients are the
/// digits. That is the polynomial of the index at 1 + x, and (1 + x)^k = 1 + x^k where k is a power of two.
#[inline(always)]
pub fn sobol_1(index: u32) -> u32 {
    let mut digits = index;
    digits ^= digits >> 16;
    digits ^= (digits & UPPER_BYTES) >> 8;
    digits ^= (digits & UPPER_NIBBLES) >> 4;
    digits ^= (digits & UPPER_PAIRS) >> 2;
    digits ^= (digits & UPPER_BITS) >> 1;
    digits
}

/// Third dimension of Sobol's sequence: the digits that each byte of the index adds.
#[inline(always)]
pub fn sobol_2(index: u32) -> u32 {
    let [a, b, c, d] = index.to_le_bytes().map(usize::from);
    SOBOL_2[0][a] ^ SOBOL_2[1][b] ^ SOBOL_2[2][c] ^ SOBOL_2[3][d]
}

static SOBOL_2: [[u32; 256]; 4] = sobol_2_by_bytes();

/// From the primitive polynomial x² + x + 1 with initial numbers 1, 3.
const fn sobol_2_by_bytes() -> [[u32; 256]; 4] {
    let mut table = [[0; 256]; 4];
    let (mut direction, mut next) = (1u32, 3u32);
    let mut bit = 0;
    while bit < 32 {
        let (byte, place) = (bit / 8, 1 << (bit % 8));
        let mut value = 0;
        while value < 256 {
            if value & place != 0 {
                table[byte][value] ^= direction;
            }
            value += 1;
        }
        // v_i = v_(i−1) ⊕ v_(i−2) ⊕ (v_(i−2) two digits further)
        (direction, next) = (next, next ^ direction ^ (direction << 2));
        bit += 1;
    }
    table
}

/// The point of `light` that the numbers `u` in [0, 1)³ select; a directional light lies `reach` away from `from`.
///
/// A ball is sampled uniformly in its volume, as the thesis distributes its point lights; disks, among them that of a directional light,
/// and rectangles are sampled uniformly.
#[inline(always)]
pub fn light_point(light: &Light, from: Vec3, reach: f32, u: Vec3) -> Vec3 {
    match light.kind {
        LightKind::Point { position, spread } => position + spread * in_ball(u),
        LightKind::Sphere { position, radius } | LightKind::Spot { position, radius, .. } => {
            position + radius * in_ball(u)
        }
        LightKind::Directional { direction, angle } => {
            from - reach * direction + in_disk(direction, reach * disk_radius(angle), u)
        }
        LightKind::Disk { position, normal, radius } => position + in_disk(normal, radius, u),
        LightKind::Rectangle { position, half_u, half_v } => {
            position + (2.0 * u.x - 1.0) * half_u + (2.0 * u.y - 1.0) * half_v
        }
    }
}

/// The centre of `light`; a directional light lies `reach` away from `from`.
#[inline(always)]
pub fn light_center(light: &Light, from: Vec3, reach: f32) -> Vec3 {
    match light.kind {
        LightKind::Directional { direction, .. } => from - reach * direction,
        _ => light.position().unwrap_or(from),
    }
}

/// The radius of an emissive ball that `light` stands for, which hides none of its light; 0 if there is none.
#[inline(always)]
pub(crate) fn body(light: &Light) -> f32 {
    match light.kind {
        LightKind::Sphere { radius, .. } if light.lamp => radius,
        _ => 0.0,
    }
}

/// Where a shadow ray from `from` to a point of `light` ends: there, or, if that is an emissive ball, in the plane that touches the ball where it is
/// nearest. The ball covers the same directions there, and lies behind.
#[inline(always)]
pub(crate) fn before_body(light: &Light, from: Vec3, target: Vec3) -> Vec3 {
    let body = body(light);
    if body == 0.0 {
        return target;
    }
    let (way, to) = (light_center(light, from, 0.0) - from, target - from);
    let distance = way.length();
    let near = (distance - body).max(BEFORE_BODY * distance) * distance;
    let along = way.dot(to);
    if along > near { from + near / along * to } else { target }
}

/// The centre of what is seen of a light from `from`, if a directional one is `reach` away: shadow rays end in a plane through it.
#[inline(always)]
pub(crate) fn seen_center(light: &Light, from: Vec3, reach: f32) -> Vec3 {
    before_body(light, from, light_center(light, from, reach))
}

/// The radius of the disc that an emissive ball of the radius `body` covers in that plane, at the distance `near`.
#[inline(always)]
pub(crate) fn covered_by_body(body: f32, near: f32) -> f32 {
    body * (near / (near + 2.0 * body)).sqrt()
}

/// The radius of the disk that a directional light of this angular diameter comes from, at distance 1.
#[inline(always)]
pub fn disk_radius(angle: f32) -> f32 {
    // Kernels tell by it whether the light has a size, so that it is above 0 exactly if the light has one.
    if angle > 0.0 { (0.5 * angle).tan().max(f32::MIN_POSITIVE) } else { 0.0 }
}

/// An area-preserving map from the square to a disk about the origin.
#[inline(always)]
fn in_disk(normal: Vec3, radius: f32, u: Vec3) -> Vec3 {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let (sin, cos) = (std::f32::consts::TAU * u.x).sin_cos();
    radius * u.y.sqrt() * (cos * tangent + sin * bitangent)
}

/// A volume-preserving map from the cube to the unit ball.
#[inline(always)]
pub fn in_ball(u: Vec3) -> Vec3 {
    let z = 2.0 * u.x - 1.0;
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    let ring = (1.0 - z * z).max(0.0).sqrt();
    u.z.cbrt() * Vec3::new(ring * cos, ring * sin, z)
}
