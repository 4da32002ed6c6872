//! Images of heights to images of normals.
//!
//! Files say how much heights are multiplied with, but not their unit. Here white is as much higher than black as a hundredth of the image's
//! width, so that what an image shows does not depend on its resolution; texels are squares. Slopes are half the differences of the
//! neighbours on both sides.

use super::Texture;

/// The difference in height between white and black, in widths of the image.
const HEIGHT: f32 = 0.01;
/// The code of 0 in an image of normals, and what is 1 above it.
const ZERO: f32 = 128.0;
const ONE: f32 = 127.0;
/// Grey images may have this difference between channels, in most of their texels: JPEG rounds them.
const MOST_APART: u8 = 12;

/// Whether an image has no colours, so that it may be one of heights: normals are blue.
pub(super) fn is_grey(texture: &Texture) -> bool {
    let grey = |&&[r, g, b, _]: &&[u8; 4]| r.max(g).max(b) - r.min(g).min(b) <= MOST_APART;
    2 * texture.texels.iter().filter(grey).count() >= texture.texels.len()
}

/// The normals of a surface with these heights. `clamp`: the image ends at its edges; else it is repeated.
pub(super) fn normals_of_heights(heights: &Texture, clamp: bool) -> Texture {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(size: [u32; 2], value: impl Fn(u32, u32) -> u8) -> Texture {
        let texel = |index: u32| value(index % size[0], index / size[0]);
        let texels = (0..size[0] * size[1]).map(texel).map(|grey| [grey, grey, grey, 255]).collect();
        Texture { name: "heights".into(), size, texels }
    }

    #[test]
    fn flat_heights_have_flat_normals() {
        for clamp in [false, true] {
            let normals = normals_of_heights(&grey([3, 2], |_, _| 77), clamp);
            assert_eq!(normals.texels, [[128, 128, 255, 255]; 6]);
        }
    }

    #[test]
    fn normals_lean_away_from_what_is_higher() {
        // 100 codes per texel in an image of 255 texels: a slope of 1.
        let to_the_right = grey([255, 3], |column, _| {
            if column == 10 {
                200
            } else if column == 9 {
                100
            } else {
                0
            }
        });
        let normals = normals_of_heights(&to_the_right, false);
        let diagonal = (127.0 * 0.5_f32.sqrt()).round() as u8;
        assert_eq!(normals.texels[9], [128 - diagonal, 128, 128 + diagonal, 255]);
        // Downwards: the normal leans to the top, which is green.
        let downwards = grey([255, 30], |_, row| {
            if row == 10 {
                200
            } else if row == 9 {
                100
            } else {
                0
            }
        });
        assert_eq!(normals_of_heights(&downwards, true).texels[255 * 9], [128, 128 + diagonal, 128 + diagonal, 255]);
    }

    #[test]
    fn edges_continue_as_they_are_told() {
        let slope = grey([100, 1], |column, _| 2 * column as u8);
        assert_eq!(normals_of_heights(&slope, true).texels[0][1..], [128, 255, 255]);
        assert!(normals_of_heights(&slope, true).texels[0][0] <= 128);
        assert!(normals_of_heights(&slope, false).texels[0][0] > 150, "beside what is white");
    }

    #[test]
    fn images_of_normals_have_colours() {
        assert!(is_grey(&grey([2, 2], |column, _| 255 * column as u8)));
        assert!(!is_grey(&Texture { name: String::new(), size: [1, 1], texels: vec![[128, 128, 255, 255]] }));
    }
}
