//! From linear radiance to the codes of a file that is looked at: exposure, view, transfer function, rounding.
//!
//! OpenEXR files are not touched by any of this.

mod agx;
mod curve;
mod dither;
mod neutral;
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
                let [left, top] = frame.window().first;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(display: Display, frame: &Frame) -> Vec<u8> {
        display.encode(frame)
    }

    fn grey(width: u32, height: u32, value: impl Fn(u32) -> f32) -> Frame {
        Frame::new(width, height, (0..width * height).map(|pixel| [value(pixel); 3]).collect()).unwrap()
    }

    #[test]
    fn dithering_keeps_whole_codes_and_the_mean_of_others() {
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            let display = Display::default().with_transfer(transfer).with_dither(true);
            let codes = grey(256, 64, |pixel| transfer.decode((pixel % 256) as u8));
            assert_eq!(encoded(display, &codes), encoded(display.with_dither(false), &codes), "{transfer}");
            let between = grey(64, 64, |_| (transfer.decode(99) + 3.0 * transfer.decode(100)) / 4.0);
            let bytes = encoded(display, &between);
            let mean = bytes.iter().map(|&code| f64::from(code)).sum::<f64>() / bytes.len() as f64;
            assert!(
                (mean - 99.75).abs() < 0.02 && bytes.iter().all(|&code| code == 99 || code == 100),
                "{transfer} {mean}"
            );
        }
    }

    #[test]
    fn dithering_does_not_colour_greys() {
        let bytes = encoded(Display::default().with_dither(true), &grey(97, 31, |pixel| pixel as f32 / 3007.0));
        assert!(bytes.chunks(3).all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]));
    }

    #[test]
    fn every_view_is_monotonous_and_shows_no_colour_in_greys() {
        for &view in View::ALL {
            let greys: Vec<f32> = (0..4000).map(|step| ((step - 2400) as f32 / 100.0).exp2()).collect();
            let shown: Vec<[f32; 3]> = greys.iter().map(|&grey| view.apply([grey; 3])).collect();
            assert!(shown.windows(2).all(|pair| pair[0][1] <= pair[1][1] + 1e-7), "{view}");
            assert!(
                shown
                    .iter()
                    .all(|[r, g, b]| (r - g).abs() <= 1e-5 * g.max(1e-3) && (b - g).abs() <= 1e-5 * g.max(1e-3)),
                "{view}"
            );
        }
    }

    #[test]
    fn no_view_shows_what_is_no_number() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-42, f32::MAX, 0.5];
        for &view in View::ALL {
            let channels = |number: usize| [1, 9, 81].map(|place| odd[number / place % 9]);
            for [r, g, b] in (0..729).map(channels) {
                let shown = view.apply([r, g, b]);
                let valid = |value: f32| (0.0..=1.0).contains(&value);
                assert!(view == View::Standard || shown.into_iter().all(valid), "{view} [{r}, {g}, {b}]: {shown:?}");
            }
            assert_eq!(view.apply([0.0; 3]), [0.0; 3], "{view}");
        }
        let frame = Frame::new(2, 1, vec![[f32::NAN, f32::INFINITY, -1.0]; 2]).unwrap();
        for depth in [BitDepth::Eight, BitDepth::Sixteen] {
            let bytes = encoded(Display::default().with_bit_depth(depth).with_dither(true), &frame);
            let size = usize::from(depth.bits() / 8);
            assert_eq!(bytes[..3 * size], [[0; 2], [255; 2], [0; 2]].map(|code| code[..size].to_vec()).concat());
        }
    }

    #[test]
    fn exposure_comes_before_the_view() {
        let display = Display::default().with_exposure(-2.0).with_view(View::Neutral);
        assert_eq!(display.show([2.0, 1.2, 0.4]), View::Neutral.apply([0.5, 0.3, 0.1]));
        let frame = Frame::new(1, 1, vec![[2.0, 1.2, 0.4]]).unwrap();
        assert_eq!(encoded(display, &frame), display.show([2.0, 1.2, 0.4]).map(|value| Transfer::Srgb.encode(value)));
    }

    #[test]
    fn colours_are_divided_by_alpha() {
        let frame = Frame::new(3, 1, vec![[0.25, 0.5, 0.0], [0.0; 3], [1.0; 3]]).unwrap();
        let frame = frame.with_alpha(vec![0.5, 0.0, 1.0]).unwrap();
        let display = Display::default().with_transfer(Transfer::Linear);
        assert_eq!(encoded(display, &frame), [128, 255, 0, 128, 0, 0, 0, 0, 255, 255, 255, 255]);
        assert_eq!(display.pixel_bytes(&frame), 4);
        let wide = encoded(display.with_bit_depth(BitDepth::Sixteen), &frame);
        assert_eq!(wide[..8], [128, 0, 255, 255, 0, 0, 128, 0]);
    }
}
