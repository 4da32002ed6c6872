//! From linear radiance to the codes of a file that is looked at: exposure, view, transfer function, rounding.
//!
//! OpenEXR files are not touched by any of this.

pub(crate) mod agx;
pub(crate) mod curve;
pub(crate) mod dither;
pub(crate) mod neutral;
mod view;

use std::borrow::Cow;

pub(crate) use curve::Curve;
pub use view::{UnknownView, View};

use crate::{Frame, Transfer};

/// Bits per channel of png files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BitDepth {
    /// 256 codes: what screens show.
    #[default]
    Eight,
    /// 65536 codes: for further grading.
    Sixteen,
}

impl BitDepth {
    /// Number of bits.
    pub fn bits(self) -> u8 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

/// How bmp, png and jpg files show linear colours. By default, codes are nearest to the values, with the sRGB curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Display {
    /// How much brighter the image is shown, in stops.
    pub exposure: f32,
    /// What brings the range of the scene into that of the screen.
    pub view: View,
    /// How codes encode what is shown.
    pub transfer: Transfer,
    /// Bits per channel.
    pub bit_depth: BitDepth,
    /// Whether 8-bit codes are rounded up or down by a pattern that is nearly blue noise, so that smooth gradients have no bands. Values that
    /// are exactly a code, such as black and white, stay as they are.
    pub dither: bool,
}

impl Display {
    /// Shows the image brighter, by a number of stops.
    pub fn with_exposure(self, exposure: f32) -> Self {
        Self { exposure, ..self }
    }

    /// Sets the view.
    pub fn with_view(self, view: View) -> Self {
        Self { view, ..self }
    }

    /// Sets the transfer function.
    pub fn with_transfer(self, transfer: Transfer) -> Self {
        Self { transfer, ..self }
    }

    /// Sets the number of bits per channel.
    pub fn with_bit_depth(self, bit_depth: BitDepth) -> Self {
        Self { bit_depth, ..self }
    }

    /// Turns dithering on or off.
    pub fn with_dither(self, dither: bool) -> Self {
        Self { dither, ..self }
    }

    /// What a colour is shown as: linear, with white at 1.
    pub fn show(&self, color: [f32; 3]) -> [f32; 3] {
        let factor = self.exposure.exp2();
        self.view.apply(color.map(|channel| channel * factor))
    }

    /// The codes of all pixels, row by row from the top: red, green, blue, and alpha if the frame has it. 16 bits have the high byte first.
    pub fn encode(&self, frame: &Frame) -> Vec<u8> {
        let pixels = frame.width() as usize * frame.height() as usize;
        let mut bytes = Vec::with_capacity(pixels * self.pixel_bytes(frame));
        (0..frame.height() as usize).for_each(|y| self.encode_row(frame, y, &mut bytes));
        bytes
    }

    /// Bytes of a pixel of `frame`.
    pub(crate) fn pixel_bytes(&self, frame: &Frame) -> usize {
        let channels = 3 + usize::from(frame.alpha().is_some());
        channels * usize::from(self.bit_depth.bits() / 8)
    }

    /// Appends the codes of a row: red, green, blue, and alpha if the frame has it. 16 bits have the high byte first.
    pub(crate) fn encode_row(&self, frame: &Frame, y: usize, bytes: &mut Vec<u8>) {
        let alpha = frame.alpha().map(|alpha| &alpha[frame.row_range(y)]);
        let shown = self.shown(frame.row(y), alpha);
        let transfer = self.transfer;
        match (self.bit_depth, self.dither, alpha) {
            (BitDepth::Eight, false, None) => transfer.encode_into(&shown, bytes),
            (BitDepth::Eight, false, _) => put(bytes, &shown, alpha, |_, value| [transfer.encode(value)], narrow),
            (BitDepth::Eight, true, _) => {
                // The pattern goes on beyond the edges of the image.
                let [left, top] = frame.window().first.map(|place| place as u32);
                let threshold = |x: u32| dither::threshold(left.wrapping_add(x), top.wrapping_add(y as u32));
                let code = |x, value| [transfer.encode_between(value, threshold(x))];
                put(bytes, &shown, alpha, code, narrow);
            }
            (BitDepth::Sixteen, ..) => {
                put(bytes, &shown, alpha, |_, value| transfer.encode16(value).to_be_bytes(), wide)
            }
        }
    }

    /// The colours as shown. Colours of a frame with alpha are divided by it: files store them as if each pixel were covered.
    fn shown<'a>(&self, colors: &'a [[f32; 3]], alpha: Option<&[f32]>) -> Cow<'a, [[f32; 3]]> {
        if self.exposure == 0.0 && self.view == View::Standard && alpha.is_none() {
            return Cow::Borrowed(colors);
        }
        let factor = self.exposure.exp2();
        let show = |(x, color): (usize, &[f32; 3])| {
            let factor = match alpha {
                Some(alpha) if alpha[x] > 0.0 => factor / alpha[x],
                Some(_) => 0.0,
                None => factor,
            };
            self.view.apply(color.map(|channel| channel * factor))
        };
        Cow::Owned(colors.iter().enumerate().map(show).collect())
    }
}

/// The 8-bit code of a share; never dithered.
fn narrow(share: f32) -> [u8; 1] {
    [Transfer::Linear.encode(share)]
}

/// The 16-bit code of a share.
fn wide(share: f32) -> [u8; 2] {
    Transfer::Linear.encode16(share).to_be_bytes()
}

/// Appends codes of `N` bytes: those of `code` for the channels of the pixel in column x, and those of `share` for alpha.
fn put<const N: usize>(
    bytes: &mut Vec<u8>,
    shown: &[[f32; 3]],
    alpha: Option<&[f32]>,
    code: impl Fn(u32, f32) -> [u8; N],
    share: impl Fn(f32) -> [u8; N],
) {
    for (x, color) in shown.iter().enumerate() {
        bytes.extend(color.map(|value| code(x as u32, value)).as_flattened());
        if let Some(alpha) = alpha {
            bytes.extend(share(alpha[x]));
        }
    }
}
