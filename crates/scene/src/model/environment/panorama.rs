//! Radiance by direction.

use std::f32::consts::FRAC_1_PI;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::directions::{direction, frame};
use super::harmonics::Irradiance;
use super::levels::{self, EnvironmentLevel};
use super::sun::Sun;
use crate::Up;

/// Radiance by direction, as a panorama: an equirectangular image of everything around, straight up in its first row, straight down in its last.
///
/// In its middle is the north: −Z if Y is up, +Y if Z is up. East, +X, is to its right. The sun is kept apart from the image: it is a light of the
/// scene, too, and a thousand times brighter than anything else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// For display: the file's name, or the kind of sky.
    pub name: String,
    pub(super) size: [u32; 2],
    /// Unit vectors to the east, up and to the north.
    pub(super) frame: [Vec3; 3],
    pub(super) sun: Option<Sun>,
    pub(super) levels: Levels,
    /// What of the image is lights.
    pub(super) bright: Option<Box<Bright>>,
}

/// Lights of a panorama, and what is left of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Bright {
    pub(super) discs: Vec<Sun>,
    pub(super) rest: Environment,
}

/// The image, and what follows from it, which is made when it is asked for.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Levels {
    #[serde(with = "crate::model::packed")]
    pub(super) image: Vec<[f32; 3]>,
    /// Smaller and smaller means.
    #[serde(skip)]
    lower: OnceLock<Vec<EnvironmentLevel>>,
    /// What surfaces receive.
    #[serde(skip)]
    pub(super) irradiance: OnceLock<Irradiance>,
}

impl From<Vec<[f32; 3]>> for Levels {
    fn from(image: Vec<[f32; 3]>) -> Levels {
        Levels { image, lower: OnceLock::new(), irradiance: OnceLock::new() }
    }
}

impl PartialEq for Levels {
    fn eq(&self, other: &Levels) -> bool {
        self.image == other.image
    }
}

impl Environment {
    /// From radiances row by row, `size` being width and height, for a scene in which `up` is up.
    ///
    /// # Panics
    /// If there are not as many as the size says, or none.
    pub fn new(name: impl Into<String>, size: [u32; 2], texels: Vec<[f32; 3]>, up: Up) -> Environment {
        assert!(!texels.is_empty() && texels.len() as u64 == u64::from(size[0]) * u64::from(size[1]), "{size:?}");
        Environment { name: name.into(), size, frame: frame(up), sun: None, levels: texels.into(), bright: None }
    }

    /// From what is seen along each direction.
    pub(crate) fn seen(name: &str, size: [u32; 2], up: Up, radiance: impl Fn(Vec3) -> Vec3 + Sync) -> Environment {
        let texel = |index: u32| radiance(direction(frame(up), size, [index % size[0], index / size[0]])).to_array();
        Environment::new(name, size, (0..size[0] * size[1]).into_par_iter().map(texel).collect(), up)
    }

    /// Turned clockwise as seen from above, by an angle in degrees: by 90, what was in the north is in the east.
    pub fn turned(mut self, degrees: f32) -> Environment {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let [east, up, north] = self.frame.map(Vec3::as_dvec3);
        // Where a direction is after the turn: its part along up stays.
        let turned = |way: DVec3| {
            let [right, ahead] = [east, north].map(|axis| axis.dot(way));
            (up.dot(way) * up + (cos * right + sin * ahead) * east + (cos * ahead - sin * right) * north).as_vec3()
        };
        self.frame = [east, up, north].map(turned);
        self.levels.irradiance = OnceLock::new();
        self.sun = self.sun.map(|sun| Sun { direction: turned(sun.direction.as_dvec3()), ..sun });
        self.bright = self.bright.map(|bright| {
            let Bright { discs, rest } = *bright;
            let turned = |sun: Sun| Sun { direction: turned(sun.direction.as_dvec3()), ..sun };
            Bright { discs: discs.into_iter().map(turned).collect(), rest: rest.turned(degrees) }.into()
        });
        self
    }

    /// With all radiances multiplied, also that of the sun.
    pub fn scaled(mut self, factor: f32) -> Environment {
        let mut image = std::mem::take(&mut self.levels.image);
        image.iter_mut().for_each(|texel| *texel = texel.map(|channel| channel * factor));
        self.levels = image.into();
        let scaled = |sun: Sun| Sun { radiance: factor * sun.radiance, ..sun };
        self.sun = self.sun.map(scaled);
        self.bright = self.bright.map(|bright| {
            let Bright { discs, rest } = *bright;
            Bright { discs: discs.into_iter().map(scaled).collect(), rest: rest.scaled(factor) }.into()
        });
        self
    }

    /// With another image of the same size, made from this one; also from that without its lights.
    pub(crate) fn redrawn(&self, draw: &impl Fn(&[[f32; 3]]) -> Vec<[f32; 3]>) -> Environment {
        let texels = draw(&self.levels.image);
        assert_eq!(texels.len(), self.levels.image.len());
        let bright = self.bright.as_deref().map(|Bright { discs, rest }| {
            let rest = rest.redrawn(draw);
            Bright { discs: discs.clone(), rest }.into()
        });
        Environment { name: self.name.clone(), levels: texels.into(), bright, ..*self }
    }

    /// With a sun, which hides what is behind it.
    pub fn with_sun(self, sun: Option<Sun>) -> Environment {
        Environment { sun, ..self }
    }

    /// Width and height of the image.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The image without the sun: radiances row by row, from the top.
    pub fn texels(&self) -> &[[f32; 3]] {
        &self.levels.image
    }

    /// Unit vectors to the east, up and to the north, in the scene.
    pub fn frame(&self) -> [Vec3; 3] {
        self.frame
    }

    /// The sun.
    pub fn sun(&self) -> Option<&Sun> {
        self.sun.as_ref()
    }

    /// Means of the image, each half as large as the one before, down to a single texel.
    pub fn levels(&self) -> &[EnvironmentLevel] {
        self.levels.lower.get_or_init(|| levels::of(self.size, &self.levels.image))
    }

    /// The direction of the middle of a texel, in the scene.
    pub fn direction(&self, column: u32, row: u32) -> Vec3 {
        direction(self.frame, self.size, [column, row])
    }

    /// The texel in which a direction of the scene lies: column and row.
    pub fn texel(&self, direction: Vec3) -> [u32; 2] {
        let [east, up, north] = self.frame.map(|axis| axis.dot(direction));
        let place = [0.5 + 0.5 * FRAC_1_PI * east.atan2(north), 0.5 - FRAC_1_PI * up.atan2(east.hypot(north))];
        [0, 1].map(|axis| ((place[axis] * self.size[axis] as f32) as u32).min(self.size[axis] - 1))
    }

    /// What surfaces gather: the image without its [lights](Environment::discs).
    pub fn gathered(&self) -> &Environment {
        self.bright.as_ref().map_or(self, |bright| &bright.rest)
    }

    /// The lights that bright regions of the image are, besides the sun.
    pub fn discs(&self) -> &[Sun] {
        self.bright.as_ref().map_or(&[], |bright| &bright.discs)
    }
}
