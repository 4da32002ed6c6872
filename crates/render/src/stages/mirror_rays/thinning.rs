//! Which of many faint rays of a pixel go on.
//!
//! Glass that mirrors and lets through makes two rays of each, and panes behind each other soon make hundreds of which little reaches the pixel. Rays
//! of a share w of at least T, those of all channels counting as the largest, always go on: [`MIN_THICK`], or [`MIN_THICK_DEEP`] of rays that met
//! [`DEEP`] surfaces, which are many. Of the others of a pixel at one depth
//! those go on, in their order, where
//!
//! ```text
//! ⌊o + (w₁ + … + w_k) / T⌋  >  ⌊o + (w₁ + … + w_(k−1)) / T⌋
//! ```
//!
//! with the weight T in place of w: systematic sampling. The offset o depends on the pixel's place and the depth, and is evenly distributed: a ray goes
//! on with a probability of w/T, so that the mean over pixels is what it was. Neighbours have offsets of a sequence of low discrepancy, multiples of
//! irrational numbers without their whole parts, and err in different directions. The sums of weights before each
//! ray differ by less than T, so that at each depth the error of a pixel is less than T times the brightest radiance of these rays and its changes
//! from one to the next.
//!
//! Twin: `kernel.cu`. Weights are whole numbers of T 2⁻¹⁶, so that sums are the same in any order.

use glam::Vec3;
use lightmesh_layout::constants::{DEEP, MIN_THICK, MIN_THICK_DEEP, THIN_ACROSS, THIN_BITS, THIN_DEEPER, THIN_DOWN};

use crate::data::rays::RayList;

/// What goes on of the rays of one pixel after the other.
pub(super) struct Thinning<'a> {
    list: &'a RayList,
    /// T.
    least: f32,
    /// The pixel whose rays are at hand.
    pixel: Option<u32>,
    /// Its offset, and the shares of its thin rays up to now.
    sum: u32,
}

impl<'a> Thinning<'a> {
    /// For rays that go on from those of `list`.
    pub(super) fn new(list: &'a RayList) -> Thinning<'a> {
        let least = if list.depth < DEEP { MIN_THICK } else { MIN_THICK_DEEP };
        Thinning { list, least, pixel: None, sum: 0 }
    }

    /// The weight with which the next ray from ray `index` goes on, if it does.
    pub(super) fn weight(&mut self, index: usize, weight: Vec3) -> Option<Vec3> {
        let share = weight.max_element();
        if share >= self.least {
            return Some(weight);
        }
        let pixel = self.list.pixels[index];
        if self.pixel != Some(pixel) {
            (self.pixel, self.sum) = (Some(pixel), self.offset(pixel));
        }
        let before = self.sum;
        let part = part_of(share, self.least);
        self.sum = before.wrapping_add(part);
        (self.sum >> THIN_BITS != before >> THIN_BITS).then(|| weight * ((1 << THIN_BITS) as f32 / part as f32))
    }

    /// The offset of a pixel. That of one depth tells nothing of the next one's, which would spoil the mean.
    fn offset(&self, pixel: u32) -> u32 {
        let [x, y] = self.list.window.place(pixel).map(|place| place as u32);
        let times = self.list.depth + 1;
        let (x, y) = (x.wrapping_mul(THIN_ACROSS.wrapping_pow(times)), y.wrapping_mul(THIN_DOWN.wrapping_pow(times)));
        x.wrapping_add(y).wrapping_add(times.wrapping_mul(THIN_DEEPER)) >> (u32::BITS - THIN_BITS)
    }
}

/// A share in units of T 2⁻¹⁶.
fn part_of(share: f32, least: f32) -> u32 {
    (share * ((1 << THIN_BITS) as f32 / least)) as u32
}
