//! Visibility at points that the caller chooses, instead of those that a camera sees: for baking.
//!
//! A *probe* is a surface point in the form in which stages know surface points: a ray and the triangle that it hits. The triangle
//! has no area and one corner at the point, so that the ray alone determines its normal; stages need not know the difference.

use std::ops::Range;

use glam::Vec3;
use lightmesh_layout::geometry::ListedRay;
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{Hit, Ray, Triangle};

use crate::data::rays::RayList;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::prepared::PreparedScene;
use crate::stats::Stats;

/// Probes per row, since memory is planned by rows.
pub const ROW: u32 = 1024;

/// What given points see of each light.
#[derive(Clone, Debug)]
pub struct PointVisibility {
    pub(crate) visibility: Visibility,
    pub(crate) lights: usize,
    /// Counts, seconds and settings. `counts.pixels` is the number of points.
    pub stats: Stats,
}

impl PointVisibility {
    /// Number of points.
    pub fn points(&self) -> usize {
        self.visibility.rays
    }

    /// Number of lights of the scene.
    pub fn lights(&self) -> usize {
        self.lights
    }

    /// The visible share of light number `light` at point number `point`, in [0, 1]: 0 if the light is hidden or behind the surface.
    ///
    /// # Panics
    /// If there is no such light or point.
    pub fn of(&self, light: usize, point: usize) -> f32 {
        self.of_light(light)[point]
    }

    /// The visible share of light number `light` at each point, in the order of the points.
    ///
    /// # Panics
    /// If there is no such light.
    pub fn of_light(&self, light: usize) -> &[f32] {
        let points = self.points();
        &self.visibility.share[light * points..][..points]
    }

    /// All shares by light, then point; nothing is copied.
    pub fn into_shares(self) -> Vec<f32> {
        self.visibility.share
    }
}

/// Points with normals on the surfaces of a scene, or anywhere in it.
pub struct GivenPoints<'a> {
    pub(crate) scene: &'a PreparedScene,
    points: &'a [Vec3],
    normals: &'a [Vec3],
    /// A box around the points and the triangles of the scene.
    #[doc(hidden)]
    pub bounds: Bounds,
    /// Where the other two corners of a probe's triangle lie, see [`GivenPoints::part`].
    far_corner: Vec3,
}

/// Probes as a wave of rays and their hits.
#[derive(Clone, Debug)]
pub struct Probes {
    /// A ray to each, and its triangle.
    pub rays: RayList,
    /// The hit of each ray.
    pub hits: Vec<Hit>,
}

impl Probes {
    /// Bytes per probe beyond what a ray needs elsewhere, on the host and on a device: its triangle, and the ray in a list.
    pub(crate) const BYTES: u64 = (size_of::<Triangle>() + size_of::<ListedRay>()) as u64;
}

impl<'a> GivenPoints<'a> {
    /// `points` in the coordinates of the geometry's positions, each with its normal of any length.
    ///
    /// # Errors
    /// [`RenderError::Points`] if there are not as many normals as points, or too many of both; [`RenderError::Point`] if a coordinate is not
    /// finite or a normal has no direction.
    pub fn new(
        scene: &'a PreparedScene,
        points: &'a [Vec3],
        normals: &'a [Vec3],
    ) -> Result<GivenPoints<'a>, RenderError> {
        if points.len() != normals.len() || points.len() > MAX_PROBES {
            return Err(RenderError::Points { points: points.len(), normals: normals.len(), most: MAX_PROBES });
        }
        let is_usable = |(point, normal): (&Vec3, &Vec3)| point.is_finite() && normal.try_normalize().is_some();
        if let Some(index) = points.iter().zip(normals).position(|probe| !is_usable(probe)) {
            return Err(RenderError::Point { index, position: points[index].into(), normal: normals[index].into() });
        }
        let geometry = scene.geometry.bounds;
        let bounds = points.iter().fold(geometry, |bounds, &point| bounds.including(point));
        Ok(GivenPoints { scene, points, normals, bounds, far_corner: Vec3::splat(1.5 * geometry.farthest()) })
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// Rows of [`ROW`] probes, of which the last may be shorter.
    #[doc(hidden)]
    pub fn rows(&self) -> u32 {
        self.len().div_ceil(ROW as usize) as u32
    }

    /// The probes of some rows.
    #[doc(hidden)]
    pub fn range(&self, rows: &Range<u32>) -> Range<usize> {
        let start = |row: u32| (row as usize * ROW as usize).min(self.len());
        start(rows.start)..start(rows.end)
    }

    /// The probes of some rows as a wave.
    ///
    /// A segment that leaves a surface starts at some distance from it, which depends on the size of the triangle's coordinates
    /// ([`SurfacePoint`](crate::SurfacePoint)). Which triangle of the scene a probe lies on is not known, so the coordinates of its
    /// own triangle add up to at least those of any.
    #[doc(hidden)]
    pub fn part(&self, rows: &Range<u32>) -> Probes {
        let range = self.range(rows);
        let n = range.len();
        let mut wave = Probes { rays: RayList::default(), hits: Vec::with_capacity(n) };
        for (number, probe) in (0..).zip(range) {
            let (point, normal) = (self.points[probe], self.normals[probe].normalize());
            wave.rays.rays.push(Ray { origin: point + normal, direction: -normal, t_max: f32::INFINITY });
            wave.rays.pixels.push(probe as u32);
            wave.rays.weights.push(Vec3::ONE);
            wave.rays.probes.push(Triangle::new([point, self.far_corner, self.far_corner], number));
            wave.hits.push(Hit { t: 1.0, u: 0.0, v: 0.0, triangle: number });
        }
        wave
    }
}

/// Rays are numbered in 32 bits.
const MAX_PROBES: usize = u32::MAX as usize - 1;
