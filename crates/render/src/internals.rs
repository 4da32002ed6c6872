//! Parts of the renderer for its own tests, which are in `tests/render/parts`. They are no interface: they change with any release.
//!
//! Tests are a crate of their own, so that the renderer is compiled once, not a second time with its tests.

pub mod accel {
    pub use lightmesh_trace::accel::{AlphaMask, Beams};
    pub use lightmesh_trace::internals::*;
}

pub mod antialiasing {
    pub use crate::antialiasing::{Antialiasing, quantiles, table, weight};
}

pub mod bands {
    pub use crate::bands::{RESERVE, check_picture, rows_in_parts, rows_on_host};
}

pub mod cache {
    pub use crate::cache::Allowance;
    pub use crate::cache::column_key::ColumnKey;
    pub use crate::cache::content::{Content, Places, SavedGathered, Section};
    pub use crate::cache::file::{HEADER, MAGIC, TRAILER, decode, load, write};
    pub use crate::cache::invalidation::meets_between;
    pub use crate::cache::stored::{Stored, StoredAnswers, StoredColumn, bytes_of_rows};
}

pub mod cuda {
    #[cfg(feature = "cuda")]
    pub use lightmesh_kernels::internals::*;
    pub use lightmesh_kernels::{Gpu, Version, capability};
}

pub mod data {
    pub use crate::data::mattes::{Counted, count, take_away};
}

pub mod device {
    pub use crate::device::report::{described, facts};
}

pub mod footprint {
    pub use crate::footprint::{axes, curvature};
}

pub mod irradiance_cache {
    pub use crate::stages::irradiance_cache::directions::{BINS, above, basis, bin};
    pub use crate::stages::irradiance_cache::guide::guided;
    pub use crate::stages::irradiance_cache::identity::Identity;
    pub use crate::stages::irradiance_cache::saved::{SavedCells, SavedLight, SavedNode, SavedPlace, SavedRecord};
}

pub mod light_mesh {
    pub use crate::light_mesh::auto_step::{GROWTH, Probe, points_per_pixel, raised, rounded};
    pub use crate::light_mesh::bricks::bits;
    pub use crate::light_mesh::cell_points::weight;
    pub use crate::light_mesh::window::{Span, Windows};
}

pub mod material_ids {
    pub use crate::material_ids::MaterialIds;
}

pub mod passes {
    use lightmesh_scene::Bounds;

    use crate::backend::Cpu;
    use crate::backend::stage_runner::StageRunner;
    use crate::data::picture::Picture;
    use crate::data::visibility::Visibility;
    use crate::error::RenderError;
    use crate::observer::Unobserved;
    use crate::passes::{Baking, Passes};
    use crate::plan::{BytesPerRay, Plan};
    use crate::prepared::PreparedScene;
    use crate::probes::GivenPoints;
    use crate::render_context::RenderContext;
    use crate::settings::Settings;
    use crate::techniques::{Technique, VisibilityQuery};
    use crate::view::View;

    /// A technique for surface points within bounds, and the scene that it is for.
    pub struct Chosen<'a> {
        technique: Technique,
        scene: &'a PreparedScene,
        view: View,
    }

    impl<'a> Chosen<'a> {
        /// The technique that `settings` choose for the scene's first camera.
        pub fn new(
            scene: &'a PreparedScene,
            settings: &'a Settings,
            bounds: Bounds,
        ) -> Result<Chosen<'a>, RenderError> {
            let view = View::new(&scene.scene.cameras[0], settings.size);
            let technique =
                Technique::resolve(&VisibilityQuery { scene, settings, view: &view, observer: &Unobserved, bounds })?;
            Ok(Chosen { technique, scene, view })
        }

        /// Bytes that it needs per ray for `lights` lights at once.
        pub fn bytes_per_ray(&self, lights: u64) -> BytesPerRay {
            self.technique.bytes_per_ray(lights)
        }

        /// Number of lights in a group.
        pub fn lights_at_once(&self) -> usize {
            self.technique.lights_at_once()
        }

        /// The whole picture as it is planned, on the CPU, and how many rows were rendered at once.
        pub fn picture(&self, context: &RenderContext, plan: &Plan) -> Result<(Picture, u32), RenderError> {
            let Chosen { technique, scene, view } = self;
            let mut picture = Picture::planned(plan, [0..plan.size[1], 0..plan.size[1]]);
            let runner = StageRunner::new(&Cpu, context, None);
            let rows =
                Passes { runner, scene, transmission_parts: None, technique, view, plan }.render(&mut picture)?;
            Ok((picture, rows))
        }

        /// What given points see of lights, on the CPU, and how many rows of them were processed at once.
        pub fn baked(
            &self,
            context: &RenderContext,
            plan: &Plan,
            points: &GivenPoints,
        ) -> Result<(Visibility, u32), RenderError> {
            let Chosen { technique, scene, .. } = self;
            Baking { runner: StageRunner::new(&Cpu, context, None), scene, technique, plan }.bake(points)
        }
    }
}

pub mod prepared {
    pub use crate::prepared::{BYTES_TO_BUILD, center_and_sun_distance};
}

pub mod probes {
    pub use crate::probes::ROW;
}

pub mod progress {
    pub use crate::progress::{Pieces, Work};
}

pub mod shading {
    pub use crate::shading::dielectric::{exp_of_minus, fresnel, refracted};
    pub use crate::shading::environment::radiance;
    pub use crate::shading::facets::{Lobe, Sight};
    pub use crate::shading::irradiance::{irradiance, nearness};
    pub use crate::shading::normal_map::{Relief, mirroring};
    pub use crate::shading::tint::Coefficients;
    pub use crate::shading::turns::{angle, logarithm, turns};
    pub use crate::shading::{LightTargets, cone, strength};
}

pub mod shadow {
    pub use crate::shadow::above_horizon;
    pub use crate::shadow::cuts::Cuts;
    pub use crate::shadow::occlusion::ProjectedLights;
    pub use crate::shadow::projected_light::ProjectedLight;
    pub use crate::shadow::rows::{KnownRows, MAX_KNOWN, Rows};
    pub use crate::shadow::sample_ray::SampleRays;
    pub use crate::shadow::terminator::ShadowPoint;
}

pub mod simd {
    pub use lightmesh_trace::simd::{LANES, dispatch, splat};
}

pub mod stages {
    pub use crate::stages::adaptive_shadows::first::{RIM, place_of, places};
    pub use crate::stages::merged_rays::cpu::merged_rays;
    pub use crate::stages::mirror_rays::cpu::mirror_rays;
    pub use crate::stages::primary_rays::cpu::blocks_of_pixels;
    pub use crate::stages::short_tests::batch::transposed;
    pub use crate::stages::short_tests::cells::shadow_box;
}

pub mod surface {
    pub use crate::surface::{long_segment, shading_normal};
}

pub mod textures {
    pub use crate::textures::Image;
    pub use crate::textures::encoding::Encoding;
    pub use crate::textures::levels::{AllLevels, MipLevels, bytes_to_build, packed, unpacked};
    pub use crate::textures::lookup::{at_level, filtered, level_of, sampled};
    pub use lightmesh_trace::textures::neighbours;
}
