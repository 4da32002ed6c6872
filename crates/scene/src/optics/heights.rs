//! Images of heights to images of normals.
//!
//! Files say how much heights are multiplied with, but not their unit. Here white is as much higher than black as a hundredth of the image's
//! width, so that what an image shows does not depend on its resolution; texels are squares. Slopes are half the differences of the
//! neighbours on both sides.

use crate::Texture;

/// The difference in height between white and black, in widths of the image.
const HEIGHT: f32 = 0.01;
/// The code of 0 in an image of normals, and what is 1 above it.
const ZERO: f32 = 128.0;
const ONE: f32 = 127.0;
/// Grey images may have this difference between channels, in most of their texels: JPEG rounds them.
const MAX_APART: u8 = 12;

/// Whether an image has no colours, so that it may be one of heights: normals are blue.
pub fn is_grey(texture: &Texture) -> bool {
    let grey = |&&[r, g, b, _]: &&[u8; 4]| r.max(g).max(b) - r.min(g).min(b) <= MAX_APART;
    2 * texture.texels.iter().filter(grey).count() >= texture.texels.len()
}

/// The normals of a surface with these heights. `clamp`: the image ends at its edges; else it is repeated.
pub fn normals_of_heights(heights: &Texture, clamp: bool) -> Texture {
    let [width, height] = heights.size;
    let unit = HEIGHT * width as f32 / f32::from(u8::MAX);
    let at = |column: u32, row: u32| {
        let [r, g, b, _] = heights.texels[row as usize * width as usize + column as usize];
        f32::from(u16::from(r) + u16::from(g) + u16::from(b)) / 3.0
    };
    let around = |place: u32, side: u32| match clamp {
        true => [place.saturating_sub(1), (place + 1).min(side - 1)],
        false => [(place + side - 1) % side, (place + 1) % side],
    };
    let normal = |index: u32| {
        let (column, row) = (index % width, index / width);
        let ([left, right], [above, below]) = (around(column, width), around(row, height));
        let slope = |low: f32, high: f32| 0.5 * unit * (high - low);
        let (x, y) = (-slope(at(left, row), at(right, row)), slope(at(column, above), at(column, below)));
        let length = (x * x + y * y + 1.0).sqrt();
        let [r, g, b] = [x, y, 1.0].map(|axis| (ZERO + ONE * axis / length).round() as u8);
        [r, g, b, u8::MAX]
    };
    let name = format!("{} as normals", heights.name);
    Texture { name, size: heights.size, texels: (0..width * height).map(normal).collect() }
}
