//! The scene itself.

use glam::{DVec3, Vec3};

use crate::{Camera, Light, Material, Mesh, Texture};

/// The weight w of formula (3) as a function of q = distance / radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
    /// The word for it in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Weight::Constant => "constant",
            Weight::Quadratic => "quadratic",
            Weight::Smooth => "smooth",
        }
    }

    /// The weight of this name.
    pub fn from_name(name: &str) -> Option<Weight> {
        [Weight::Constant, Weight::Quadratic, Weight::Smooth].into_iter().find(|weight| weight.name() == name)
    }
}

/// What a scene proposes for the light mesh; a flag on the command line wins over it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightMeshDefaults {
    /// Step h in scene units.
    pub step: Option<f32>,
    /// Interpolation radius in steps, R = r/h.
    pub radius: Option<f32>,
    /// Weight of formula (3).
    pub weight: Option<Weight>,
}

/// Everything there is to render, in one local frame.
#[derive(Clone, Debug)]
pub struct Scene {
    /// For people: the file's stem or the built-in's name.
    pub name: String,
    /// World position of the local frame's zero. All `f32` positions are relative to it.
    pub origin: DVec3,
    /// The triangles.
    pub mesh: Mesh,
    /// Materials, at least one where there are triangles.
    pub materials: Vec<Material>,
    /// Textures of the materials.
    pub textures: Vec<Texture>,
    /// Lights; may be empty.
    pub lights: Vec<Light>,
    /// Cameras; may be empty.
    pub cameras: Vec<Camera>,
    /// I_a of formula (1), per channel; `None` where the file is silent.
    pub ambient: Option<Vec3>,
    /// Radiance of rays that hit nothing; `None` where the file is silent.
    pub background: Option<Vec3>,
    /// Proposed settings of the light mesh.
    pub light_mesh: LightMeshDefaults,
    /// What a loader mended, left out or guessed; a sentence each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// World coordinates of a local point.
    pub fn to_world(&self, local: Vec3) -> DVec3 {
        self.origin + local.as_dvec3()
    }

    /// Local coordinates of a world point.
    pub fn to_local(&self, world: DVec3) -> Vec3 {
        (world - self.origin).as_vec3()
    }
}
