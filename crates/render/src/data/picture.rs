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
    /// Linear radiance by pixel of these rows.
    pub color: Vec<[f32; 3]>,
    /// What each of these pixels sees.
    pub layers: Option<Layers>,
    /// While groups of lights follow: the radiance of each ray of a wave so far.
    pub(crate) sums: Vec<glam::Vec3>,
}

impl Picture {
    /// A black image of `size` pixels; with layers for `lights` lights on request.
    pub fn new(size: [u32; 2], lights: Option<usize>) -> Picture {
        Picture::band(size, 0..size[1], lights)
    }

    /// The black rows `rows` of an image of `size` pixels.
    pub fn band(size: [u32; 2], rows: Range<u32>, lights: Option<usize>) -> Picture {
        let pixels = size[0] as usize * rows.len();
        let layers = lights.map(|lights| Layers {
            depth: vec![f32::INFINITY; pixels],
            normal: vec![[0.0; 3]; pixels],
            position: vec![[0.0; 3]; pixels],
            visibility: vec![vec![0.0; pixels]; lights],
            used: vec![0; pixels],
        });
        Picture { size, rows, color: vec![[0.0; 3]; pixels], layers, sums: Vec::new() }
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

    /// Copies the rows of a band into this image, with its layers if both have them.
    pub fn take(&mut self, band: Picture) {
        if band.rows == self.rows {
            *self = band;
            return;
        }
        let places = self.places(&band.rows);
        self.color[places.clone()].copy_from_slice(&band.color);
        if let (Some(layers), Some(band)) = (&mut self.layers, &band.layers) {
            layers.depth[places.clone()].copy_from_slice(&band.depth);
            layers.normal[places.clone()].copy_from_slice(&band.normal);
            layers.position[places.clone()].copy_from_slice(&band.position);
            layers.used[places.clone()].copy_from_slice(&band.used);
            for (plane, band) in layers.visibility.iter_mut().zip(&band.visibility) {
                plane[places.clone()].copy_from_slice(band);
            }
        }
    }

    /// Number of pixels with a colour that is infinite or not a number.
    pub fn non_finite(&self) -> u64 {
        self.color.par_iter().filter(|color| !color.iter().all(|channel| channel.is_finite())).count() as u64
    }

    /// The finished frame.
    pub fn into_frame(self) -> Frame {
        let frame = Frame::new(self.size[0], self.size[1], self.color);
        let frame = frame.expect("an image has as many colours as pixels, and its size was checked");
        match self.layers {
            Some(layers) => frame.with_layers(layers).expect("layers were created with the image"),
            None => frame,
        }
    }
}
