//! An image being rendered: colours that radiance is added to, and the layers of what each pixel sees.

use std::ops::Range;

use lightmesh_image::{Frame, Layers};
use rayon::prelude::*;

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
    /// How much light the shadow catchers in each pixel get, as a share of what they would get alone and of the pixel; if it is needed.
    pub caught: Option<Vec<f32>>,
    /// What each of these pixels sees.
    pub layers: Option<Layers>,
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
        });
        let color = vec![[0.0; 3]; pixels];
        Picture { size, rows, kept, finished: 0, color, coverage: None, caught: None, layers, sums: Vec::new() }
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

    /// Adds to what shadow catchers get in a pixel of the whole image, if that is kept.
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

    /// Keeps what shadow catchers get.
    pub fn with_caught(self) -> Picture {
        Picture { caught: Some(vec![0.0; self.color.len()]), ..self }
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
    }

    /// Finds what is covered: pixels with a depth.
    pub(crate) fn find_coverage(&mut self) {
        let depths = self.layers.as_ref().map(|layers| &layers.depth);
        self.coverage =
            depths.map(|depths| depths.iter().map(|depth| f32::from(u8::from(depth.is_finite()))).collect());
    }

    /// What a shadow catcher gets of its light is not covered.
    pub(crate) fn uncover_caught(&mut self) {
        if let (Some(coverage), Some(caught)) = (&mut self.coverage, self.caught.take()) {
            coverage.iter_mut().zip(caught).for_each(|(coverage, caught)| *coverage = (*coverage - caught).max(0.0));
        }
    }

    /// Takes the background out of all pixels, as far as they are not covered: what remains is premultiplied by the coverage.
    pub(crate) fn take_out(&mut self, background: glam::Vec3) {
        let Some(coverage) = &self.coverage else { return };
        for (color, &coverage) in self.color.iter_mut().zip(coverage) {
            if coverage <= 0.0 {
                *color = [0.0; 3];
            } else if coverage < 1.0 {
                let covered = glam::Vec3::from_array(*color) - (1.0 - coverage) * background;
                *color = covered.max(glam::Vec3::ZERO).to_array();
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_covered_loses_its_background() {
        let mut picture = Picture::new([3, 1], None);
        picture.color = vec![[0.2, 0.4, 0.8], [0.6, 0.5, 0.4], [0.25; 3]];
        picture.coverage = Some(vec![0.0, 1.0, 0.5]);
        picture.take_out(glam::Vec3::new(0.2, 0.4, 0.8));
        let frame = picture.into_frame();
        assert_eq!(frame.alpha(), Some(&[0.0, 1.0, 0.5][..]));
        let half = [0.25_f32 - 0.5 * 0.2, 0.25 - 0.5 * 0.4, 0.0];
        assert_eq!(frame.color(), [[0.0; 3], [0.6, 0.5, 0.4], half]);
    }
}
