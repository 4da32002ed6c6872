//! Ambient light: the same from all sides, or what an environment gives to surfaces with nothing in between. Twin: `ambient.cuh`.

use glam::Vec3;

use crate::prepared::PreparedScene;

/// The radiance I_a of formula (1) by the direction that a surface faces.
pub(crate) struct AmbientLight<'a> {
    /// From all sides.
    pub(crate) mean: Vec3,
    /// Its [terms](lightmesh_scene::Environment::irradiance_terms), if it depends on the direction.
    pub(crate) terms: Option<[Vec3; 9]>,
    /// What was gathered, by ray.
    pub(crate) gathered: Option<&'a [Vec3]>,
}

impl<'a> AmbientLight<'a> {
    /// What the scene sets, or the [default](lightmesh_scene::Lights::default_ambient).
    pub(crate) fn of(scene: &PreparedScene) -> AmbientLight<'a> {
        let lights = &scene.scene.lights;
        let mean = lights.ambient.unwrap_or_else(|| lights.default_ambient(&scene.geometry.bounds));
        let environment = lights.environment.as_ref().filter(|_| lights.ambient.is_none());
        AmbientLight { mean, terms: environment.map(|environment| environment.irradiance_terms()), gathered: None }
    }

    /// Gathered light in its place.
    pub(crate) fn with_gathered(self, gathered: Option<&'a [Vec3]>) -> AmbientLight<'a> {
        AmbientLight { gathered, ..self }
    }

    /// What a surface receives that faces the unit vector `n`.
    #[inline(always)]
    pub(crate) fn at(&self, n: Vec3) -> Vec3 {
        let Some([constant, terms @ ..]) = self.terms else { return self.mean };
        let powers = [n.x, n.y, n.z, n.x * n.y, n.y * n.z, n.z * n.x, n.z * n.z, n.x * n.x - n.y * n.y];
        let sum = powers.into_iter().zip(terms).fold(constant, |sum, (power, term)| sum + power * term);
        sum.max(Vec3::ZERO)
    }
}
