//! Mip levels: smaller and smaller means of a texture.
//!
//! A level has half as many texels as the one before, rounded up, until there is one. Each texel is the mean of the area that it covers:
//! texels of the level before count by the share of their area, so that every texel of the image has the same weight in each level, and the
//! mean of all levels is that of the image, whatever its size. Linear values are averaged, in single precision, and stored with 21
//! bits per channel: a step is 2⁻²⁰, so that black and white are exact.
//!
//! Where a material is cut out by the alpha of its own texture, texels count by their alpha: what is cut out, black in most files, would darken
//! leaves in the distance. Texels without any alpha take the colour of the next level.

use glam::Vec3;
use lightmesh_layout::constants::{TEXEL_BITS, TEXEL_ONE};
use lightmesh_memory::{Budget, OverBudget};
use lightmesh_scene::{Geometry, OpacityChannel, Texture, TextureUse};
use rayon::prelude::*;

use super::{Encoding, Image, images_of};

/// Texels of one axis of a level that a texel of the next one covers, at most: two whole ones, or parts of three.
const TAPS: usize = 3;

/// The levels of a texture below the image itself.
#[derive(Clone, Debug, Default)]
pub struct MipLevels {
    /// From the largest to the one that is a single texel.
    pub levels: Vec<Level>,
}

/// A level: packed texels, row by row.
#[derive(Clone, Debug)]
pub struct Level {
    /// Width and height.
    pub size: [u32; 2],
    /// Row by row, packed.
    pub texels: Vec<u64>,
}

/// Texels with linear values.
struct Linear {
    size: [u32; 2],
    texels: Vec<Vec3>,
}

/// The levels of all textures of a geometry that can be seen.
#[derive(Clone, Debug, Default)]
pub struct AllLevels {
    /// By texture, then by encoding; none of those that are not used like that.
    pub by_texture: Vec<[MipLevels; Encoding::ALL.len()]>,
}

impl AllLevels {
    /// Those of a geometry.
    ///
    /// # Errors
    /// The number of the texture whose levels do not fit into the budget.
    pub fn of(geometry: &Geometry, budget: Budget) -> Result<AllLevels, (usize, OverBudget)> {
        let mut all = AllLevels::default();
        let images = geometry.materials.iter().flat_map(|material| images_of(geometry, material));
        for Image { uses, texture, encoding } in images.flatten() {
            let index = uses.texture as usize;
            all.by_texture.resize_with(geometry.textures.len(), Default::default);
            let own = &mut all.by_texture[index][encoding as usize];
            if own.levels.is_empty() {
                let needed = bytes_to_build(texture.size);
                if encoding == Encoding::Color && is_alpha_tested(geometry, uses.texture) {
                    budget.check(2 * needed).map_err(|short| (index, short))?;
                    *own = MipLevels::of_alpha_test(texture);
                } else {
                    budget.check(needed).map_err(|short| (index, short))?;
                    *own = MipLevels::new(texture, encoding);
                }
            }
        }
        Ok(all)
    }

    /// Those of an image of the geometry.
    #[inline(always)]
    pub(crate) fn of_image(&self, image: &Image) -> &MipLevels {
        &self.by_texture[image.uses.texture as usize][image.encoding as usize]
    }

    /// Whether there are no images.
    pub(crate) fn is_empty(&self) -> bool {
        self.by_texture.is_empty()
    }

    /// Bytes on the heap.
    pub(crate) fn memory(&self) -> usize {
        self.by_texture.iter().flatten().map(MipLevels::memory).sum()
    }
}

impl MipLevels {
    /// The levels of `texture`, whose texels must be complete.
    pub fn new(texture: &Texture, encoding: Encoding) -> MipLevels {
        let levels = lower(texture, |texel| encoding.linear(texel));
        MipLevels { levels: levels.map(|level| level.packed()).collect() }
    }

    /// Those of a texture by whose alpha surfaces are cut out.
    fn of_alpha_test(texture: &Texture) -> MipLevels {
        let alpha = |texel: [u8; 4]| f32::from(texel[3]) / f32::from(u8::MAX);
        let colors = lower(texture, |texel| alpha(texel) * Encoding::Color.linear(texel));
        let shares = lower(texture, |texel| Vec3::splat(alpha(texel)));
        let mut levels: Vec<Level> = Vec::new();
        let mut empty: Vec<Vec<bool>> = Vec::new();
        for (mut color, share) in colors.zip(shares) {
            let texels = color.texels.iter_mut().zip(&share.texels);
            texels.for_each(|(color, share)| *color = if share.x > 0.0 { *color / share.x } else { Vec3::ZERO });
            empty.push(share.texels.iter().map(|share| share.x == 0.0).collect());
            levels.push(color.packed());
        }
        // From the smallest one on: each is complete before it fills the next.
        for index in (1..levels.len()).rev() {
            let (larger, smaller) = levels.split_at_mut(index);
            fill(&mut larger[index - 1], &empty[index - 1], &smaller[0]);
        }
        MipLevels { levels }
    }

    /// Bytes on the heap.
    pub fn memory(&self) -> usize {
        self.levels.iter().map(|level| size_of_val(level.texels.as_slice())).sum()
    }
}

/// Whether a material that shows a texture is cut out by its alpha.
fn is_alpha_tested(geometry: &Geometry, texture: u32) -> bool {
    let shown = |uses: TextureUse| uses.texture == texture;
    geometry.materials.iter().any(|material| {
        let by_alpha = material.opacity.filter(|opacity| opacity.channel == OpacityChannel::Alpha);
        material.texture.is_some_and(shown) && by_alpha.and_then(|opacity| opacity.texture).is_some_and(shown)
    })
}

/// The levels below an image whose texels have these values.
fn lower(texture: &Texture, value: impl Fn([u8; 4]) -> Vec3 + Sync) -> impl Iterator<Item = Linear> {
    let width = texture.size[0] as usize;
    let first = (texture.size != [1; 2])
        .then(|| halved(texture.size, |row, column| value(texture.texels[row * width + column])));
    std::iter::successors(first, |last| {
        let width = last.size[0] as usize;
        (last.size != [1; 2]).then(|| halved(last.size, |row, column| last.texels[row * width + column]))
    })
}

/// Gives texels that are `empty` the colour of the texel of the next level that covers them.
fn fill(level: &mut Level, empty: &[bool], next: &Level) {
    let [width, height] = level.size.map(u64::from);
    let of_next = |place: u64, side: u64, next: u32| (place * u64::from(next) / side) as usize;
    for (index, (texel, _)) in (0..).zip(level.texels.iter_mut().zip(empty)).filter(|(_, (_, empty))| **empty) {
        let column = of_next(index % width, width, next.size[0]);
        let row = of_next(index / width, height, next.size[1]);
        *texel = next.texels[row * next.size[0] as usize + column];
    }
}

/// Bytes of the levels of a texture and of what is held while they are built.
pub fn bytes_to_build(size: [u32; 2]) -> u64 {
    let half = |size: [u32; 2]| size.map(|side| side.div_ceil(2));
    let count = |size: [u32; 2]| size.map(u64::from).iter().product::<u64>();
    let (mut size, mut packed) = (size, 0);
    let building = (count(half(size)) + count(half(half(size)))) * size_of::<Vec3>() as u64;
    while size != [1; 2] {
        size = half(size);
        packed += count(size) * size_of::<u64>() as u64;
    }
    packed + building
}

/// The next level of one with this size and these texels, by row and column.
fn halved(size: [u32; 2], texel: impl Fn(usize, usize) -> Vec3 + Sync) -> Linear {
    let half = size.map(|side| side.div_ceil(2));
    let mut texels = vec![Vec3::ZERO; half[0] as usize * half[1] as usize];
    let columns: Vec<Taps> = (0..half[0]).map(|column| Taps::new(size[0], column)).collect();
    texels.par_chunks_exact_mut(half[0] as usize).enumerate().for_each(|(row, texels)| {
        let rows = Taps::new(size[1], row as u32);
        for (texel_here, columns) in texels.iter_mut().zip(&columns) {
            let along = |row: usize| columns.sum(|column| texel(row, column));
            *texel_here = rows.sum(along);
        }
    });
    Linear { size: half, texels }
}

/// The texels along one axis that a texel of the next level covers, and their shares of it.
struct Taps {
    first: u32,
    shares: [f32; TAPS],
}

impl Taps {
    /// Those of texel `place` of the level after one with `side` texels.
    fn new(side: u32, place: u32) -> Taps {
        // In units in which a texel before is as long as there are texels after, and the other way round: all borders are whole numbers.
        let (before, after) = (u64::from(side), u64::from(side.div_ceil(2)));
        let (start, end) = (u64::from(place) * before, (u64::from(place) + 1) * before);
        let first = start / after;
        let overlap = |index: u64| (end.min((index + 1) * after)).saturating_sub(start.max(index * after));
        let share = |tap: usize| overlap(first + tap as u64) as f32 / before as f32;
        Taps { first: first as u32, shares: std::array::from_fn(share) }
    }

    /// The mean of the values of these texels.
    fn sum(&self, value: impl Fn(usize) -> Vec3) -> Vec3 {
        let taps = self.shares.iter().enumerate().filter(|(_, share)| **share > 0.0);
        taps.map(|(tap, &share)| share * value(self.first as usize + tap)).sum()
    }
}

impl Linear {
    fn packed(&self) -> Level {
        Level { size: self.size, texels: self.texels.par_iter().map(|&color| packed(color)).collect() }
    }
}

/// Red in the lowest bits, then green and blue.
pub fn packed(color: Vec3) -> u64 {
    let [r, g, b] = color.to_array().map(|channel| (channel * TEXEL_ONE).round() as u64);
    r | g << TEXEL_BITS | b << (2 * TEXEL_BITS)
}

/// A texel of a lower level.
#[inline(always)]
pub fn unpacked(texel: u64) -> Vec3 {
    let channel = |shift: u32| (texel >> shift & ((1 << TEXEL_BITS) - 1)) as u32 as f32 / TEXEL_ONE;
    Vec3::new(channel(0), channel(TEXEL_BITS), channel(2 * TEXEL_BITS))
}
