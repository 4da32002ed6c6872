//! Cameras and lights for scenes without any, and cameras by name.
//!
//! What is seen from outside is framed from the front; what is an interior is seen from its open side or from inside (`rooms`). Lights are placed
//! relative to the camera, or in the space that it sees if those do not reach it (`lights`). Both cast a few thousand rays (`rays`, `sight`).

mod lights;
mod rays;
mod rooms;
mod sight;

use std::cell::LazyCell;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::{
    Bounds, Camera, Fov, Light, Mesh, Projection, Scene, Up,
    quote::{self, list},
};
use rooms::Interior;
use sight::Sight;

/// No camera of the scene has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no camera named `{}`, scene {scene}; {}", quote::name(name), match known.is_empty() {
    true => "it has no named cameras: give a position and a target instead".to_owned(),
    false => format!("available: {}", list(known.iter().map(String::as_str))),
})]
#[non_exhaustive]
pub struct UnknownCamera {
    /// The requested name.
    pub name: String,
    /// The scene.
    pub scene: String,
    /// Names of its cameras.
    pub known: Vec<String>,
}

/// Vertical field of view of the camera that frames a scene, degrees.
const VFOV: f32 = 40.0;
/// With more triangles than this, instances count as boxes where a view is chosen.
const OUTLINE: usize = 1 << 21;

/// Share of the image's half height that the framed scene fills.
const FILL: f32 = 0.92;

/// Position of the framing camera relative to the scene's centre: to the right, above and in front.
const VIEW: [f32; 3] = [0.55, 0.45, 1.0];

/// Radius over which area mode distributes these lights, as a share of the scene's diagonal.
const DEFAULT_LIGHT_SPREAD: f32 = 0.05;

/// Strength of the key light. With the fill light and the ambient term, a white surface is not clipped.
const KEY_LIGHT: f32 = 0.8;
/// Strength of the fill light.
const FILL_LIGHT: f32 = 0.2;

/// What [`Scene::complete`] had to add.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Added {
    /// A camera that shows the scene.
    pub camera: bool,
    /// From where it does.
    pub viewpoint: Viewpoint,
    /// A key light and a fill light.
    pub lights: bool,
    /// They are in the space that the camera sees, with more ambient light, since lights outside would not reach it.
    pub lights_inside: bool,
}

/// From where a [default camera](Scene::default_camera) looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Viewpoint {
    /// From the front, the right and above, outside.
    #[default]
    Front,
    /// Into an interior, through its open side.
    OpenSide,
    /// Inside, along the longest view.
    Inside,
}

impl Scene {
    /// Completes the scene so that it can be rendered: adds [`Scene::default_camera`] if it has no camera, and
    /// [`Scene::default_lights`], placed relative to its first camera, if it has no light, or only lamps too faint to light it,
    /// unless they are [chosen](crate::Lights::chosen); with lights inside, also an ambient term of 0.2 if none is set. Returns what
    /// was added.
    pub fn complete(&mut self, up: Up) -> Added {
        let mut added = Added {
            camera: self.cameras.is_empty(),
            lights: self.lights.are_missing(&self.geometry.mesh.bounds()),
            ..Added::default()
        };
        // Needed for what is missing alone, and once for both.
        let geometry = Arc::clone(&self.geometry);
        let outline = LazyCell::new(|| geometry.mesh.outline(OUTLINE));
        let sight = LazyCell::new(|| Sight::new(&outline));
        if added.camera {
            let (camera, viewpoint) = self.view(&sight, up);
            self.cameras.push(camera);
            added.viewpoint = viewpoint;
        }
        if added.lights {
            let (lights, inside) = self.lighting(&sight, &self.cameras[0]);
            self.lights.extend(lights);
            added.lights_inside = inside;
            if inside {
                self.lights.ambient.get_or_insert(Vec3::splat(lights::AMBIENT));
            }
        }
        added
    }

    /// A camera that shows the whole scene from the front, the right and above, for square images and wider ones. An interior (most of its
    /// ground plan is in rooms, and from there it shows backs of walls or hardly anything) is instead seen through its open side if it has
    /// one, else from inside: at eye height, along the longest view, with a field of view of 60°.
    pub fn default_camera(&self, up: Up) -> Camera {
        self.view(&Sight::new(&self.geometry.mesh.outline(OUTLINE)), up).0
    }

    fn view(&self, sight: &Sight, up: Up) -> (Camera, Viewpoint) {
        let mesh = sight.mesh();
        let bounds = framed(mesh.bounds());
        let (right, front) = sides(up);
        let from = |direction: Vec3| {
            let mut camera = Camera {
                name: "default".to_owned(),
                position: bounds.center(),
                direction,
                up: up.axis(),
                projection: Projection::Perspective(Fov::Vertical(VFOV)),
                shift: Vec2::ZERO,
                motion: None,
            };
            camera.position = fitting(mesh, &bounds, &camera);
            camera
        };
        let camera = from(-(VIEW[0] * right + VIEW[1] * up.axis() + VIEW[2] * front).normalize());
        match rooms::interior(sight, &bounds, up.axis(), &camera) {
            None => (camera, Viewpoint::Front),
            Some(Interior::OpenSide(direction)) => (from(direction), Viewpoint::OpenSide),
            Some(Interior::Inside(camera)) => (camera, Viewpoint::Inside),
        }
    }

    /// Two white point lights without falloff. The key light is above and to the side of the camera's eye, so that shadows fall away
    /// from the viewer and to the side; the fill light, weaker and lower, is on the other side, so that they are not black. If the key light
    /// reaches less than a fifth of what the camera sees, they are in the space that it sees: the key light high above the middle of the
    /// way ahead, the fill light above the eye; then they are weaker, since an ambient term of 0.2 goes with them.
    pub fn default_lights(&self, camera: &Camera) -> [Light; 2] {
        self.lighting(&Sight::new(&self.geometry.mesh.outline(OUTLINE)), camera).0
    }

    /// The lights, and whether they are inside.
    fn lighting(&self, sight: &Sight, camera: &Camera) -> ([Light; 2], bool) {
        let bounds = framed(self.geometry.mesh.bounds());
        let (right, up, _) = camera.basis();
        let reach = camera.position.distance(bounds.center()).max(bounds.diagonal());
        let spread = DEFAULT_LIGHT_SPREAD * bounds.diagonal();
        let place = |beside: f32, above: f32| camera.position + reach * (above * up + beside * right);
        let key = place(-0.5, 0.8);
        if let Some(lights) = lights::inside(sight, &bounds, camera, key, spread) {
            return (lights, true);
        }
        let light = |name: &str, position: Vec3, intensity: f32| {
            Light::point(position).with_spread(spread).with_intensity(Vec3::splat(intensity)).named(name)
        };
        ([light("key", key, KEY_LIGHT), light("fill", place(0.9, 0.2), FILL_LIGHT)], false)
    }

    /// The camera of this name.
    ///
    /// # Errors
    ///
    /// [`UnknownCamera`] lists the available names.
    pub fn camera(&self, name: &str) -> Result<&Camera, UnknownCamera> {
        self.cameras.iter().find(|camera| camera.name == name).ok_or_else(|| UnknownCamera {
            name: name.to_owned(),
            scene: self.name.clone(),
            known: self.cameras.iter().map(|camera| camera.name.clone()).filter(|name| !name.is_empty()).collect(),
        })
    }
}

/// The directions right and towards the viewer, for a viewer in front of a model.
fn sides(up: Up) -> (Vec3, Vec3) {
    match up {
        Up::Y => (Vec3::X, Vec3::Z),
        Up::Z => (Vec3::X, Vec3::NEG_Y),
    }
}

/// Where a camera of this direction has to be so that all vertices fit in a square image, in its middle.
///
/// In coordinates to the right, up and forward, with T the tangent of half the field of view, a point is left of the right border of a
/// camera at c if `x - c.x <= T (z - c.z)`, so the largest `x - T z` of all points bounds `c.x - T c.z`; and so for each border. The
/// two borders of an axis fix the camera's place across it, and the axis with the larger distance decides that.
fn fitting(mesh: &Mesh, bounds: &Bounds, camera: &Camera) -> Vec3 {
    let (right, up, forward) = camera.basis();
    let tangent = FILL * (0.5 * VFOV).to_radians().tan();
    let center = bounds.center();
    let mut borders = [f32::NEG_INFINITY; 4];
    let mut include = |point: Vec3| {
        let point = point - center;
        let (x, y, z) = (point.dot(right), point.dot(up), point.dot(forward));
        for (border, aside) in borders.iter_mut().zip([x, -x, y, -y]) {
            *border = border.max(aside - tangent * z);
        }
    };
    if mesh.bounds() == *bounds {
        mesh.positions.iter().for_each(|&position| include(position));
    } else {
        (0..8).map(|i| corner(bounds, i)).for_each(include);
    }
    let [east, west, north, south] = borders;
    let back = ((east + west).max(north + south) / (2.0 * tangent)).max(0.0);
    center + 0.5 * (east - west) * right + 0.5 * (north - south) * up - back * forward
}

/// One of the eight corners of a box.
fn corner(Bounds { min, max }: &Bounds, i: u32) -> Vec3 {
    let pick = |bit: u32, low: f32, high: f32| if i & bit == 0 { low } else { high };
    Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
}

/// The box to frame: a unit cube if the scene is empty or a single point.
fn framed(bounds: Bounds) -> Bounds {
    let center = if bounds.is_empty() { Vec3::ZERO } else { bounds.center() };
    if bounds.diagonal() > 0.0 { bounds } else { Bounds { min: center - 0.5, max: center + 0.5 } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneBuilder;

    fn corners(bounds: Bounds) -> [Vec3; 8] {
        std::array::from_fn(|i| corner(&bounds, i as u32))
    }

    /// The corners of a box.
    fn scene(min: Vec3, max: Vec3) -> Scene {
        let mut scene = SceneBuilder::new().finish_scene("test");
        scene.geometry_mut().mesh.positions = corners(Bounds { min, max }).to_vec();
        scene.geometry_mut().mesh.triangles = vec![[0, 1, 2]];
        scene
    }

    /// How far points go to the right, left, up and down from the image's centre, in half heights.
    fn extents_in_picture(points: &[Vec3], camera: &Camera) -> [f32; 4] {
        let (right, up, forward) = camera.basis();
        let tangent = (0.5 * VFOV).to_radians().tan();
        points.iter().map(|&point| point - camera.position).fold([f32::NEG_INFINITY; 4], |extents, p| {
            let scale = 1.0 / (tangent * p.dot(forward));
            let sides = [p.dot(right), -p.dot(right), p.dot(up), -p.dot(up)];
            std::array::from_fn(|side| extents[side].max(scale * sides[side]))
        })
    }

    fn assert_framed(points: &[Vec3], camera: &Camera) {
        let extents = extents_in_picture(points, camera);
        let most = extents.into_iter().fold(0.0, f32::max);
        assert!((most - FILL).abs() < 1e-3, "{extents:?}");
        // It fills the image from one border to the other.
        let fills = |axis: usize| extents[axis].min(extents[axis + 1]) > FILL - 1e-3;
        assert!(fills(0) || fills(2), "{extents:?}");
    }

    #[test]
    fn all_corners_are_in_the_picture_and_fill_it() {
        let boxes = [
            (Vec3::splat(-1.0), Vec3::ONE),
            (Vec3::new(100.0, 0.0, -7.0), Vec3::new(160.0, 0.0, 20.0)),
            (Vec3::ZERO, Vec3::new(1e-3, 2.0, 1e-3)),
            (Vec3::splat(1e5), Vec3::splat(2e5)),
        ];
        for (min, max) in boxes {
            for up in [Up::Y, Up::Z] {
                assert_framed(&corners(Bounds { min, max }), &scene(min, max).default_camera(up));
            }
        }
    }

    #[test]
    fn what_does_not_fill_its_box_fills_the_picture() {
        let ball: Vec<Vec3> = (0..200)
            .map(|i| {
                let (z, turn) = (i as f32 / 99.5 - 1.0, 2.4 * i as f32);
                Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
            })
            .collect();
        let mut round = scene(Vec3::ZERO, Vec3::ONE);
        round.geometry_mut().mesh.positions = ball.clone();
        assert_framed(&ball, &round.default_camera(Up::Y));
    }

    #[test]
    fn an_empty_scene_has_a_camera_and_a_light_too() {
        let empty = SceneBuilder::new().finish_scene("empty");
        let camera = empty.default_camera(Up::Y);
        assert!(camera.position.is_finite() && camera.position.length() > 1.0);
        assert!(empty.default_lights(&camera).iter().all(|light| light.position().unwrap().is_finite()));
    }

    #[test]
    fn the_key_light_is_above_the_camera_and_a_weaker_one_on_its_other_side() {
        for up in [Up::Y, Up::Z] {
            let scene = scene(Vec3::splat(-3.0), Vec3::splat(5.0));
            let camera = scene.default_camera(up);
            let (right, ..) = camera.basis();
            let [key, fill] = scene.default_lights(&camera);
            let from_camera = |light: &Light| light.position().unwrap() - camera.position;
            assert!(from_camera(&key).dot(up.axis()) > from_camera(&fill).dot(up.axis()) + 1.0);
            assert!(from_camera(&key).dot(right) < -1.0 && from_camera(&fill).dot(right) > 1.0);
            assert!(fill.intensity.max_element() < 0.5 * key.intensity.min_element());
        }
    }

    #[test]
    fn a_scene_is_completed_once() {
        let mut bare = scene(Vec3::ZERO, Vec3::ONE);
        let lit = bare.default_lights(&bare.default_camera(Up::Z));
        assert_eq!(bare.complete(Up::Z), Added { camera: true, lights: true, ..Added::default() });
        assert_eq!((bare.cameras.as_slice(), bare.lights.as_slice()), (&[bare.default_camera(Up::Z)][..], &lit[..]));
        assert_eq!(bare.complete(Up::Y), Added::default());
        // Existing content stays, and lights are placed relative to the first camera.
        let camera = Camera::look_at(Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO, Vec3::Y, 30.0).unwrap();
        bare.cameras = vec![camera.clone(), bare.default_camera(Up::Y)];
        bare.lights.clear();
        assert_eq!(bare.complete(Up::Y), Added { lights: true, ..Added::default() });
        assert_eq!((bare.cameras.len(), bare.lights.as_slice()), (2, &bare.default_lights(&camera)[..]));
    }

    #[test]
    fn an_unknown_camera_is_answered_with_the_known() {
        let mut scene = scene(Vec3::ZERO, Vec3::ONE);
        let message = |scene: &Scene| scene.camera("top").unwrap_err().to_string();
        assert!(message(&scene).contains("no named cameras"));
        scene.cameras.push(Camera { name: "front".into(), ..scene.default_camera(Up::Y) });
        assert_eq!(message(&scene), "there is no camera named `top`, scene test; available: front");
        assert_eq!(scene.camera("front").unwrap().name, "front");
    }
}
