//! [`Scene`], the scene itself: geometry, lights and cameras.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::{animation::Animation, camera::Camera, geometry::Geometry, lights::Lights};
use crate::parse_by_name;

/// The weight w of formula (3) as a function of q = distance / radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Weight {
    /// w = 1: the thesis.
    Constant,
    /// w = 1 − q².
    Quadratic,
    /// w = (1 − q²)².
    #[default]
    Smooth,
}

impl Weight {
    /// All weights.
    pub const ALL: &'static [Weight] = &[Weight::Constant, Weight::Quadratic, Weight::Smooth];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Weight::Constant => "constant",
            Weight::Quadratic => "quadratic",
            Weight::Smooth => "smooth",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Weight::Constant => "w = 1, as in the thesis",
            Weight::Quadratic => "w = 1 − q²",
            Weight::Smooth => "w = (1 − q²)²",
        }
    }
}

parse_by_name!(Weight, "weight");

/// The settings of the light mesh that a scene proposes; explicit render settings take precedence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LightMeshDefaults {
    /// Step h in scene units.
    pub step: Option<f32>,
    /// Interpolation radius in steps, R = r/h.
    pub radius: Option<f32>,
    /// Weight of formula (3).
    pub weight: Option<Weight>,
}

/// A named place without a surface: a pivot, a bone, or what groups others. Nothing of it is seen, and exports keep it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Empty {
    /// Its name.
    pub name: String,
    /// From its coordinates to the world's.
    pub transform: DMat4,
}

/// Everything needed for rendering: geometry, lights and cameras, which change independently of each other. Cloning is cheap: the
/// geometry is shared. Serde stores the scene as it is, in the order of bytes of the machine, but not [how it moves](Scene::animation()).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scene {
    /// For display: the file's stem or the built-in's name.
    pub name: String,
    /// The surfaces that rays can hit.
    pub geometry: Arc<Geometry>,
    /// The lights.
    pub lights: Lights,
    /// Cameras; may be empty.
    pub cameras: Vec<Camera>,
    /// Proposed settings of the light mesh.
    pub light_mesh: LightMeshDefaults,
    /// Named places without a surface.
    pub empties: Vec<Empty>,
    /// The file that was read, and all files that it refers to, also those that do not exist or are not used: what a program must
    /// not overwrite. Empty for other scenes.
    pub files: Vec<PathBuf>,
    /// What a loader corrected, ignored or guessed: one sentence each, at most about a hundred. Names in them are as in
    /// the files; make them visible before they reach a terminal.
    pub warnings: Vec<String>,
    /// How many vertices got a normal while the scene was read, see [`LoadOptions::smooth`](crate::LoadOptions::smooth).
    pub smooth_normals: usize,
    /// How it moves.
    #[serde(skip)]
    pub(crate) animation: Option<Arc<Animation>>,
}

impl Scene {
    /// A scene of `geometry` alone, without lights and cameras.
    pub fn new(name: impl Into<String>, geometry: impl Into<Arc<Geometry>>) -> Scene {
        Scene {
            name: name.into(),
            geometry: geometry.into(),
            lights: Lights::default(),
            cameras: Vec::new(),
            light_mesh: LightMeshDefaults::default(),
            empties: Vec::new(),
            files: Vec::new(),
            warnings: Vec::new(),
            smooth_normals: 0,
            animation: None,
        }
    }

    /// The same geometry and cameras with other lights, in the geometry's local frame.
    pub fn with_lights(self, lights: impl Into<Lights>) -> Scene {
        Scene { lights: lights.into(), ..self }
    }

    /// The same lights and cameras with other geometry in the same local frame.
    pub fn with_geometry(self, geometry: impl Into<Arc<Geometry>>) -> Scene {
        Scene { geometry: geometry.into(), ..self }
    }

    /// The same geometry and lights with other cameras; images are rendered from the first.
    pub fn with_cameras(self, cameras: Vec<Camera>) -> Scene {
        Scene { cameras, ..self }
    }

    /// Mutable access to the geometry. It is copied first if it is shared, for example with a renderer that has prepared it.
    pub fn geometry_mut(&mut self) -> &mut Geometry {
        Arc::make_mut(&mut self.geometry)
    }

    /// World coordinates of a local point.
    pub fn to_world(&self, local: Vec3) -> DVec3 {
        self.geometry.to_world(local)
    }

    /// Local coordinates of a world point.
    pub fn to_local(&self, world: DVec3) -> Vec3 {
        self.geometry.to_local(world)
    }

    /// How the scene moves, if it does.
    pub fn animation(&self) -> Option<&Animation> {
        self.animation.as_deref()
    }
}
