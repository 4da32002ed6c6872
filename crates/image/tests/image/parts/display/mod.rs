mod agx;
mod curve;
mod dither;
mod neutral;
mod view;

use lightmesh_image::internals::display::pixel_bytes;
use lightmesh_image::{BitDepth, Display, Frame, Transfer, View};

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
            shown.iter().all(|[r, g, b]| (r - g).abs() <= 1e-5 * g.max(1e-3) && (b - g).abs() <= 1e-5 * g.max(1e-3)),
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
    assert_eq!(pixel_bytes(&display, &frame), 4);
    let wide = encoded(display.with_bit_depth(BitDepth::Sixteen), &frame);
    assert_eq!(wide[..8], [128, 0, 255, 255, 0, 0, 128, 0]);
}
