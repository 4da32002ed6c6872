//! The data that the stages of an image work on.

use std::ops::Range;

use lightmesh_scene::Lights;
use lightmesh_trace::accel::Hit;

use super::cells::CellGroups;
use super::light_point_visibility::LightPointVisibility;
use super::lights::LightGroup;
use super::masks::Masks;
use super::rays::{RayList, surface_point_of};
use crate::light_mesh::{LightMesh, UsedPoints};
use crate::prepared::PreparedScene;
use crate::render_context::{RenderContext, Sampling};
use crate::surface::SurfacePoint;

/// A wave of rays, those of the camera or of one bounce, with their hits and everything that all stages need.
pub struct Wave<'a, Scene, Rays, Hits> {
    /// Settings, counts and progress of the image.
    pub context: &'a RenderContext<'a>,
    /// The scene, in the device's memory.
    pub scene: &'a Scene,
    /// The rays.
    pub rays: &'a Rays,
    /// What each of them hit.
    pub hits: &'a Hits,
    /// The lights whose visibility is asked for; light points have that of all.
    pub lights: LightGroup,
    /// How many parts the samples of each light are divided into: each ray takes one.
    pub parts: u32,
}

impl<Scene, Rays, Hits> Clone for Wave<'_, Scene, Rays, Hits> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Scene, Rays, Hits> Wave<'_, Scene, Rays, Hits> {
    /// How each of its surface points samples lights.
    pub(crate) fn sampling(&self) -> Sampling {
        let all = self.context.sampling;
        // A single sample would be the centre.
        let least = all.samples.min(2);
        Sampling { samples: (all.samples / self.parts).max(least), ..all }
    }
}

impl<Scene, Rays, Hits> Copy for Wave<'_, Scene, Rays, Hits> {}

/// The results of the light mesh method for a wave, as formula (3) needs them.
pub struct Seen<'a, Cells, Masks, Points, LightPointVisibility> {
    /// The light mesh.
    pub mesh: &'a LightMesh,
    /// Surface points by cell.
    pub cells: &'a Cells,
    /// Which light points each of them sees.
    pub masks: &'a Masks,
    /// Each used light point.
    pub points: &'a Points,
    /// Which lights each of these sees.
    pub lit: &'a LightPointVisibility,
}

/// [`Seen`] on the host.
pub(crate) type HostSeen<'a> = Seen<'a, CellGroups, Masks, UsedPoints, LightPointVisibility>;

/// A wave on the host.
pub(crate) type HostWave<'a> = Wave<'a, PreparedScene, RayList, Vec<Hit>>;

impl<'a> HostWave<'a> {
    /// The surface point that ray number `ray` sees; the ray must have hit something.
    #[inline(always)]
    pub(crate) fn surface_point(&self, ray: usize) -> SurfacePoint {
        surface_point_of(self.scene, self.rays, self.hits, ray)
    }

    /// Whether ray number `ray` sees anything.
    #[inline(always)]
    pub(crate) fn sees(&self, ray: usize) -> bool {
        self.hits[ray].is_some()
    }

    /// The numbers of the lights whose visibility is asked for.
    #[inline(always)]
    pub(crate) fn group(&self) -> Range<usize> {
        self.lights.of(self.lights().len())
    }

    /// The scene's lights.
    #[inline(always)]
    pub(crate) fn lights(&self) -> &'a Lights {
        &self.scene.scene.lights
    }
}
