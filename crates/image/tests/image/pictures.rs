//! Images shared by the tests.

use lightmesh_image::{Frame, Layers, MAX_RANKS, Matte, Transfer};

/// Colours that every 8-bit format can represent exactly, different in each pixel and channel.
pub(crate) fn coded(width: u32, height: u32) -> Frame {
    let code = |pixel: usize, channel: usize| Transfer::Srgb.decode((pixel * 37 + channel * 91 + pixel / 256) as u8);
    let color = (0..(width * height) as usize).map(|pixel| [0, 1, 2].map(|channel| code(pixel, channel))).collect();
    Frame::new(width, height, color).unwrap()
}

/// A smooth image, suited to lossy formats: red increases to the right, green downwards.
pub(crate) fn ramp(width: u32, height: u32) -> Frame {
    let at = |x: u32, y: u32| [x as f32 / width as f32, y as f32 / height as f32, 0.25];
    Frame::new(width, height, (0..height).flat_map(|y| (0..width).map(move |x| at(x, y))).collect()).unwrap()
}

/// One colour everywhere.
pub(crate) fn plain(width: u32, height: u32, color: [f32; 3]) -> Frame {
    Frame::new(width, height, vec![color; (width * height) as usize]).unwrap()
}

/// A frame with layers for two lights, in which one pixel missed the scene.
pub(crate) fn layered(width: u32, height: u32) -> Frame {
    let pixels = (width * height) as usize;
    let mut layers = Layers {
        depth: (0..pixels).map(|pixel| 1.0 + pixel as f32).collect(),
        normal: vec![[0.0, 0.6, -0.8]; pixels],
        position: (0..pixels).map(|pixel| [pixel as f32, -1.0, 0.1]).collect(),
        visibility: (0..2).map(|light| vec![0.25 + 0.5 * light as f32; pixels]).collect(),
        used: (0..pixels as u32).collect(),
        lights: (0..2).map(|light| vec![[0.125 * light as f32, 0.25, 0.5]; pixels]).collect(),
        rest: vec![[0.0, 0.5, 0.25]; pixels],
        object: Matte::nothing(vec!["floor".to_owned()], MAX_RANKS, pixels),
        material: Matte::default(),
    };
    layers.depth[0] = f32::INFINITY;
    ramp(width, height).with_layers(layers).unwrap()
}
