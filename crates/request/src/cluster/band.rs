//! Rows of a picture that are rendered apart, and how they become a whole again.

use lightmesh_image as image;
use lightmesh_render::{Crop, Frame, Stats};
use serde::{Deserialize, Serialize};

use crate::error::ClusterError;

/// One rendering of the whole picture. There are two where mirrors show a background whose brightness the first one tells.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Which of them it is, from 0 on.
    pub number: usize,
    /// How many there are.
    pub of: usize,
    /// Column, row, width and height of what is rendered: the image, or the part of it that is asked for.
    pub area: [i64; 4],
    /// Whether the area is a part.
    pub is_part: bool,
    /// Whether what lies behind surfaces is left out.
    pub transparent: bool,
    /// Radiance that replaces the background.
    pub background: Option<[f32; 3]>,
}

/// Some rows of a pass.
#[derive(Clone, Debug)]
pub struct Band {
    /// The row of the image that is its first.
    pub first: i64,
    /// Linear colours, row by row.
    pub color: Vec<[f32; 3]>,
    /// The covered share of each pixel, if it is known.
    pub alpha: Option<Vec<f32>>,
    /// The statistics of these rows.
    pub stats: Stats,
}

impl Band {
    /// A frame that was rendered from row `first` of the image on.
    pub(super) fn new(first: i64, frame: Frame) -> Band {
        let parts = frame.image.into_parts();
        Band { first, color: parts.color, alpha: parts.alpha, stats: frame.stats }
    }
}

impl Pass {
    /// The crop of some of its rows.
    pub(super) fn crop_of(&self, first: i64, rows: u32) -> Option<Crop> {
        let [x, y, width, height] = self.area;
        let is_within = first >= y && first + i64::from(rows) <= y + height && rows > 0;
        let corner = [i32::try_from(x).ok()?, i32::try_from(first).ok()?];
        is_within.then_some(Crop::new(corner, [u32::try_from(width).ok()?, rows]))
    }

    /// The frame that all bands make together.
    pub(super) fn assemble(&self, mut bands: Vec<Band>, size: [u32; 2]) -> Result<Frame, ClusterError> {
        bands.sort_by_key(|band| band.first);
        let [x, y, width, height] = self.area;
        let lacks = || ClusterError::Bands { rows: height };
        let mut stats = bands.first().ok_or_else(lacks)?.stats.clone();
        bands[1..].iter().for_each(|band| stats.add(&band.stats));
        // What bands look at around them is not counted.
        stats.counts.pixels = width.unsigned_abs() * height.unsigned_abs();
        stats.settings.crop = self.is_part.then_some(self.area);
        let has_alpha = bands.iter().all(|band| band.alpha.is_some());
        let (mut image, mut next) = (None, y);
        for Band { first, color, alpha, .. } in bands {
            let rows = color.len() as i64 / width.max(1);
            let [columns, count] = [width, rows].map(|side| side as u32);
            let part = image::Frame::new(columns, count, color).map_err(|_| lacks())?;
            let part = part.with_window([x as i32, first as i32], size);
            let part = match alpha.filter(|_| has_alpha) {
                Some(alpha) => part.with_alpha(alpha).map_err(|_| lacks())?,
                None => part,
            };
            let blank = || image::Frame::around(&part, [x as i32, y as i32], [columns, height as u32]);
            let all = image.get_or_insert_with(blank).as_mut().ok_or_else(lacks)?;
            if first != next || !all.put(&part, part.window().first, [columns, count]) {
                return Err(lacks());
            }
            next += rows;
        }
        let image = image.flatten().filter(|_| next == y + height).ok_or_else(lacks)?;
        Ok(Frame { image, stats })
    }
}
