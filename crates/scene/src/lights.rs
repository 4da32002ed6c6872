//! The lights of a scene.

use std::ops::{Deref, DerefMut};

use glam::Vec3;

use crate::Light;

/// The lights of a scene, and the ambient light. Dereferences to the list of lights.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Lights {
    /// The lights; may be empty.
    pub list: Vec<Light>,
    /// I_a of formula (1), per channel; `None` if the file does not set it.
    pub ambient: Option<Vec3>,
    /// Radiance of rays that hit nothing; `None` if the file does not set it.
    pub background: Option<Vec3>,
}

impl Lights {
    /// Other lights with the same ambient intensity and background.
    pub fn with_list(self, list: Vec<Light>) -> Lights {
        Lights { list, ..self }
    }

    /// I_a of formula (1), per channel.
    pub fn with_ambient(self, ambient: impl Into<Vec3>) -> Lights {
        Lights { ambient: Some(ambient.into()), ..self }
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
