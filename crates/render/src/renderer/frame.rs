//! What a render gives: an image with its statistics.

use std::path::Path;

use lightmesh_image::{FrameParts, Layers, SaveError};

use crate::settings::Crop;
#[cfg(doc)]
use crate::settings::Settings;
use crate::stats::Stats;

/// A finished image and its statistics.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Linear colours, and alpha and layers if requested.
    pub image: lightmesh_image::Frame,
    /// Counts, seconds and settings.
    pub stats: Stats,
}

impl Frame {
    /// Writes the image as bmp, png, exr or jpg, by the file extension; 8-bit formats in sRGB.
    ///
    /// # Errors
    /// [`SaveError`] if the extension is unknown or the file cannot be written; no partial file is left behind.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.image.save(path)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.image.width(), self.image.height()]
    }

    /// A part of the image, with what was finished of it; `None` if the frame does not have all of it.
    pub fn cropped(self, crop: Crop) -> Option<Frame> {
        let (Crop { first: [x, y], size: [width, height] }, finished) = (crop, self.finished_rows_of(crop));
        let is_whole = self.image.window().first == crop.first && self.size() == crop.size;
        let image = if is_whole { self.image } else { self.image.cropped(crop.first, crop.size)? };
        let mut stats = self.stats;
        stats.settings.crop = Some([x.into(), y.into(), width.into(), height.into()]);
        stats.finished_rows = (finished < height).then_some(finished);
        Some(Frame { image, stats })
    }

    /// The number of finished rows of a part of the image, from its top.
    pub(crate) fn finished_rows_of(&self, Crop { first: [_, y], size: [_, height] }: Crop) -> u32 {
        let above = y.saturating_sub(self.image.window().first[1]).max(0) as u32;
        self.finished_rows().saturating_sub(above).min(height)
    }

    /// Linear colours, row-major, row 0 at the top.
    pub fn color(&self) -> &[[f32; 3]] {
        self.image.color()
    }

    /// What each pixel sees, if [`Settings::layers`] requested it.
    pub fn layers(&self) -> Option<&Layers> {
        self.image.layers()
    }

    /// The number of finished rows, from the top: all, unless the observer cancelled the render and
    /// [`Settings::partial`] asked for what is finished. The rows below have the background's colour, or are
    /// transparent, and their layers are those of pixels that see nothing.
    pub fn finished_rows(&self) -> u32 {
        self.stats.finished_rows.unwrap_or_else(|| self.image.height())
    }

    /// The image's vectors; nothing is copied.
    pub fn into_parts(self) -> FrameParts {
        self.image.into_parts()
    }
}
