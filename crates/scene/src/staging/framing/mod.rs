//! Cameras and lights for scenes without any, and cameras by name.
//!
//! What is seen from outside is framed from the front, without strays (`strays`); what is an interior is seen from its open side or from inside (`rooms`). Lights are placed
//! relative to the camera, or in the space that it sees if those do not reach it (`lights`). Both cast a few thousand rays (`rays`, `sight`).

pub(crate) mod fitting;
mod lights;
mod rays;
mod rooms;
pub(crate) mod sight;
mod strays;

use std::cell::LazyCell;
use std::sync::Arc;

use glam::Vec3;

use crate::build::quote::{self, list};
use crate::{Camera, Light, Scene, Up};
use fitting::{FILL, framing};
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

/// With more triangles than this, instances count as boxes where a view is chosen.
const OUTLINE: usize = 1 << 21;

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
