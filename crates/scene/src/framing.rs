//! Cameras and lights for scenes without any, and cameras by name.
//!
//! What is seen from outside is framed from the front, without strays (`strays`); what is an interior is seen from its open side or from inside (`rooms`). Lights are placed
//! relative to the camera, or in the space that it sees if those do not reach it (`lights`). Both cast a few thousand rays (`rays`, `sight`).

mod lights;
mod rays;
mod rooms;
pub(crate) mod sight;
mod strays;

use std::cell::LazyCell;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::{
    Bounds, Camera, Fov, Light, Mesh, Projection, Scene, Up,
    quote::{self, list},
};
use rooms::Interior;
use sight::Sight;
use strays::Subject;

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
pub const VFOV: f32 = 40.0;
/// With more triangles than this, instances count as boxes where a view is chosen.
const OUTLINE: usize = 1 << 21;

/// Share of the image's half height that the framed scene fills.
pub const FILL: f32 = 0.92;

/// Position of the framing camera relative to the scene's centre: to the right, above and in front.
const VIEW: [f32; 3] = [0.55, 0.45, 1.0];

/// The same under a sky: it looks down by 12°, so that the horizon is in the upper part of the image.
const VIEW_OUTDOORS: [f32; 3] = [0.55, 0.2426, 1.0];
/// Share of the image's half height that the framed scene fills there.
const FILL_OUTDOORS: f32 = 0.8;

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
    /// They are those of a [studio](Lighting::Studio), which has a ground, too.
    pub studio: bool,
    /// A lamp below the ceiling of an interior that is seen through its open side, in place of the studio.
    pub lamp: bool,
    /// A ground and haze, by [`Scene::complete_outdoors`].
    pub outdoors: bool,
    /// It is an interior under a sky: what reaches it of that may be any share.
    pub indoors: bool,
}

/// What lights a scene that brings no light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lighting {
    /// A [key light and a fill light](Scene::default_lights).
    #[default]
    KeyAndFill,
    /// A studio: one large key light at the upper left of the camera, a panorama of soft boxes, a ground that catches shadows and shows a light
    /// grey background. A lamp below the ceiling in an interior that is seen through its open side. A key light and a fill light where the key light
    /// would not reach what the camera sees or the camera is inside, and where [ambient light](crate::Lights::ambient) or a background is set.
    Studio,
    /// A studio also in interiors.
    StudioAnywhere,
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
    /// [`Scene::default_lights`], placed relative to its first camera, if it has no light and nothing in it emits any,
    /// unless they are [chosen](crate::Lights::chosen); with lights inside, also an ambient term of 0.2 if none is set. Returns what
    /// was added.
    pub fn complete(&mut self, up: Up) -> Added {
        self.complete_for(up, 1.0)
    }

    /// The same for images of this width, relative to their height: the camera that is added fills such an image.
    pub fn complete_for(&mut self, up: Up, aspect: f32) -> Added {
        self.complete_with(Lighting::KeyAndFill, up, aspect)
    }

    /// The same with other lights. Those of a studio bring a ground, a background and an environment.
    ///
    /// ```
    /// use lightmesh_scene::{Lighting, Scene, Up};
    /// # let mut scene = Scene::new("empty", lightmesh_scene::Geometry::default());
    ///
    /// let added = scene.complete_with(Lighting::Studio, Up::Y, 1.5);
    /// assert!(added.camera && added.studio && scene.lights.environment.is_some());
    /// ```
    pub fn complete_with(&mut self, lighting: Lighting, up: Up, aspect: f32) -> Added {
        let mut added = Added {
            camera: self.cameras.is_empty(),
            lights: self.lights.are_missing(&self.geometry),
            ..Added::default()
        };
        // Needed for what is missing alone, and once for both.
        let geometry = Arc::clone(&self.geometry);
        let outline = LazyCell::new(|| geometry.mesh.outline(OUTLINE));
        let sight = LazyCell::new(|| Sight::new(&outline));
        let subject = LazyCell::new(|| Subject::of(&outline));
        if added.camera {
            let (camera, viewpoint) = view(&sight, &subject, up, aspect);
            self.cameras.push(camera);
            added.viewpoint = viewpoint;
        }
        let is_open = || self.lights.beside_studio(&self.geometry).is_none();
        let may_be_studio = added.lights && lighting != Lighting::KeyAndFill && is_open();
        if may_be_studio && lighting == Lighting::Studio && added.viewpoint == Viewpoint::OpenSide {
            self.lights.list = vec![lights::lamp(&sight, &subject.bounds, &self.cameras[0])];
            self.lights.room = true;
            added.lamp = true;
            return added;
        }
        if added.lights {
            let (lights, inside) = key_and_fill(&sight, &subject, &self.cameras[0]);
            let is_interior = inside || added.viewpoint != Viewpoint::Front;
            if may_be_studio && (lighting == Lighting::StudioAnywhere || !is_interior) {
                added.studio = true;
                let (bounds, camera) = (subject.bounds, self.cameras[0].clone());
                // The geometry is changed where it is, not copied.
                drop((sight, subject));
                drop(outline);
                drop(geometry);
                self.light_as_studio(&bounds, &camera, up);
                return added;
            }
            self.lights.extend(lights);
            added.lights_inside = inside;
            if inside {
                self.lights.ambient.get_or_insert(Vec3::splat(lights::AMBIENT));
            }
        }
        added
    }

    /// A camera that shows the whole scene from the front, the right and above, and fills a square image; small pieces far from
    /// everything else may be left out. An interior (most of its
    /// ground plan is in rooms, and from there it shows backs of walls or hardly anything) is instead seen through its open side if it has
    /// one, else from inside: at eye height, along the longest view, with a field of view of 60°.
    pub fn default_camera(&self, up: Up) -> Camera {
        self.default_camera_for(up, 1.0)
    }

    /// The same for images of this width, relative to their height.
    pub fn default_camera_for(&self, up: Up, aspect: f32) -> Camera {
        let outline = self.geometry.mesh.outline(OUTLINE);
        view(&Sight::new(&outline), &Subject::of(&outline), up, aspect).0
    }

    /// The camera of [`Scene::complete_outdoors`]: [`Scene::default_camera_for`], but lower and farther away where that one looks from the front.
    pub(crate) fn camera_outdoors(&self, up: Up, aspect: f32) -> (Camera, Viewpoint) {
        let outline = self.geometry.mesh.outline(OUTLINE);
        let (sight, subject) = (Sight::new(&outline), Subject::of(&outline));
        let usual = view(&sight, &subject, up, aspect);
        if usual.1 != Viewpoint::Front {
            return usual;
        }
        (framing((&sight, &subject), toward(VIEW_OUTDOORS, up), up, aspect, FILL_OUTDOORS), Viewpoint::Front)
    }

    /// Two white point lights without falloff. The key light is above and to the side of the camera's eye, so that shadows fall away
    /// from the viewer and to the side; the fill light, weaker and lower, is on the other side, so that they are not black. If the key light
    /// reaches less than a fifth of what the camera sees, they are in the space that it sees: the key light high above the middle of the
    /// way ahead, the fill light above the eye; then they are weaker, since an ambient term of 0.2 goes with them.
    pub fn default_lights(&self, camera: &Camera) -> [Light; 2] {
        let outline = self.geometry.mesh.outline(OUTLINE);
        key_and_fill(&Sight::new(&outline), &Subject::of(&outline), camera).0
    }

    /// What stands against a [studio](Lighting::Studio) in this scene: light that it brings, or a background. `None` if nothing does.
    pub fn beside_studio(&self) -> Option<&'static str> {
        self.lights.beside_studio(&self.geometry)
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

fn view(sight: &Sight, subject: &Subject, up: Up, aspect: f32) -> (Camera, Viewpoint) {
    let from = |direction: Vec3| framing((sight, subject), direction, up, aspect, FILL);
    let camera = from(toward(VIEW, up));
    match rooms::interior(sight, &subject.bounds, up.axis(), &camera) {
        None => (camera, Viewpoint::Front),
        Some(Interior::OpenSide(direction)) => (from(direction), Viewpoint::OpenSide),
        Some(Interior::Inside(camera)) => (camera, Viewpoint::Inside),
    }
}

/// The direction of a camera that is at this place relative to what it looks at: to the right, above and in front.
fn toward([beside, above, before]: [f32; 3], up: Up) -> Vec3 {
    let (right, front) = sides(up);
    -(beside * right + above * up.axis() + before * front).normalize()
}

/// A camera of this direction that frames the subject, which fills this share of the image.
fn framing((sight, subject): (&Sight, &Subject), direction: Vec3, up: Up, aspect: f32, fill: f32) -> Camera {
    let mut camera = Camera {
        name: "default".to_owned(),
        position: subject.bounds.center(),
        direction,
        up: up.axis(),
        projection: Projection::Perspective(Fov::Vertical(VFOV)),
        shift: Vec2::ZERO,
        motion: None,
    };
    camera.position = fitting(sight.mesh(), subject, &camera, aspect, fill);
    camera
}

/// The lights, and whether they are inside.
fn key_and_fill(sight: &Sight, Subject { bounds, .. }: &Subject, camera: &Camera) -> ([Light; 2], bool) {
    let (right, up, _) = camera.basis();
    let reach = camera.position.distance(bounds.center()).max(bounds.diagonal());
    let spread = DEFAULT_LIGHT_SPREAD * bounds.diagonal();
    let place = |beside: f32, above: f32| camera.position + reach * (above * up + beside * right);
    let key = place(-0.5, 0.8);
    if let Some(lights) = lights::inside(sight, bounds, camera, key, spread) {
        return (lights, true);
    }
    let light = |name: &str, position: Vec3, intensity: f32| {
        Light::point(position).with_spread(spread).with_intensity(Vec3::splat(intensity)).named(name)
    };
    ([light("key", key, KEY_LIGHT), light("fill", place(0.9, 0.2), FILL_LIGHT)], false)
}

/// The directions right and towards the viewer, for a viewer in front of a model.
fn sides(up: Up) -> (Vec3, Vec3) {
    match up {
        Up::Y => (Vec3::X, Vec3::Z),
        Up::Z => (Vec3::X, Vec3::NEG_Y),
    }
}

/// Calls a function with each point that is framed, in coordinates to the right, up and forward.
type EachPoint<'a> = dyn Fn(&mut dyn FnMut(Vec3)) + 'a;

/// Where a camera of this direction has to be so that all vertices of what it frames fit in this share of an image of this width, relative to its height, in its middle.
///
/// In coordinates to the right, up and forward, with T the tangent of half the field of view along an axis of the image, a point is left of the right border of a
/// camera at c if `x - c.x <= T (z - c.z)`, so the largest `x - T z` of all points bounds `c.x - T c.z`; and so for each border. The
/// axis with the larger distance between its borders decides how far the camera is, and [`middle`] its place across.
fn fitting(mesh: &Mesh, subject: &Subject, camera: &Camera, aspect: f32, fill: f32) -> Vec3 {
    let (right, up, forward) = camera.basis();
    let high = fill * (0.5 * VFOV).to_radians().tan();
    let wide = aspect * high;
    let center = subject.bounds.center();
    let each = |take: &mut dyn FnMut(Vec3)| {
        let seen = |point: Vec3| {
            let point = point - center;
            take(Vec3::new(point.dot(right), point.dot(up), point.dot(forward)));
        };
        if subject.has_vertices(mesh) {
            subject.each_vertex(mesh, seen);
        } else {
            (0..8).map(|i| corner(&subject.bounds, i)).for_each(seen);
        }
    };
    let mut borders = [f32::NEG_INFINITY; 4];
    each(&mut |Vec3 { x, y, z }| {
        for (border, (aside, tangent)) in borders.iter_mut().zip([(x, wide), (-x, wide), (y, high), (-y, high)]) {
            *border = border.max(aside - tangent * z);
        }
    });
    let [east, west, north, south] = borders;
    let back = ((east + west) / (2.0 * wide)).max((north + south) / (2.0 * high)).max(0.0);
    let [x, y] = middle(&each, back, [0.5 * (east - west), 0.5 * (north - south)]);
    center + x * right + y * up - back * forward
}

/// Where across a camera has to be, this far back, so that points reach as far to the right as to the left in its image, and as far up as down: the
/// borders that [`fitting`] found meet only along the axis that decides, and along the other one the points would be beside the middle.
///
/// Of a camera at s, the points at u and v, at the depths p and q, are outermost if (u − s) / p is the largest and (v − s) / q the smallest.
/// They are equally far from the middle where s = (u q + v p) / (p + q). There, others may be outermost: so it is repeated until it stays.
fn middle(each: &EachPoint, back: f32, mut place: [f32; 2]) -> [f32; 2] {
    /// Usual models take two or three.
    const ROUNDS: usize = 8;
    for _ in 0..ROUNDS {
        let mut outermost = [[(f32::NEG_INFINITY, 0.0, 1.0), (f32::INFINITY, 0.0, 1.0)]; 2];
        each(&mut |point| {
            let depth = point.z + back;
            for ((axis, place), [most, least]) in [point.x, point.y].into_iter().zip(place).zip(&mut outermost) {
                let slope = (axis - place) / depth;
                if depth > 0.0 && slope > most.0 {
                    *most = (slope, axis, depth);
                }
                if depth > 0.0 && slope < least.0 {
                    *least = (slope, axis, depth);
                }
            }
        });
        let between = outermost.map(|[(_, u, p), (_, v, q)]| (u * q + v * p) / (p + q));
        let usual = between.iter().all(|place| place.is_finite());
        if !usual || between == place {
            break;
        }
        place = between;
    }
    place
}

/// One of the eight corners of a box.
pub fn corner(Bounds { min, max }: &Bounds, i: u32) -> Vec3 {
    let pick = |bit: u32, low: f32, high: f32| if i & bit == 0 { low } else { high };
    Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
}
