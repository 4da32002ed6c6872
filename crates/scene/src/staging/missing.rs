//! What of the light of a scene is missing, and what stands against a studio.

use crate::{Geometry, Lights, Scene};

impl Lights {
    /// Whether a scene with this geometry needs other lights: it has none, and nothing in it emits light.
    pub(crate) fn are_missing(&self, geometry: &Geometry) -> bool {
        !self.chosen && self.environment.is_none() && self.list.is_empty() && !geometry.glows()
    }

    /// What of a scene with this geometry a [studio](crate::Lighting::Studio) would replace, or be seen before.
    pub(crate) fn beside_studio(&self, geometry: &Geometry) -> Option<&'static str> {
        let things = [
            (!self.list.is_empty(), "lights of its own"),
            (self.environment.is_some(), "surroundings that light it"),
            (geometry.glows(), "surfaces that emit light"),
            (self.chosen, "lights that were chosen, even if there are none"),
            (self.ambient.is_some(), "ambient light of its own"),
            (self.background.is_some(), "a background"),
        ];
        things.into_iter().find(|(is_there, _)| *is_there).map(|(_, what)| what)
    }
}

impl Scene {
    /// What stands against a [studio](crate::Lighting::Studio) in this scene: light that it brings, or a background. `None` if nothing does.
    pub fn beside_studio(&self) -> Option<&'static str> {
        self.lights.beside_studio(&self.geometry)
    }
}
