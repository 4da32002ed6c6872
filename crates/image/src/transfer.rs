//! Transfer functions between linear values and the 8-bit codes of image files.
//!
//! [`Transfer::Srgb`] is the piecewise curve of IEC 61966-2-1, not its approximation by a power of 2.2. Decoding and the
//! thresholds for encoding are computed in double precision, so a value gets the code nearest to its encoded value and all 256
//! codes survive a round trip.

use std::fmt;
use std::str::FromStr;
use std::sync::LazyLock;

use crate::display::Curve;

/// How an 8-bit file encodes linear values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Transfer {
    /// The curve of IEC 61966-2-1, which screens and image viewers expect.
    #[default]
    Srgb,
    /// Codes proportional to the linear value, for measurements.
    Linear,
}

/// Below this, the sRGB curve is a straight line.
const SRGB_KNEE: f64 = 0.003_130_8;

/// The sRGB curve above the line.
static SRGB_CURVE: LazyLock<Curve> = LazyLock::new(|| Curve::new(1.0 / 512.0, 1.0, linear_to_srgb));

/// The linear values of the sRGB codes.
pub static SRGB_DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| srgb_to_linear(code as f64 / 255.0) as f32));

/// The linear value above which code `i + 1` is nearer than code `i`: the curve half-way between the two.
pub static SRGB_THRESHOLDS: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|code| srgb_to_linear((code as f64 + 0.5) / 255.0) as f32));

/// The smallest magnitude whose code is looked up, 2⁻¹³; what is below has code 0.
pub const SMALLEST: f32 = 1.0 / 8192.0;
/// Bits of a float that are ignored to look up its code: what remains divides each power of two in 128.
pub const IGNORED: u32 = 16;

/// Number of ranges between [`SMALLEST`] and 1.
const RANGES: usize = 13 << (23 - IGNORED);

/// The code of the beginning of each range, and the thresholds, after which none follows.
struct SrgbCodes {
    starts: [u8; RANGES],
    next: [f32; 256],
}

/// No range has two thresholds, as the closest ones, near 1, differ by 0.9 %.
static SRGB_CODES: LazyLock<SrgbCodes> = LazyLock::new(|| SrgbCodes {
    starts: std::array::from_fn(|range| exceeded(f32::from_bits(SMALLEST.to_bits() + ((range as u32) << IGNORED)))),
    next: std::array::from_fn(|code| SRGB_THRESHOLDS.get(code).copied().unwrap_or(f32::NAN)),
});

/// Number of thresholds that a value has reached.
pub fn exceeded(linear: f32) -> u8 {
    SRGB_THRESHOLDS.partition_point(|&threshold| linear >= threshold) as u8
}

impl SrgbCodes {
    /// The code nearest to `linear` on the sRGB curve.
    #[inline]
    fn code(&self, linear: f32) -> u8 {
        // NaN becomes the smallest value.
        let value = linear.max(SMALLEST).min(1.0_f32.next_down());
        let code = self.starts[((value.to_bits() - SMALLEST.to_bits()) >> IGNORED) as usize];
        code + u8::from(value >= self.next[usize::from(code)])
    }
}

/// A word that is not the name of a transfer function.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown transfer function `{0}`; available: srgb, linear")]
pub struct UnknownTransfer(pub String);

impl Transfer {
    /// All transfer functions.
    pub const ALL: &'static [Transfer] = &[Transfer::Srgb, Transfer::Linear];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Linear => "linear",
        }
    }

    /// A short description of its purpose.
    pub fn help(self) -> &'static str {
        match self {
            Self::Srgb => "For screens",
            Self::Linear => "For measuring",
        }
    }

    /// The code nearest to `linear` on this curve. Values outside of [0, 1] are clamped; NaN becomes 0.
    pub fn encode(self, linear: f32) -> u8 {
        match self {
            Self::Srgb => SRGB_CODES.code(linear),
            // In f64 the product is exact; the cast saturates and turns NaN into 0.
            Self::Linear => (f64::from(linear) * 255.0 + 0.5) as u8,
        }
    }

    /// The linear value in [0, 1] of `code`.
    pub fn decode(self, code: u8) -> f32 {
        match self {
            Self::Srgb => SRGB_DECODED[usize::from(code)],
            Self::Linear => f32::from(code) / 255.0,
        }
    }

    /// The linear value of a 16-bit `code` in 0..=65535.
    pub(crate) fn decode16(self, code: u16) -> f32 {
        let value = f64::from(code) / 65535.0;
        match self {
            Self::Srgb => srgb_to_linear(value) as f32,
            Self::Linear => value as f32,
        }
    }

    /// The 16-bit code nearest to `linear`.
    pub(crate) fn encode16(self, linear: f32) -> u16 {
        (self.encoded(linear) * 65535.0 + 0.5) as u16
    }

    /// The code below or above `linear`, whichever `threshold` between 0 and 1 decides; the mean of many thresholds is the value.
    pub(crate) fn encode_between(self, linear: f32, threshold: f32) -> u8 {
        (self.encoded(linear) * 255.0 + threshold) as u8
    }

    /// The display value in [0, 1], accurate to 10⁻⁵ of it; that of NaN is 0.
    #[expect(clippy::manual_clamp, reason = "NaN becomes 0")]
    fn encoded(self, linear: f32) -> f32 {
        let linear = linear.max(0.0).min(1.0);
        match self {
            Self::Srgb if linear <= SRGB_KNEE as f32 => 12.92 * linear,
            Self::Srgb => SRGB_CURVE.at(linear),
            Self::Linear => linear,
        }
    }

    /// Appends the codes of `colors` to `bytes`, red first.
    pub(crate) fn encode_into(self, colors: &[[f32; 3]], bytes: &mut Vec<u8>) {
        let values = colors.as_flattened().iter();
        match self {
            Self::Srgb => {
                let codes = &*SRGB_CODES;
                bytes.extend(values.map(|&value| codes.code(value)));
            }
            Self::Linear => bytes.extend(values.map(|&value| self.encode(value))),
        }
    }
}

impl fmt::Display for Transfer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Transfer {
    type Err = UnknownTransfer;

    fn from_str(name: &str) -> Result<Transfer, UnknownTransfer> {
        let found = Transfer::ALL.iter().find(|transfer| transfer.name() == name);
        found.copied().ok_or_else(|| UnknownTransfer(name.to_owned()))
    }
}

/// The sRGB curve: a linear value in [0, 1] to its display value in [0, 1].
pub fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= SRGB_KNEE { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`linear_to_srgb`].
fn srgb_to_linear(display: f64) -> f64 {
    if display <= 0.040_45 { display / 12.92 } else { ((display + 0.055) / 1.055).powf(2.4) }
}
