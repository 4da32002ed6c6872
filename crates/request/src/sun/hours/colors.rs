//! Viridis: colours whose order and steps are seen as they are, in grey and by those who confuse red and green, too.
//!
//! The map is that of matplotlib (S. van der Walt, N. Smith: *A Better Default Colormap for Matplotlib*, SciPy 2015), which is in the public
//! domain (CC0), by the polynomials of M. Zucker (<https://www.shadertoy.com/view/WlfXRN>, CC0), which are within 1/100 of it.

/// Coefficients of the powers of the value, from the constant on, for red, green and blue.
const VIRIDIS: [[f64; 3]; 7] = [
    [0.2777273272234177, 0.005407344544966578, 0.3340998053353061],
    [0.1050930431085774, 1.404613529898575, 1.384590162594685],
    [-0.3308618287255563, 0.214847559468213, 0.09509516302823659],
    [-4.634230498983486, -5.799100973351585, -19.33244095627987],
    [6.228269936347081, 14.17993336680509, 56.69055260068105],
    [4.776384997670288, -13.74514537774601, -65.35303263337234],
    [-5.435455855934631, 4.645852612178535, 26.3124352495832],
];

/// The colour of a value from 0 to 1, as sRGB codes: from dark violet to yellow.
pub(super) fn viridis(value: f64) -> [u8; 3] {
    let value = value.clamp(0.0, 1.0);
    [0, 1, 2].map(|channel| {
        let level = VIRIDIS.iter().rev().fold(0.0, |sum, powers| sum * value + powers[channel]);
        (255.0 * level).round().clamp(0.0, 255.0) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_is_the_published_one() {
        // From the table of matplotlib.
        for (value, expected) in
            [(0.0, [68, 1, 84]), (0.25, [59, 82, 139]), (0.5, [33, 145, 140]), (1.0, [253, 231, 37])]
        {
            let found = viridis(value);
            let near = found.iter().zip(expected).all(|(&found, expected)| i32::from(found).abs_diff(expected) <= 4);
            assert!(near, "{value}: {found:?}, not {expected:?}");
        }
        assert_eq!((viridis(-1.0), viridis(2.0)), (viridis(0.0), viridis(1.0)));
    }

    #[test]
    fn more_is_brighter() {
        let brightness = |code: i32| {
            let [red, green, blue] = viridis(f64::from(code) / 100.0).map(f64::from);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        assert!((0..100).all(|code| brightness(code) < brightness(code + 1)));
    }
}
