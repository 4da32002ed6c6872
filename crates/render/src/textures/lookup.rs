//! What a footprint sees of a texture. Twin: `lookup.cuh`.
//!
//! 1. Where a clamped texture ends, so does the footprint. Its two axes, in texels, are conjugate diameters of an ellipse; its principal axes
//!    follow from them: their squares are the eigenvalues of J Jᵀ, if the columns of J are the axes.
//! 2. A footprint that is no longer than a texel is magnified: the four nearest texels of the image are interpolated bilinearly.
//! 3. Longer ones are averaged along their major axis by up to 16 probes, each as wide as the minor axis (McCormack, Perry, Farkas, Jouppi:
//!    *Feline: Fast Elliptical Lines for Anisotropic Texture Mapping*, SIGGRAPH 1999). Those that are longer than 16 times their width
//!    count as wider.
//! 4. A probe is interpolated trilinearly between the levels whose texels are just smaller and just larger than it is wide (Williams:
//!    *Pyramidal Parametrics*, SIGGRAPH 1983): linearly in its width, whose exponent is the level, instead of in the logarithm, which devices
//!    round differently.

use glam::{Vec2, Vec3};
use lightmesh_layout::constants::{F32_EXPONENT_BIAS, F32_EXPONENT_STEP, MAX_PROBES};
use lightmesh_scene::Wrap;
use lightmesh_trace::textures::neighbours;

use super::levels::unpacked;
use super::{Image, MipLevels};

/// The mean of what the ellipse with these axes around `place` sees, in coordinates of the image: (0, 0) is its upper left corner, (1, 1)
/// its lower right one. Axes are whole ones, conjugate diameters.
pub fn filtered(image: &Image, levels: &MipLevels, place: Vec2, axes: [Vec2; 2]) -> Vec3 {
    let (size, wrap) = (image.texture.size, image.uses.wrap);
    // 1. The ellipse in texels: half the sum and half the difference of the eigenvalues.
    let size = Vec2::new(size[0] as f32, size[1] as f32);
    let [x, y] = [0, 1].map(|axis| Clipped::new(wrap[axis], place[axis], [axes[0][axis], axes[1][axis]]));
    let [a, b] = axes.map(|axis| axis * Vec2::new(x.share, y.share) * size);
    let (xx, yy, xy) = (a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y, a.x * a.y + b.x * b.y);
    let (middle, aside) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let apart = (aside * aside + xy * xy).sqrt();
    let major = (middle + apart).sqrt();

    // 2. Magnified.
    if major <= 1.0 {
        return sampled(image, place);
    }
    // A footprint beyond all numbers sees everything, the only texel of the last level.
    let lower = levels.levels.len() as u32;
    if !major.is_finite() {
        return at_level(image, levels, place, lower);
    }

    // 3. Probes along the major axis.
    let narrowest = (major / MAX_PROBES as f32).max(1.0);
    let minor = (middle - apart).max(0.0).sqrt().max(narrowest);
    let count = (major / minor).ceil().min(MAX_PROBES as f32);
    let along = if aside > 0.0 { Vec2::new(aside + apart, xy) } else { Vec2::new(xy, apart - aside) };
    let length = along.length();
    let axis = if length > 0.0 { (major / length) * along / size } else { Vec2::ZERO };
    let (level, share) = level_of(minor, lower);
    let middle = Vec2::new(x.middle, y.middle);
    let mut sum = Vec3::ZERO;
    for probe in 0..count as u32 {
        let at = middle + ((probe as f32 + 0.5) / count - 0.5) * axis;

        // 4. Between two levels.
        let fine = at_level(image, levels, at, level);
        let coarse = if share > 0.0 { at_level(image, levels, at, level + 1) } else { fine };
        sum += between(fine, coarse, share);
    }
    sum / count
}

/// The part of a footprint inside of the image, along one axis.
struct Clipped {
    /// Its share of the whole.
    share: f32,
    /// Its middle.
    middle: f32,
}

impl Clipped {
    /// That of a footprint around `place` with these diameters. Beyond the border of a clamped texture all is as at the border: what lies there
    /// has no extent. Others have no border.
    #[inline(always)]
    #[expect(clippy::manual_clamp, reason = "NaN becomes 0, as on devices")]
    fn new(wrap: Wrap, place: f32, diameters: [f32; 2]) -> Clipped {
        let reach = 0.5 * (diameters[0].abs() + diameters[1].abs());
        let (low, high) = (place - reach, place + reach);
        if wrap != Wrap::Clamp || reach == 0.0 || low >= 0.0 && high <= 1.0 {
            return Clipped { share: 1.0, middle: place };
        }
        let (low, high) = (low.max(0.0).min(1.0), high.max(0.0).min(1.0));
        Clipped { share: 0.5 * (high - low) / reach, middle: 0.5 * (low + high) }
    }
}

/// The level whose texels are the largest that are not wider than `width` texels of the image, at least 1, and the fraction of the way to the
/// next one. There are `lower` levels below the image.
#[inline(always)]
pub fn level_of(width: f32, lower: u32) -> (u32, f32) {
    let bits = width.to_bits();
    let level = bits / F32_EXPONENT_STEP - F32_EXPONENT_BIAS;
    if level >= lower {
        return (lower, 0.0);
    }
    let mantissa = f32::from_bits(bits % F32_EXPONENT_STEP + F32_EXPONENT_BIAS * F32_EXPONENT_STEP);
    (level, mantissa - 1.0)
}

/// The value of a level at `place`.
#[inline(always)]
pub fn at_level(image: &Image, levels: &MipLevels, place: Vec2, level: u32) -> Vec3 {
    if level == 0 {
        return sampled(image, place);
    }
    let level = &levels.levels[level as usize - 1];
    bilinear(level.size, image.uses.wrap, place, |index| unpacked(level.texels[index]))
}

/// The image's value at `place`.
pub fn sampled(&Image { uses, texture, encoding }: &Image, place: Vec2) -> Vec3 {
    bilinear(texture.size, uses.wrap, place, |index| encoding.linear(texture.texels[index]))
}

/// The four nearest of the texels of an image of this size, interpolated.
#[inline(always)]
pub(crate) fn bilinear(size: [u32; 2], wrap: [Wrap; 2], place: Vec2, texel: impl Fn(usize) -> Vec3) -> Vec3 {
    let (columns, x) = neighbours(place.x, size[0], wrap[0]);
    let (rows, y) = neighbours(place.y, size[1], wrap[1]);
    let texel = |column: u32, row: u32| texel(row as usize * size[0] as usize + column as usize);
    let [upper, lower] = rows.map(|row| between(texel(columns[0], row), texel(columns[1], row), x));
    between(upper, lower, y)
}

/// From `a` to `b`; exactly `a` where both are the same.
pub(crate) fn between(a: Vec3, b: Vec3, share: f32) -> Vec3 {
    a + share * (b - a)
}
