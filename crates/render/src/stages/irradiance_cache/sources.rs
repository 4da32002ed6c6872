//! All that gathered light depends on, and its identity in files.

use std::sync::Arc;

use lightmesh_scene::{Environment, Geometry, Light};

use super::Gathering;
use super::hemisphere_rays::RecordRays;
use super::identity::Identity;
use crate::prepared::PreparedScene;

/// Changes with what is computed from the same sources: what was saved before is gathered anew.
const REVISION: &[u8] = b"guided3";

/// All that gathered light depends on, besides the geometry.
pub(crate) struct Sources {
    lights: Vec<Light>,
    environment: Option<Arc<Environment>>,
    seed: u64,
    rays: RecordRays,
}

impl Sources {
    pub(crate) fn new(scene: &PreparedScene, seed: u64, how: &Gathering) -> Sources {
        let lights = &scene.scene.lights;
        Sources { lights: lights.list.clone(), environment: lights.environment.clone(), seed, rays: how.rays }
    }

    /// Hash of these sources, and of the surfaces of `scene`: of all that decides what is gathered there. Unlike addresses, it is the same in
    /// all processes.
    pub(crate) fn hash(&self, scene: &PreparedScene) -> u64 {
        let mut all = Identity::default();
        // 1. How it is gathered, and surfaces.
        let Sources { lights, environment, seed, rays: RecordRays { coarse, fine } } = self;
        all.bytes(REVISION);
        all.number(*seed);
        [coarse[0], coarse[1], *fine].into_iter().for_each(|rays| all.number(rays.side()));
        all.number(scene.geometry.hash());
        let Geometry { mesh, materials, textures, .. } = &*scene.scene.geometry;
        all.bytes(bytemuck::cast_slice(mesh.triangles.as_flattened()));
        all.bytes(bytemuck::cast_slice(&mesh.normals));
        all.bytes(bytemuck::cast_slice(&mesh.uvs));
        all.bytes(bytemuck::cast_slice(&mesh.colors));
        all.bytes(bytemuck::cast_slice(&mesh.opacities));
        all.bytes(bytemuck::cast_slice(&mesh.materials));
        all.list(mesh.instances.list(), Identity::instance);
        all.list(materials, Identity::material);
        all.list(textures, |all, texture| {
            all.bytes(bytemuck::cast_slice(&texture.size));
            all.bytes(texture.texels.as_flattened());
        });
        // 2. Lights and surroundings.
        all.list(lights, Identity::light);
        all.list(environment.as_slice(), |all, environment| all.environment(environment));
        all.digest()
    }
}

impl PartialEq for Sources {
    /// Panoramas are the same if they are one.
    fn eq(&self, other: &Sources) -> bool {
        let name = |sources: &Sources| sources.environment.as_ref().map(Arc::as_ptr);
        let same = name(self) == name(other) && self.seed == other.seed && self.rays == other.rays;
        same && self.lights == other.lights
    }
}
