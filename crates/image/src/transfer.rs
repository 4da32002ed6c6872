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
static SRGB_DECODED: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| srgb_to_linear(code as f64 / 255.0) as f32));

/// The linear value above which code `i + 1` is nearer than code `i`: the curve half-way between the two.
static SRGB_THRESHOLDS: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|code| srgb_to_linear((code as f64 + 0.5) / 255.0) as f32));

/// The smallest magnitude whose code is looked up, 2⁻¹³; what is below has code 0.
const SMALLEST: f32 = 1.0 / 8192.0;
/// Bits of a float that are ignored to look up its code: what remains divides each power of two in 128.
const IGNORED: u32 = 16;

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
fn exceeded(linear: f32) -> u8 {
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
pub(crate) fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= SRGB_KNEE { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`linear_to_srgb`].
fn srgb_to_linear(display: f64) -> f64 {
    if display <= 0.040_45 { display / 12.92 } else { ((display + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_of_srgb() {
        // Middle grey of 18 % is display value 0.4613561; code 128 is 21.586 %; code 10 lies on the straight part.
        assert!((linear_to_srgb(0.18) - 0.461_356_1).abs() < 1e-6);
        assert!((Transfer::Srgb.decode(128) - 0.215_860_5).abs() < 1e-6);
        assert!((Transfer::Srgb.decode(10) - 10.0 / 255.0 / 12.92).abs() < 1e-9);
        assert_eq!((Transfer::Srgb.decode(0), Transfer::Srgb.decode(255)), (0.0, 1.0));
        assert_eq!((Transfer::Srgb.encode(0.18), Transfer::Srgb.encode(0.5)), (118, 188));
    }

    #[test]
    fn names_are_read_and_written() {
        Transfer::ALL.iter().for_each(|transfer| assert_eq!(transfer.to_string().parse(), Ok(*transfer)));
        let message = "gamma".parse::<Transfer>().unwrap_err().to_string();
        assert!(Transfer::ALL.iter().all(|transfer| message.contains(transfer.name())), "{message}");
    }

    #[test]
    fn both_parts_of_srgb_meet() {
        let (below, above) = (linear_to_srgb(0.003_130_8), linear_to_srgb(0.003_130_801));
        assert!((below - above).abs() < 1e-6, "{below} {above}");
    }

    #[test]
    fn every_code_survives_a_round_trip() {
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            for code in 0..=255 {
                assert_eq!(transfer.encode(transfer.decode(code)), code, "{transfer:?}");
                let wide = transfer.decode16(u16::from(code) * 257);
                assert!((wide - transfer.decode(code)).abs() < 1e-7, "{transfer:?} {code}");
                assert!(
                    [0.002, 0.5, 0.998]
                        .into_iter()
                        .all(|part| transfer.encode_between(transfer.decode(code), part) == code)
                );
            }
            assert!((0..=u16::MAX).all(|code| transfer.encode16(transfer.decode16(code)) == code), "{transfer:?}");
        }
    }

    #[test]
    fn encoding_rounds_to_the_nearest_code() {
        for step in 0..=100_000 {
            let linear = step as f32 / 100_000.0;
            let srgb = linear_to_srgb(f64::from(linear)) * 255.0;
            let off = (f64::from(Transfer::Srgb.encode(linear)) - srgb).abs();
            assert!(off <= 0.5 + 1e-5, "{linear}: off by {off} codes");
            let off = (f64::from(Transfer::Linear.encode(linear)) - f64::from(linear) * 255.0).abs();
            assert!(off <= 0.5, "{linear}: off by {off} codes");
        }
    }

    #[test]
    fn codes_are_those_of_the_thresholds() {
        let check = |value: f32| assert_eq!(Transfer::Srgb.encode(value), exceeded(value), "{value:e}");
        for value in SRGB_THRESHOLDS.iter().chain(&*SRGB_DECODED).copied() {
            [value.next_down(), value, value.next_up()].into_iter().for_each(check);
        }
        // The first and last value of every range that is looked up.
        for range in SMALLEST.to_bits() >> IGNORED..=1_f32.to_bits() >> IGNORED {
            let start = f32::from_bits(range << IGNORED);
            [start.next_down(), start].into_iter().for_each(check);
        }
        for (below, above) in SRGB_THRESHOLDS.iter().zip(&SRGB_THRESHOLDS[1..]) {
            assert!(below.to_bits() >> IGNORED < above.to_bits() >> IGNORED, "{below} and {above} are in one range");
        }
    }

    #[test]
    fn values_out_of_range_are_clamped() {
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            for low in [-0.0, -1e-9, -3.0, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
                assert_eq!(transfer.encode(low), 0, "{transfer:?} {low}");
            }
            for high in [1.0, 1.000_1, 1e30, f32::INFINITY] {
                assert_eq!(transfer.encode(high), 255, "{transfer:?} {high}");
            }
        }
    }
}
