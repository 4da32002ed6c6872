//! Smaller and smaller means of a panorama.

use std::f32::consts::PI;

/// A mean of a panorama with fewer texels.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentLevel {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Radiances row by row, from the top.
    pub texels: Vec<[f32; 3]>,
}

/// The levels below an image, each with half as many texels along each side, rounded up, down to a single one.
pub(super) fn of(size: [u32; 2], image: &[[f32; 3]]) -> Vec<EnvironmentLevel> {
    let mut levels: Vec<EnvironmentLevel> = Vec::new();
    let mut last = size;
    while last != [1; 2] {
        let texels = levels.last().map_or(image, |level| &level.texels);
        let next = halved(last, texels);
        last = next.size;
        levels.push(next);
    }
    levels
}

/// The next level of one with this size. A texel is the mean of two by two, whose rows count by the solid angle that they cover; the last
/// column or row of an odd number stands alone.
fn halved(size: [u32; 2], texels: &[[f32; 3]]) -> EnvironmentLevel {
    let half = size.map(|side| side.div_ceil(2));
    let at = |column: u32, row: u32| texels[row as usize * size[0] as usize + column as usize].map(f64::from);
    let mut means = Vec::with_capacity(half[0] as usize * half[1] as usize);
    for row in 0..half[1] {
        let rows = 2 * row..(2 * row + 2).min(size[1]);
        let weights: Vec<f64> = rows.clone().map(|row| f64::from(band(row, size[1]))).collect();
        let total: f64 = weights.iter().sum();
        for column in 0..half[0] {
            let columns = 2 * column..(2 * column + 2).min(size[0]);
            let count = columns.len() as f64;
            let mut sum = [0.0; 3];
            for (row, weight) in rows.clone().zip(&weights) {
                for texel in columns.clone().map(|column| at(column, row)) {
                    sum = [0, 1, 2].map(|channel| sum[channel] + weight * texel[channel]);
                }
            }
            means.push(sum.map(|channel| (channel / (total * count)) as f32));
        }
    }
    EnvironmentLevel { size: half, texels: means }
}

/// How far the sine of the elevation reaches over a row: in proportion to its solid angle.
pub(super) fn band(row: u32, height: u32) -> f32 {
    let cosine = |row: u32| (f64::from(PI) * f64::from(row) / f64::from(height)).cos();
    (cosine(row) - cosine(row + 1)) as f32
}
