//! A studio for models that bring no light, as photographers of products set it up: a ground that fades into the background, a large key light at
//! the upper left, and around it soft boxes and a gradient, which fill shadows and are what metals mirror.
//!
//! The ground [catches shadows](Scene::add_ground): elsewhere it shows the background, so there is no horizon. All of it is placed relative to
//! the camera, and upright.

use glam::Vec3;

use crate::{Bounds, Camera, Environment, Light, LightKind, Scene, Up};

/// Radiance of the background.
const BACKGROUND: f32 = 0.65;
/// What a white surface that faces the key light gets of it, and one that faces up gets of the surroundings: together less than 1 with the usual
/// reflectance.
const KEY: f32 = 0.62;
const SURROUNDINGS: f32 = 0.48;

/// Where the key light is, seen from the model: to the left, up, and towards the camera.
const KEY_PLACE: [f32; 3] = [0.55, 1.1, 0.6];
/// How far it is, and its radius, as shares of the diagonal of what is framed.
const KEY_DISTANCE: f32 = 2.0;
const KEY_RADIUS: f32 = 0.14;

/// Size of the panorama in texels.
const SIZE: [u32; 2] = [512, 256];
/// Relative radiances without boxes: straight up, at the horizon behind the model and behind the camera, straight down.
const ZENITH: f32 = 0.9;
const AHEAD: f32 = 0.75;
const BEHIND: f32 = 0.12;
const FLOOR: f32 = 0.5;

/// A soft box.
struct SoftBox {
    /// To the right, up, and towards the camera.
    place: [f32; 3],
    /// Tangents of half its angles across and upwards.
    half: [f32; 2],
    radiance: f32,
}

/// The large one around the key light, its bright middle, a strip at the right, one above and behind the model, and a small window behind the camera.
const BOXES: [SoftBox; 5] = [
    SoftBox { place: [-0.9, 0.75, 0.45], half: [0.55, 0.45], radiance: 3.2 },
    SoftBox { place: [-KEY_PLACE[0], KEY_PLACE[1], KEY_PLACE[2]], half: [0.12, 0.12], radiance: 6.0 },
    SoftBox { place: [1.0, 0.45, 0.15], half: [0.14, 0.6], radiance: 2.6 },
    SoftBox { place: [0.1, 1.0, -0.9], half: [0.8, 0.16], radiance: 2.4 },
    SoftBox { place: [0.35, 0.45, 1.0], half: [0.12, 0.16], radiance: 2.2 },
];
/// How far the edge of a box is blurred, in units of the tangents.
const SOFT: f32 = 0.06;

/// Directions in the studio: to the right, up, and towards the camera, all level or upright.
struct Frame {
    right: Vec3,
    up: Vec3,
    back: Vec3,
}

impl Frame {
    fn of(camera: &Camera, up: Up) -> Frame {
        let (right, _, _) = camera.basis();
        let up = up.axis();
        // A camera may lie on its side.
        let level = |way: Vec3| (way - way.dot(up) * up).try_normalize();
        let right = level(right).unwrap_or_else(|| up.any_orthonormal_vector());
        Frame { right, up, back: right.cross(up) }
    }

    fn way(&self, [right, up, back]: [f32; 3]) -> Vec3 {
        (right * self.right + up * self.up + back * self.back).normalize()
    }
}

impl Scene {
    /// Lights the scene as a studio: its only light is a key light, it stands in a panorama and on a [ground](Scene::add_ground), before a light
    /// grey background.
    pub(crate) fn light_as_studio(&mut self, framed: &Bounds, camera: &Camera, up: Up) {
        let frame = Frame::of(camera, up);
        let [left, above, back] = KEY_PLACE;
        let position = framed.center() + KEY_DISTANCE * framed.diagonal() * frame.way([-left, above, back]);
        let key = LightKind::Sphere { position, radius: KEY_RADIUS * framed.diagonal() };
        let lights = &mut self.lights;
        lights.list = vec![Light::new(key).with_intensity(Vec3::splat(KEY)).named("key")];
        lights.environment = Some(panorama(&frame, up).into());
        lights.background = Some(Vec3::splat(BACKGROUND));
        lights.studio = true;
        self.add_ground(up);
    }
}

fn panorama(frame: &Frame, up: Up) -> Environment {
    let boxes = BOXES.map(|one| {
        let toward = frame.way(one.place);
        let across = frame.up.cross(toward).normalize();
        (toward, across, toward.cross(across), one.half, one.radiance)
    });
    let seen = |way: Vec3| {
        let (height, back) = (way.dot(frame.up), way.dot(frame.back));
        let level = (back / (1.0 - height * height).max(f32::MIN_POSITIVE).sqrt()).clamp(-1.0, 1.0);
        let horizon = AHEAD + (BEHIND - AHEAD) * smooth(0.5 + 0.5 * level);
        let end = if height > 0.0 { ZENITH } else { FLOOR };
        let plain = horizon + (end - horizon) * smooth(height.abs().sqrt());
        let lit = boxes.iter().map(|&(toward, across, upwards, half, radiance)| {
            let along = way.dot(toward);
            let place = [way.dot(across), way.dot(upwards)].map(|aside| (aside / along.max(f32::MIN_POSITIVE)).abs());
            let within = |axis: usize| smooth(0.5 + (half[axis] - place[axis]) / (2.0 * SOFT));
            if along > 0.0 { radiance * within(0) * within(1) } else { 0.0 }
        });
        Vec3::splat(plain + lit.sum::<f32>())
    };
    let panorama = Environment::seen("studio", SIZE, up, seen);
    let received = panorama.irradiance(frame.up).x * std::f32::consts::FRAC_1_PI;
    panorama.scaled(SURROUNDINGS / received)
}

/// From 0 to 1 without a kink at the ends.
fn smooth(at: f32) -> f32 {
    let at = at.clamp(0.0, 1.0);
    at * at * (3.0 - 2.0 * at)
}
