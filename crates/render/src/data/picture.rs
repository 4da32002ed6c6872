//! An image being rendered: colours that radiance is added to, and the layers of what each pixel sees.

use std::ops::Range;

use lightmesh_image::{Frame, Layers, Matte, Rank};
use rayon::prelude::*;

use super::mattes::{Counted, ranks_of, take_away};
use crate::plan::Plan;

/// Linear colours and, on request, layers of some rows of an image; row 0 is the top.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width and height of the whole image in pixels.
    pub size: [u32; 2],
    /// The rows that are stored here.
    pub rows: Range<u32>,
    /// Those of them that are finished here; the others are needed by their neighbours.
    pub kept: Range<u32>,
    /// The number of finished rows, from the top of the image.
    pub(crate) finished: u32,
    /// Linear radiance by pixel of these rows.
    pub color: Vec<[f32; 3]>,
    /// The share of each pixel's samples that see anything, if it was asked for.
    pub coverage: Option<Vec<f32>>,
    /// The share of each pixel that shows what is behind everything, through surfaces or on shadow catchers, as far as these get the light
    /// that they would get alone; if it is needed.
    pub caught: Option<Vec<f32>>,
    /// What each of these pixels sees.
    pub layers: Option<Layers>,
    /// What the samples of these pixels see, if they have several and mattes are kept.
    pub(crate) counted: Option<Counted>,
    /// While groups of lights follow: the radiance of each ray of a wave so far.
    pub(crate) sums: Vec<glam::Vec3>,
}

impl Picture {
    /// A black image of `size` pixels; with layers for `lights` lights on request.
    pub fn new(size: [u32; 2], lights: Option<usize>) -> Picture {
        Picture::band(size, [0..size[1], 0..size[1]], lights)
    }

    /// Black rows of an image of `size` pixels: all that are stored, and those of them that are kept.
    pub fn band(size: [u32; 2], [rows, kept]: [Range<u32>; 2], lights: Option<usize>) -> Picture {
        let pixels = size[0] as usize * rows.len();
        let layers = lights.map(|lights| Layers {
            depth: vec![f32::INFINITY; pixels],
            normal: vec![[0.0; 3]; pixels],
            position: vec![[0.0; 3]; pixels],
            visibility: vec![vec![0.0; pixels]; lights],
            used: vec![0; pixels],
            ..Layers::default()
        });
        let color = vec![[0.0; 3]; pixels];
        Picture {
            size,
            rows,
            kept,
            finished: 0,
            color,
            coverage: None,
            caught: None,
            layers,
            counted: None,
            sums: Vec::new(),
        }
    }

    /// Black rows with all that `plan` asks for.
    pub(crate) fn planned(plan: &Plan, rows: [Range<u32>; 2]) -> Picture {
        let mut picture = Picture::band(plan.size, rows, plan.layers);
        if plan.coverage {
            picture = picture.with_coverage();
        }
        if plan.caught {
            picture = picture.with_caught();
        }
        if plan.compositing {
            picture = picture.with_light_groups().with_mattes(ranks_of(plan.pixel_samples()));
        }
        picture
    }

    /// The index of pixel y · width + x of the whole image in the planes.
    #[inline(always)]
    pub fn index(&self, pixel: u32) -> usize {
        pixel as usize - self.rows.start as usize * self.size[0] as usize
    }

    /// The index range of some rows in the planes.
    pub fn places(&self, rows: &Range<u32>) -> Range<usize> {
        self.index(rows.start * self.size[0])..self.index(rows.end * self.size[0])
    }

    /// Adds radiance to a pixel of the whole image.
    pub fn add(&mut self, pixel: u32, radiance: glam::Vec3) {
        let index = self.index(pixel);
        let color = &mut self.color[index];
        *color = (glam::Vec3::from_array(*color) + radiance).to_array();
    }

    /// Adds to the share of a pixel of the whole image that shows what is behind everything, if that is kept.
    pub(crate) fn catch(&mut self, pixel: u32, caught: f32) {
        let index = self.index(pixel);
        if let Some(plane) = &mut self.caught {
            plane[index] += caught;
        }
    }

    /// Keeps the coverage of each pixel, none so far.
    pub fn with_coverage(self) -> Picture {
        Picture { coverage: Some(vec![0.0; self.color.len()]), ..self }
    }

    /// Keeps what shadow catchers, and surfaces that rays go through, show of what is behind everything.
    pub fn with_caught(self) -> Picture {
        Picture { caught: Some(vec![0.0; self.color.len()]), ..self }
    }

    /// Keeps the radiance of each light by itself, if there are layers.
    pub(crate) fn with_light_groups(mut self) -> Picture {
        if let Some(layers) = &mut self.layers {
            let black = vec![[0.0; 3]; self.color.len()];
            layers.lights = vec![black.clone(); layers.visibility.len()];
            layers.rest = black;
        }
        self
    }

    /// Keeps numbers and mattes of objects and materials of `ranks` ranks, if there are layers.
    fn with_mattes(mut self, ranks: usize) -> Picture {
        let pixels = self.color.len();
        if let Some(layers) = &mut self.layers {
            layers.object = Matte::nothing(Vec::new(), ranks, pixels);
            layers.material = layers.object.clone();
        }
        self
    }

    /// Counts what several samples of pixels see, if mattes are kept.
    pub(crate) fn with_counted(mut self, plan: &Plan) -> Picture {
        let samples = plan.pixel_samples();
        self.counted = (plan.compositing && samples > 1).then(|| Counted::none(samples, self.color.len()));
        self
    }

    /// Writes what was counted to the mattes.
    pub(crate) fn write_counted(&mut self) {
        if let (Some(counted), Some(Layers { object, material, .. })) = (self.counted.take(), &mut self.layers) {
            counted.write([object, material], 0);
        }
    }

    /// Completes the mattes with names; pixels with one sample see one thing.
    pub(crate) fn complete_mattes(&mut self, names: [Vec<String>; 2], one_sample: bool) {
        let Some(Layers { object, material, .. }) = &mut self.layers else { return };
        for (matte, names) in [object, material].into_iter().zip(names) {
            matte.names = names;
            if let [Rank { number, share }] = &mut matte.ranks[..]
                && one_sample
            {
                number.copy_from_slice(&matte.nearest);
                share.iter_mut().zip(number).for_each(|(share, number)| *share = f32::from(u8::from(*number != 0)));
            }
        }
    }

    /// Copies the kept rows of a band into this image, with its layers and coverage if both have them.
    pub fn take(&mut self, band: Picture) {
        if band.kept == self.rows && band.rows == self.rows {
            *self = band;
            return;
        }
        let (to, from) = (self.places(&band.kept), band.places(&band.kept));
        self.color[to.clone()].copy_from_slice(&band.color[from.clone()]);
        if let (Some(coverage), Some(band)) = (&mut self.coverage, &band.coverage) {
            coverage[to.clone()].copy_from_slice(&band[from.clone()]);
        }
        if let (Some(caught), Some(band)) = (&mut self.caught, &band.caught) {
            caught[to.clone()].copy_from_slice(&band[from.clone()]);
        }
        if let (Some(layers), Some(band)) = (&mut self.layers, &band.layers) {
            layers.depth[to.clone()].copy_from_slice(&band.depth[from.clone()]);
            layers.normal[to.clone()].copy_from_slice(&band.normal[from.clone()]);
            layers.position[to.clone()].copy_from_slice(&band.position[from.clone()]);
            layers.used[to.clone()].copy_from_slice(&band.used[from.clone()]);
            for (plane, band) in layers.visibility.iter_mut().zip(&band.visibility) {
                plane[to.clone()].copy_from_slice(&band[from.clone()]);
            }
            for (matte, band) in [(&mut layers.object, &band.object), (&mut layers.material, &band.material)] {
                take_matte(matte, band, &to, &from);
            }
            for (plane, band) in light_groups_of(layers).zip(band.lights.iter().chain([&band.rest])) {
                plane[to.clone()].copy_from_slice(&band[from.clone()]);
            }
        }
    }

    /// Number of pixels with a colour that is infinite or not a number.
    pub fn non_finite(&self) -> u64 {
        self.color.par_iter().filter(|color| !color.iter().all(|channel| channel.is_finite())).count() as u64
    }

    /// Gives the rows that are not finished the colour of the background. In their layers, nothing is in sight.
    pub(crate) fn fill_unfinished(&mut self, background: glam::Vec3) {
        let first = self.places(&(self.finished..self.size[1])).start;
        self.color[first..].fill(background.to_array());
        if let Some(layers) = self.layers.as_mut().filter(|layers| !layers.rest.is_empty()) {
            layers.rest[first..].fill(background.to_array());
        }
    }

    /// Finds what is covered: pixels with a depth.
    pub(crate) fn find_coverage(&mut self) {
        let depths = self.layers.as_ref().map(|layers| &layers.depth);
        self.coverage =
            depths.map(|depths| depths.iter().map(|depth| f32::from(u8::from(depth.is_finite()))).collect());
    }

    /// What a shadow catcher gets of its light is not covered. `catchers` are the numbers of objects, and of materials, that catch shadows.
    pub(crate) fn uncover_caught(&mut self, catchers: [Vec<u32>; 2]) {
        let (Some(coverage), Some(caught)) = (&mut self.coverage, self.caught.take()) else { return };
        coverage.iter_mut().zip(&caught).for_each(|(coverage, caught)| *coverage = (*coverage - caught).max(0.0));
        let Some(Layers { object, material, .. }) = &mut self.layers else { return };
        for (matte, catchers) in [object, material].into_iter().zip(&catchers) {
            let uncovered = caught.iter().enumerate().filter(|(_, caught)| **caught > 0.0);
            uncovered.for_each(|(pixel, &caught)| take_away(matte, catchers, pixel, caught));
        }
    }

    /// Takes the background out of all pixels, as far as they are not covered: what remains is premultiplied by the coverage.
    #[doc(hidden)]
    pub fn take_out(&mut self, background: glam::Vec3) {
        let Some(coverage) = &self.coverage else { return };
        let take_out = |plane: &mut [[f32; 3]], background: glam::Vec3| {
            for (color, &coverage) in plane.iter_mut().zip(coverage) {
                if coverage <= 0.0 {
                    *color = [0.0; 3];
                } else if coverage < 1.0 {
                    let covered = glam::Vec3::from_array(*color) - (1.0 - coverage) * background;
                    *color = covered.max(glam::Vec3::ZERO).to_array();
                }
            }
        };
        take_out(&mut self.color, background);
        if let Some(layers) = &mut self.layers {
            // The background belongs to no light.
            take_out(&mut layers.rest, background);
            layers.lights.iter_mut().for_each(|plane| take_out(plane, glam::Vec3::ZERO));
        }
    }

    /// The finished frame; its alpha is the coverage.
    pub fn into_frame(self) -> Frame {
        let frame = Frame::new(self.size[0], self.size[1], self.color);
        let frame = frame.expect("an image has as many colours as pixels, and its size was checked");
        let frame = match self.coverage {
            Some(coverage) => frame.with_alpha(coverage).expect("coverage was created with the image"),
            None => frame,
        };
        match self.layers {
            Some(layers) => frame.with_layers(layers).expect("layers were created with the image"),
            None => frame,
        }
    }
}

/// Copies the pixels `from` a band's matte `to` their places.
fn take_matte(matte: &mut Matte, band: &Matte, to: &Range<usize>, from: &Range<usize>) {
    if !matte.nearest.is_empty() {
        matte.nearest[to.clone()].copy_from_slice(&band.nearest[from.clone()]);
    }
    for (rank, band) in matte.ranks.iter_mut().zip(&band.ranks) {
        rank.number[to.clone()].copy_from_slice(&band.number[from.clone()]);
        rank.share[to.clone()].copy_from_slice(&band.share[from.clone()]);
    }
}

/// The planes of radiance by light, and then that of no light; none if they are not kept.
pub(crate) fn light_groups_of(layers: &mut Layers) -> impl Iterator<Item = &mut Vec<[f32; 3]>> {
    let rest = Some(&mut layers.rest).filter(|rest| !rest.is_empty());
    layers.lights.iter_mut().chain(rest)
}
