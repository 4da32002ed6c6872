//! A frame moved to where the next one sees its surfaces, and what has changed.

use lightmesh::glam::{DVec3, Vec3};
use lightmesh::image::{self, CompareError, Frame, Transfer};
use lightmesh::scene::Camera;

/// Normals of one surface, from pixel to pixel, by cosine.
const SAME_NORMAL: f32 = 0.95;
/// How far the pixels of one surface are from its plane: a part of the distance between the surface points of two pixels.
const SAME_PLANE: f32 = 0.1;

/// A frame with its layers, and the camera that saw it.
pub(super) struct Shot {
    pub(super) camera: Camera,
    pub(super) frame: Frame,
}

/// What has changed on the surfaces that both frames show.
#[derive(Clone, Debug)]
pub(super) struct Change {
    /// Mean FLIP.
    pub(super) flicker: f64,
    /// That of gathered light alone.
    pub(super) gathered_flicker: f64,
    /// The mean change of a channel of gathered light, in codes of 8 bits.
    pub(super) steps: f64,
    /// The share of the pixels that are compared.
    pub(super) compared: f64,
}

/// Pixels of the earlier frame around a point, with their weights.
type Taps = [(usize, f32); 4];

/// What changed from one frame to the next, exposed by `stops`. Mean FLIP is over the pixels that are compared: elsewhere the frames are made
/// equal, so that FLIP is 0 there.
pub(super) fn change(before: &Shot, now: &Shot, stops: f32) -> Result<Change, CompareError> {
    let taps = taps(before, now);
    let compared = taps.iter().flatten().count() as f64 / taps.len() as f64;
    let pair = |plane: for<'f> fn(&'f Frame) -> &'f [[f32; 3]]| {
        let [mut earlier, later] = [&before.frame, &now.frame].map(plane).map(<[_]>::to_vec);
        let moved = |taps: &Taps| taps.iter().map(|&(pixel, weight)| weight * Vec3::from(earlier[pixel])).sum::<Vec3>();
        let moved =
            taps.iter().zip(&later).map(|(taps, later)| taps.as_ref().map_or(*later, |taps| moved(taps).into()));
        earlier = moved.collect();
        [earlier, later].map(|colors| {
            let mut frame = Frame::new(now.frame.width(), now.frame.height(), colors).expect("as large as the frame");
            frame.expose(stops);
            frame
        })
    };
    let flip = |[earlier, later]: &[Frame; 2]| Ok(image::compare(earlier, later)?.mean_flip / compared.max(1e-9));
    let gathered = pair(|frame| frame.layers().map_or(&[], |layers| &layers.rest));
    let codes = gathered.each_ref().map(|frame| frame.color().as_flattened().iter().map(|&value| code(value)));
    let [earlier, later] = codes;
    let steps: f64 = earlier.zip(later).map(|(a, b)| (a - b).abs()).sum();
    Ok(Change {
        flicker: flip(&pair(Frame::color))?,
        gathered_flicker: flip(&gathered)?,
        steps: steps / (3.0 * compared.max(1e-9) * taps.len() as f64),
        compared,
    })
}

/// A display value in codes of 8 bits, not rounded.
fn code(linear: f32) -> f64 {
    let below = Transfer::Srgb.encode(linear);
    let [low, high] = [below.saturating_sub(1), below.saturating_add(1)].map(|code| Transfer::Srgb.decode(code));
    let (from, to) = (f64::from(below.saturating_sub(1)), f64::from(below.saturating_add(1)));
    from + (to - from) * f64::from((linear.clamp(low, high) - low) / (high - low))
}

/// Where the earlier frame sees what each pixel sees now; `None` where it sees something else.
fn taps(before: &Shot, now: &Shot) -> Vec<Option<Taps>> {
    let [width, height] = [now.frame.width() as usize, now.frame.height() as usize];
    let aspect = width as f64 / height as f64;
    let to_image = before.camera.from_world_to_image(DVec3::ZERO, aspect);
    let layers = [&before.frame, &now.frame].map(|frame| frame.layers().expect("they were asked for"));
    let (eye, pixel) = (now.camera.position, 2.0 / height as f32);
    let tap = |index: usize| {
        let [before, now] = layers;
        let (position, normal) = (Vec3::from(now.position[index]), Vec3::from(now.normal[index]));
        if !now.depth[index].is_finite() {
            return None;
        }
        let place = to_image * position.as_dvec3().extend(1.0);
        if place.z <= 0.0 {
            return None;
        }
        let x = 0.5 * (place.x / place.w + 1.0) * width as f64 - 0.5;
        let y = 0.5 * (1.0 - place.y / place.w) * height as f64 - 0.5;
        let (column, row) = (x.floor(), y.floor());
        if !(column >= 0.0 && row >= 0.0 && column + 1.0 < width as f64 && row + 1.0 < height as f64) {
            return None;
        }
        let (right, down) = ((x - column) as f32, (y - row) as f32);
        let first = row as usize * width + column as usize;
        let taps = [
            (first, (1.0 - right) * (1.0 - down)),
            (first + 1, right * (1.0 - down)),
            (first + width, (1.0 - right) * down),
            (first + width + 1, right * down),
        ];
        let thick = SAME_PLANE * pixel * (position - eye).length();
        let is_same = |&(tap, _): &(usize, f32)| {
            before.depth[tap].is_finite()
                && before.material.nearest.get(tap) == now.material.nearest.get(index)
                && normal.dot(before.normal[tap].into()) > SAME_NORMAL
                && normal.dot(Vec3::from(before.position[tap]) - position).abs() < thick
        };
        taps.iter().all(is_same).then_some(taps)
    };
    (0..width * height).map(tap).collect()
}

#[cfg(test)]
mod tests {
    use lightmesh::{Device, Renderer, Scene, Settings};

    use super::*;

    /// Childpark in constant light, from its camera and from a little to the right.
    fn shots() -> [Shot; 2] {
        let scene = Scene::open("builtin:childpark").unwrap();
        let renderer = Renderer::new(Device::Cpu).unwrap();
        [0.0, 1.0].map(|aside| {
            let camera = scene.cameras[0].clone();
            let (right, ..) = camera.basis();
            let position = camera.position + aside * right;
            let camera = camera.with_position(position);
            let settings = Settings::default().with_size([240, 180]).with_aa(1).with_layers(true);
            let frame = renderer.render(&scene, &settings.with_camera(camera.clone())).unwrap().image;
            Shot { camera, frame }
        })
    }

    #[test]
    fn what_a_moved_camera_sees_again_is_the_same() {
        let [before, now] = shots();
        let own = change(&before, &now, 0.0).unwrap();
        assert!((0.2..1.0).contains(&own.compared) && own.flicker < 0.04 && own.gathered_flicker < 1e-3, "{own:?}");
        // Without moving it, the frames differ.
        let still = Shot { camera: now.camera.clone(), frame: before.frame.clone() };
        assert!(change(&still, &now, 0.0).unwrap().flicker > 2.0 * own.flicker);
        let same = change(&now, &Shot { camera: now.camera.clone(), frame: now.frame.clone() }, 0.0).unwrap();
        assert!(same.flicker < 1e-4 && same.steps < 1e-3, "{same:?}");
    }

    #[test]
    fn light_that_changes_is_found() {
        let [before, mut now] = shots();
        let own = change(&before, &now, 0.0).unwrap();
        now.frame.color_mut().as_flattened_mut().iter_mut().for_each(|value| *value *= 1.3);
        let brighter = change(&before, &now, 0.0).unwrap();
        assert!(brighter.flicker > own.flicker + 0.02 && brighter.steps == own.steps, "{own:?} {brighter:?}");
    }

    #[test]
    fn codes_are_not_rounded() {
        for value in [0.0, 0.001, 0.2, 0.7, 1.0] {
            let encoded =
                255.0 * if value <= 0.0031308 { 12.92 * value } else { 1.055 * f64::powf(value, 1.0 / 2.4) - 0.055 };
            assert!((code(value as f32) - encoded).abs() < 0.02, "{value}: {} and {encoded}", code(value as f32));
        }
    }
}
