//! A rendered frame, read plane by plane and checked.

use glam::{DVec3, Vec3};
use lightmesh_image::Layers;
use lightmesh_render::Frame;

/// A frame with layers.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    frame: &'a Frame,
    layers: &'a Layers,
}

impl<'a> Picture<'a> {
    /// Panics if the frame was rendered without layers.
    pub fn new(frame: &'a Frame) -> Picture<'a> {
        Picture { frame, layers: frame.image.layers().expect("rendered with layers") }
    }

    /// The layers.
    pub fn layers(&self) -> &'a Layers {
        self.layers
    }

    /// Whether pixel number `pixel` shows geometry.
    pub fn hit(&self, pixel: usize) -> bool {
        self.layers.depth[pixel] < f32::INFINITY
    }

    /// The pixels that show geometry.
    pub fn hits(&self) -> impl Iterator<Item = usize> + use<'a> {
        let layers = self.layers;
        (0..layers.depth.len()).filter(move |&pixel| layers.depth[pixel] < f32::INFINITY)
    }

    /// Surface point of a pixel, world coordinates.
    pub fn position(&self, pixel: usize) -> Vec3 {
        Vec3::from_array(self.layers.position[pixel])
    }

    /// Geometric normal of a pixel.
    pub fn normal(&self, pixel: usize) -> Vec3 {
        Vec3::from_array(self.layers.normal[pixel])
    }

    /// Visibility of light number `light` at each pixel that shows geometry.
    pub fn visibilities(&self, light: usize) -> Vec<f32> {
        self.hits().map(|pixel| self.layers.visibility[light][pixel]).collect()
    }

    /// A problem with the values of this image, if any: colours must be finite and not negative, visibility in [0, 1], normals of
    /// unit length, and everything but the colour as documented if a ray missed.
    pub fn fault(&self) -> Option<String> {
        let colors = self.frame.image.color();
        (0..colors.len()).find_map(|pixel| {
            let color = Vec3::from_array(colors[pixel]);
            let visibility = self.layers.visibility.iter().map(|plane| plane[pixel]);
            let (depth, normal) = (self.layers.depth[pixel], self.normal(pixel));
            let problem = if !color.is_finite() || color.min_element() < 0.0 {
                "colour"
            } else if visibility.clone().any(|share| !(0.0..=1.0).contains(&share)) {
                "visibility"
            } else if self.hit(pixel) && !(depth >= 0.0 && (normal.length() - 1.0).abs() < 1e-4) {
                "depth or normal"
            } else if !self.hit(pixel)
                && (depth != f32::INFINITY || normal != Vec3::ZERO || visibility.sum::<f32>() != 0.0)
            {
                "missed pixel"
            } else if !self.position(pixel).is_finite() {
                "position"
            } else {
                return None;
            };
            let visibility: Vec<f32> = self.layers.visibility.iter().map(|plane| plane[pixel]).collect();
            Some(format!(
                "{problem} of pixel {pixel}: colour {color}, depth {depth}, normal {normal}, V {visibility:?}"
            ))
        })
    }

    /// Pixels whose visibility of light `light` differs by more than a half from that of all four neighbours, while those agree
    /// and are on the same smooth piece of surface as the pixel; and the number of pixels checked. Acne and leaks look like this.
    pub fn isolated(&self, light: usize) -> (usize, usize) {
        let width = self.frame.image.width() as usize;
        let height = self.frame.image.height() as usize;
        let plane = &self.layers.visibility[light];
        let (mut isolated, mut looked_at) = (0, 0);
        for pixel in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| y * width + x)) {
            let around = [pixel - 1, pixel + 1, pixel - width, pixel + width];
            if !around.iter().all(|&other| self.smooth(pixel, other)) {
                continue;
            }
            looked_at += 1;
            let values = around.map(|other| plane[other]);
            let (low, high) = values.iter().fold((1.0f32, 0.0f32), |(low, high), &v| (low.min(v), high.max(v)));
            let alone = values.iter().all(|value| (value - plane[pixel]).abs() > 0.5);
            isolated += usize::from(alone && high - low < 0.25);
        }
        (isolated, looked_at)
    }

    /// Whether two pixels are on the same smooth piece of surface: normals agree, and the chord is in the tangent plane.
    fn smooth(&self, pixel: usize, other: usize) -> bool {
        let (n, m) = (self.normal(pixel), self.normal(other));
        let chord = self.position(other) - self.position(pixel);
        self.hit(pixel) && self.hit(other) && n.dot(m) > 0.98 && n.dot(chord).abs() < 0.2 * chord.length()
    }

    /// The first pixel whose colour is not the sum of the light groups, but for rounding.
    pub fn ungrouped(&self) -> Option<String> {
        let groups = || self.layers.lights.iter().chain([&self.layers.rest]);
        self.frame.image.color().iter().enumerate().find_map(|(pixel, color)| {
            let sum = groups().map(|plane| DVec3::from(plane[pixel].map(f64::from))).sum::<DVec3>();
            let apart = (sum - DVec3::from(color.map(f64::from))).abs();
            // Sums of some hundreds of terms. What is no number is not within.
            let within = apart.cmple(DVec3::splat(1e-6) + 1e-5 * sum.abs()).all();
            (!within).then(|| format!("pixel {pixel}: {color:?}, but groups of {sum}"))
        })
    }

    /// All values of the image as bits: equal images have equal lists.
    pub fn bits(&self) -> Vec<u32> {
        let colors = self.frame.image.color().as_flattened();
        let vectors = [&self.layers.normal, &self.layers.position].into_iter().flat_map(|plane| plane.as_flattened());
        let floats =
            colors.iter().chain(vectors).chain(&self.layers.depth).chain(self.layers.visibility.iter().flatten());
        let groups = self.layers.lights.iter().chain([&self.layers.rest]).flat_map(|plane| plane.as_flattened());
        let floats = floats.chain(groups);
        let mattes = [&self.layers.object, &self.layers.material];
        let ranks = || mattes.into_iter().flat_map(|matte| &matte.ranks);
        let floats = floats.chain(ranks().flat_map(|rank| &rank.share));
        let numbers = mattes.into_iter().map(|matte| &matte.nearest).chain(ranks().map(|rank| &rank.number));
        let numbers = numbers.chain([&self.layers.used]).flatten().copied();
        floats.map(|value| value.to_bits()).chain(numbers).collect()
    }
}

/// Mean of |a − b|. Panics if there is nothing to compare.
pub fn mean_difference(a: &[f32], b: &[f32]) -> f64 {
    assert!(a.len() == b.len() && !a.is_empty(), "{} and {} values", a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / a.len() as f64
}

/// Root of the mean square of a − b. Panics if there is nothing to compare.
pub fn rms_difference(a: &[f32], b: &[f32]) -> f64 {
    assert!(a.len() == b.len() && !a.is_empty(), "{} and {} values", a.len(), b.len());
    (a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use lightmesh_image::Frame as Image;
    use lightmesh_render::{Mode, Settings};

    use super::*;
    use crate::{BALL_LIGHT, open_floor, render};

    /// A fully lit floor that fills the image.
    fn floor() -> Frame {
        let mut scene = open_floor(BALL_LIGHT);
        scene.cameras[0].position = Vec3::new(0.0, 1.0, 0.0);
        scene.cameras[0].direction = Vec3::NEG_Y;
        scene.cameras[0].up = Vec3::NEG_Z;
        render(&scene, &Settings::default().with_mode(Mode::RayTrace).with_size([16, 16]))
    }

    /// The same with its layers or colours changed.
    fn spoiled(spoil: impl FnOnce(&mut Vec<[f32; 3]>, &mut Layers)) -> Frame {
        let mut frame = floor();
        let (mut color, mut layers) = (frame.image.color().to_vec(), frame.image.layers().unwrap().clone());
        spoil(&mut color, &mut layers);
        frame.image = Image::new(16, 16, color).unwrap().with_layers(layers).unwrap();
        frame
    }

    #[test]
    fn faults_are_found() {
        let whole = floor();
        assert_eq!(Picture::new(&whole).fault(), None);
        let frames = [
            spoiled(|color, _| color[7][1] = f32::NAN),
            spoiled(|color, _| color[7][1] = -0.1),
            spoiled(|_, layers| layers.visibility[0][7] = 1.1),
            spoiled(|_, layers| layers.visibility[0][7] = f32::NAN),
            spoiled(|_, layers| layers.depth[7] = f32::NAN),
            spoiled(|_, layers| layers.normal[7] = [0.0, 0.5, 0.0]),
            spoiled(|_, layers| layers.depth[7] = f32::INFINITY),
            spoiled(|_, layers| layers.position[7][0] = f32::NAN),
        ];
        for spoil in [(|layers: &mut Layers| layers.lights[0][7][1] += 0.1) as fn(&mut Layers), |layers| {
            layers.rest[7][1] = f32::NAN
        }] {
            let frame = spoiled(|_, layers| spoil(layers));
            assert_eq!(Picture::new(&whole).ungrouped(), None);
            assert!(Picture::new(&frame).ungrouped().is_some_and(|found| found.starts_with("pixel 7:")));
            assert!(Picture::new(&frame).bits() != Picture::new(&whole).bits());
        }
        for spoil in [(|layers: &mut Layers| layers.object.nearest[7] = 9) as fn(&mut Layers), |layers| {
            layers.material.ranks[0].share[7] = 0.5
        }] {
            assert!(Picture::new(&spoiled(|_, layers| spoil(layers))).bits() != Picture::new(&whole).bits());
        }
        for (index, frame) in frames.iter().enumerate() {
            assert!(Picture::new(frame).fault().is_some_and(|fault| fault.contains("pixel 7")), "frame {index}");
            assert!(Picture::new(frame).bits() != Picture::new(&whole).bits(), "frame {index}");
        }
    }

    #[test]
    fn a_speckle_is_found_and_a_shadow_s_edge_is_not() {
        assert_eq!(Picture::new(&floor()).isolated(0), (0, 14 * 14));
        let speckled = spoiled(|_, layers| layers.visibility[0][5 * 16 + 5] = 0.0);
        assert_eq!(Picture::new(&speckled).isolated(0).0, 1);
        let edge = spoiled(|_, layers| layers.visibility[0][..8 * 16].fill(0.0));
        assert_eq!(Picture::new(&edge).isolated(0).0, 0);
    }

    #[test]
    fn differences_are_measured() {
        assert_eq!(mean_difference(&[0.0, 1.0], &[0.5, 0.5]), 0.5);
        assert_eq!(mean_difference(&[0.25], &[0.25]), 0.0);
        assert!((rms_difference(&[0.0, 0.0], &[0.0, 1.0]) - 0.5f64.sqrt()).abs() < 1e-12);
    }
}
