//! How much each sample of a light counts where the light is near or wide. Twin: `weights.cuh`.
//!
//! The light of such a light is known without shadows ([`irradiance`](crate::shading::irradiance)); its visible share is Σ w v / Σ w over the
//! samples above the horizon, w being a sample's own share of the irradiance (Heitz, Hill, McGuire: *Combining Analytic Direct Illumination and
//! Stochastic Shadows*, 2018): the cosines at the surface and at the light, and the distance. Samples of balls, and of suns, are places of a disc that
//! stands for directions. Far from a light, w is 1; in between, both shares are mixed. Then nothing that is below the horizon is in them.

use glam::Vec3;
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::{Light, LightKind};

use super::projected_light::{Emitter, ProjectedLight};
use crate::prepared::PreparedGeometry;
use crate::sampling::light_center;
use crate::shading::irradiance::{may_be_near, nearness};
use crate::surface::SurfacePoint;

/// What a surface point sees of the samples of a light, set by set.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Weighed {
    /// How near the light is; 0: its samples are counted.
    pub(crate) nearness: f32,
    /// Number of samples above the horizon, and of those that are seen.
    above: u32,
    seen: u32,
    /// The sums of their weights.
    all: f32,
    lit: f32,
}

/// The weights of a light's samples at a surface point.
pub(crate) struct Weights {
    normal: Vec3,
    /// The normal of what shines with the cosine.
    front: Option<Vec3>,
    /// Whether samples shine evenly from places of a flat light, not from directions.
    even: bool,
    /// Of vectors to samples: what makes them about as long as 1.
    scale: f32,
}

impl Emitter<'_> {
    /// What `point` sees of its samples by their weights, before any are looked at; `None` if they are counted from everywhere.
    #[inline(always)]
    pub(crate) fn weighed(&self, geometry: &PreparedGeometry, point: &SurfacePoint) -> Option<Weighed> {
        let weighed = || Weighed::new(self.light().0, point, geometry.sun_distance(point.origin));
        (!self.is_point() && may_be_near(self.light().0)).then(weighed)
    }

    /// The weights of its samples.
    #[inline(always)]
    pub(crate) fn weights(&self, point: &SurfacePoint, projected: &ProjectedLight) -> Weights {
        Weights::new(self.light().0, point, projected)
    }
}

impl Weights {
    /// Those of a light as the point sees it.
    #[inline(always)]
    pub(crate) fn new(light: &Light, point: &SurfacePoint, projected: &ProjectedLight) -> Weights {
        let flat = matches!(light.kind, LightKind::Disk { .. } | LightKind::Rectangle { .. });
        let most = projected.center.abs().max(projected.along.abs()).max(projected.across.abs()).max_element();
        let even = flat && light.surface.is_none();
        Weights { normal: point.normal, front: light.surface, even, scale: 1.0 / most.max(f32::MIN_POSITIVE) }
    }

    /// Of the sample at `way`; not above 0 if it is below a horizon.
    #[inline(always)]
    fn of(&self, way: Vec3) -> f32 {
        let way = self.scale * way;
        let square = way.length_squared();
        let above = self.normal.dot(way);
        let emitted =
            if self.even { square.sqrt() } else { self.front.map_or(1.0, |front| (-front.dot(way)).max(0.0)) };
        above * emitted / (square * square)
    }
}

impl Weighed {
    /// Of `light`, nothing yet.
    #[inline(always)]
    pub(crate) fn new(light: &Light, point: &SurfacePoint, reach: f32) -> Weighed {
        let way = light_center(light, point.origin, reach) - point.origin;
        Weighed { nearness: nearness(light, way), ..Weighed::default() }
    }

    /// Counts the samples of a set: those `above` the horizon, and those `seen`.
    #[inline(always)]
    pub(crate) fn count(&mut self, above: u32, seen: u32) {
        self.above += above;
        self.seen += seen;
    }

    /// Whether counting is enough if there are no more sets: all are seen, or none.
    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        self.seen == self.above || self.seen == 0
    }

    /// Adds the weights of the samples of a set, of which those with their `bits` are seen.
    #[inline(never)]
    pub(crate) fn add(&mut self, weights: &Weights, projected: &ProjectedLight, set: &SampleRows, bits: &[u32]) {
        // Set by set, as kernels do.
        let (mut all, mut lit) = (0.0, 0.0);
        let mut word = 0;
        for row in 0..set.rows as usize {
            while row >= set.ends[word] as usize {
                word += 1;
            }
            let offset = projected.offset(set, row);
            let mut rest = projected.valid(set, row);
            while rest != 0 {
                let place = rest.trailing_zeros();
                rest &= rest - 1;
                let weight = weights.of(projected.scaled_sample(set, row, place as f32, offset));
                if weight > 0.0 {
                    all += weight;
                    if bits[word] >> (set.place[row] + place) & 1 != 0 {
                        lit += weight;
                    }
                }
            }
        }
        self.all += all;
        self.lit += lit;
    }

    /// The visible share of the light: exactly 1 for all of it.
    #[inline(always)]
    pub(crate) fn share(&self) -> f32 {
        if self.seen == 0 {
            return 0.0;
        }
        if self.seen == self.above {
            return 1.0;
        }
        let counted = self.seen as f32 / self.above as f32;
        let weighed = if self.all > 0.0 { self.lit / self.all } else { counted };
        counted + self.nearness * (weighed - counted)
    }
}
