//! The hours of direct sun that were found, and what the pixels see.

use lightmesh_image::{ExrOptions, Frame, Layers};
use lightmesh_render::Glass;
use lightmesh_scene::Camera;

use super::points::Finer;
use crate::sun::SunStudy;

/// The hours of direct sun of the pixels of an image.
pub struct SunHours {
    pub(super) study: SunStudy,
    pub(super) exr: ExrOptions,
    /// What surfaces do that let light through; `None` if there are none.
    pub(super) glass: Option<Glass>,
    /// What the pixels see.
    pub(super) frame: Frame,
    pub(super) camera: Camera,
    /// Hours by pixel; 0 where there is no surface.
    pub(super) hours: Vec<f32>,
    /// Whether a pixel sees a surface.
    pub(super) mask: Vec<bool>,
    /// More points on the objects that few pixels show.
    pub(super) finer: Finer,
}

impl SunHours {
    /// Hours of the pixels, row by row from the top; 0 where there is no sun, or [no surface](SunHours::mask()).
    pub fn hours(&self) -> &[f32] {
        &self.hours
    }

    /// Whether the pixels see a surface, row by row from the top. Tables count only those that do, and exr files have it as alpha.
    pub fn mask(&self) -> &[bool] {
        &self.mask
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.frame.width(), self.frame.height()]
    }

    pub(super) fn layers(&self) -> &Layers {
        self.frame.layers().expect("they were kept")
    }

    /// Whether a pixel sees a surface.
    pub(super) fn sees(&self, pixel: usize) -> bool {
        self.mask[pixel]
    }
}
