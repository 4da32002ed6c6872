//! A picture in the making: colours that radiance is added to, and the layers of what each pixel saw.

use lightmesh_image::{Frame, Layers};

/// Linear colours and, on request, layers; row 0 is the top.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear radiance by pixel, y · width + x.
    pub color: Vec<[f32; 3]>,
    /// What each pixel saw.
    pub layers: Option<Layers>,
}

impl Picture {
    /// A black picture of `size` pixels; with layers for `lights` lights on request.
    pub fn new(size: [u32; 2], lights: Option<usize>) -> Picture {
        let pixels = size[0] as usize * size[1] as usize;
        let layers = lights.map(|lights| Layers {
            depth: vec![f32::INFINITY; pixels],
            normal: vec![[0.0; 3]; pixels],
            position: vec![[0.0; 3]; pixels],
            visibility: vec![vec![0.0; pixels]; lights],
            used: vec![0; pixels],
        });
        Picture { size, color: vec![[0.0; 3]; pixels], layers }
    }

    /// Adds radiance to a pixel.
    pub fn add(&mut self, pixel: u32, radiance: glam::Vec3) {
        let color = &mut self.color[pixel as usize];
        *color = (glam::Vec3::from_array(*color) + radiance).to_array();
    }

    /// The finished frame.
    pub fn into_frame(self) -> Frame {
        let frame = Frame::new(self.size[0], self.size[1], self.color);
        let frame = frame.expect("a picture has as many colours as pixels, and its size was checked");
        match self.layers {
            Some(layers) => frame.with_layers(layers).expect("layers were made with the picture"),
            None => frame,
        }
    }
}
