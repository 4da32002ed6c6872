//! The lights of a scene.

use std::f32::consts::PI;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{
    bounds::Bounds,
    environment::{Environment, Surroundings},
    light::{Falloff, Light, LightKind},
};

/// The default ambient term as a share of what the lights give.
const DEFAULT_AMBIENT: f32 = 0.1;
/// The cosine between the way of a light and the direction to its disc: single precision errs by less.
const SAME: f32 = -0.999_999;

/// Whether light that travels along `direction` comes from a disc around `toward`.
fn is_disc(direction: Vec3, toward: Vec3) -> bool {
    direction.dot(toward) < SAME
}

/// The lights of a scene, and the ambient light. Dereferences to the list of lights.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Lights {
    /// The lights; may be empty.
    pub list: Vec<Light>,
    /// I_a of formula (1), per channel; `None` if the file does not set it.
    pub ambient: Option<Vec3>,
    /// Radiance of camera rays that hit nothing, and of all rays if there is no environment; `None` if the file does not set it.
    pub background: Option<Vec3>,
    /// What surrounds the scene: the camera sees it unless there is a background, mirrors always. A sun in it is also in the list.
    pub environment: Option<Arc<Environment>>,
    /// Whether the list is as it is meant to be: [`Scene::complete`](crate::Scene::complete) adds none, even if there are none.
    pub chosen: bool,
    /// Whether they are those of a [studio](crate::Lighting::Studio), whose environment is meant to light surfaces by direction, without
    /// shadows, and to be mirrored.
    pub studio: bool,
    /// Whether it is that of a [room](crate::Added::lamp), whose surfaces light each other.
    pub room: bool,
    /// Whether the environment is that of a view [outdoors](crate::Scene::complete_outdoors), which is meant to be mirrored, too.
    pub outdoors: bool,
}

impl Lights {
    /// Other lights with the same ambient intensity and background.
    pub fn with_list(self, list: Vec<Light>) -> Lights {
        Lights { list, ..self }
    }

    /// The same, without any default lights added.
    pub fn as_chosen(self) -> Lights {
        Lights { chosen: true, ..self }
    }

    /// I_a of formula (1), per channel.
    pub fn with_ambient(self, ambient: impl Into<Vec3>) -> Lights {
        Lights { ambient: Some(ambient.into()), ..self }
    }

    /// The light of a sky or a panorama, in which the scene stands from now on: it takes the place of the ambient light, the background
    /// and all directional lights; other lights stay.
    pub fn surround(&mut self, surroundings: Surroundings) {
        self.list.retain(|light| !matches!(light.kind, LightKind::Directional { .. }));
        (self.ambient, self.background) = (None, None);
        self.add(surroundings);
    }

    /// The light of a sky or a panorama in addition to all others.
    pub fn add(&mut self, Surroundings { environment, sun, discs }: Surroundings) {
        (self.studio, self.room) = (false, false);
        self.list.splice(0..0, sun.into_iter().chain(discs));
        self.environment = Some(environment.into());
    }

    /// I_a if it is not set, for a scene within `bounds`: the mean radiance of the environment, or else a tenth of what a white surface shows that faces a light of intensity 1 without
    /// falloff; and if all lights have falloff, a tenth of what it shows at the centre with all of them facing it. So the ambient term has
    /// the unit of the lights.
    pub fn default_ambient(&self, bounds: &Bounds) -> Vec3 {
        if let Some(environment) = &self.environment {
            return environment.mean();
        }
        if self.list.is_empty() || self.list.iter().any(|light| light.falloff == Falloff::None) {
            return Vec3::splat(DEFAULT_AMBIENT);
        }
        Vec3::splat(DEFAULT_AMBIENT * self.shown(bounds))
    }

    /// What a white surface at the middle of `bounds` shows that all lights with falloff face.
    fn shown(&self, bounds: &Bounds) -> f32 {
        // A lamp at the centre itself would be infinitely near.
        let nearest = (0.25 * bounds.diagonal()).max(f32::MIN_POSITIVE);
        let shown = |light: &Light| {
            let distance = light.position().map_or(1.0, |position| position.distance(bounds.center()).max(nearest));
            light.intensity.element_sum() / (3.0 * PI * distance * distance)
        };
        self.list.iter().map(shown).sum::<f32>().min(f32::MAX)
    }

    /// Whether what surrounds the scene shows a light: it is the sun, or a part of the image.
    pub fn surroundings_show(&self, light: &Light) -> bool {
        let (LightKind::Directional { direction, .. }, Some(environment)) = (&light.kind, &self.environment) else {
            return false;
        };
        let mut discs = environment.sun().into_iter().chain(environment.discs());
        discs.any(|disc| is_disc(*direction, disc.direction))
    }

    /// Whether a light is the sun of what surrounds the scene, which its image does not show.
    pub fn sun_is(&self, light: &Light) -> bool {
        let sun = self.environment.as_ref().and_then(|environment| environment.sun());
        matches!(light.kind, LightKind::Directional { direction, .. } if sun.is_some_and(|sun| is_disc(direction, sun.direction)))
    }

    /// Whether rays see a light as a surface of its own: it shines and has an area, and neither a lamp nor what surrounds the scene shows it. What
    /// the key light of a studio is in mirrors, its panorama shows.
    pub fn is_shown(&self, light: &Light) -> bool {
        let shines = light.has_size() && light.intensity != Vec3::ZERO;
        shines && !self.studio && !light.lamp && !self.surroundings_show(light)
    }

    /// Whether there is a light that rays see as a surface of its own.
    pub fn any_is_shown(&self) -> bool {
        self.list.iter().any(|light| self.is_shown(light))
    }

    /// Whether there are lights, all of them those of lamps.
    pub fn are_lamps(&self) -> bool {
        !self.list.is_empty() && self.list.iter().all(|light| light.lamp)
    }

    /// Radiance of rays that hit nothing.
    pub fn with_background(self, background: impl Into<Vec3>) -> Lights {
        Lights { background: Some(background.into()), ..self }
    }
}

impl Deref for Lights {
    type Target = Vec<Light>;

    fn deref(&self) -> &Vec<Light> {
        &self.list
    }
}

impl DerefMut for Lights {
    fn deref_mut(&mut self) -> &mut Vec<Light> {
        &mut self.list
    }
}

impl From<Vec<Light>> for Lights {
    /// These lights, with the defaults for everything else.
    fn from(list: Vec<Light>) -> Lights {
        Lights { list, ..Lights::default() }
    }
}

impl FromIterator<Light> for Lights {
    fn from_iter<I: IntoIterator<Item = Light>>(lights: I) -> Lights {
        lights.into_iter().collect::<Vec<Light>>().into()
    }
}

impl<'a> IntoIterator for &'a Lights {
    type Item = &'a Light;
    type IntoIter = std::slice::Iter<'a, Light>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter()
    }
}

impl<'a> IntoIterator for &'a mut Lights {
    type Item = &'a mut Light;
    type IntoIter = std::slice::IterMut<'a, Light>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter_mut()
    }
}

impl IntoIterator for Lights {
    type Item = Light;
    type IntoIter = std::vec::IntoIter<Light>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}
