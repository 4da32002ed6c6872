//! The table of stages: the methods of [`Backend`](super::Backend) that do the work. A stage's method calls the function of its name in
//! `stages/<stage>/cpu.rs` or `cuda.rs`.

/// Calls a macro with the table.
macro_rules! stage_table {
    ($use:ident) => {
        $use! {
            /// Computes what each ray hits.
            primary_rays(context: &RenderContext, scene: &Self::Scene, rays: &Self::Rays) -> Self::Hits;
            /// Computes what some samples of each pixel see, and which pixels are shared: of the wave, whose rays go through the centres, the
            /// hits of these pixels alone are left.
            pixel_samples(
                wave: &WaveOf<Self>,
                film: &mut Self::Film,
                range: &SampleRange
            ) -> (Self::Samples, Self::Rays, Self::Hits);
            /// Parts the samples of the pixels that are not shared, or should not be: shared fragments, single samples, and those that show what
            /// is in mirrors, with what they see.
            fragments(
                wave: &WaveOf<Self>,
                samples: &mut Self::Samples,
                film: &mut Self::Film,
                all: &Antialiasing
            ) -> [(Self::Rays, Self::Hits); 3];
            /// Groups surface points by cell of the light mesh.
            cells(wave: &WaveOf<Self>, mesh: &LightMesh) -> Self::Cells;
            /// Tests which light points each surface point sees. Formula (2).
            short_tests(wave: &WaveOf<Self>, cells: &Self::Cells, mesh: &LightMesh) -> Self::Masks;
            /// Collects each light point that is used, once. Formula (7).
            light_points(context: &RenderContext, cells: &Self::Cells, masks: &Self::Masks, mesh: &LightMesh) -> Self::Points;
            /// Tests what each light point sees of each light. Cached results are not tested again; new ones are cached.
            long_tests(
                wave: &WaveOf<Self>,
                points: &Self::Points,
                mesh: &LightMesh,
                cache: Option<&mut Cache<Self::Table>>
            ) -> Self::LightPointVisibility;
            /// Computes the weighted mean over the light points that a surface point uses. Formula (3).
            interpolate(wave: &WaveOf<Self>, seen: &SeenOf<Self>) -> Self::Visibility;
            /// Casts shadow rays from each surface point: one to the centre of each light, or many distributed over it.
            shadow_rays(wave: &WaveOf<Self>, target: &ShadowTarget) -> Self::Visibility;
            /// Finds which samples of each light each surface point sees, by what stands between the two: the reference.
            area_shadows(wave: &WaveOf<Self>, target: &ShadowTarget) -> Self::Visibility;
            /// Casts one ray from each surface point to each light, and all that `shadow_rays` casts where neighbours disagree.
            adaptive_shadows(wave: &WaveOf<Self>, target: &ShadowTarget) -> Self::Visibility;
            /// Puts surface points that are close together into bundles.
            bundles(wave: &WaveOf<Self>) -> Self::Bundles;
            /// Finds the same as `area_shadows`, by what stands between a bundle and the light.
            occluder_lists(wave: &WaveOf<Self>, bundles: &Self::Bundles, target: &ShadowTarget) -> Self::Visibility;
            /// Multiplies visibility by the transmittance of the surfaces of `transmissive`.
            transmittance(wave: &WaveOf<Self>, transmissive: &Self::Scene, target: &ShadowTarget, visibility: Self::Visibility) -> Self::Visibility;
            /// Adds the radiance of each ray to its pixel. Formula (1).
            shade(
                wave: &WaveOf<Self>,
                visibility: &Self::Visibility,
                gathered: Option<&Self::Gathered>,
                film: &mut Self::Film
            ) -> ();
            /// Generates the rays of the last term of formula (1), from every mirroring surface point along the mirrored view, unless they were
            /// mirrored often enough; and those that go straight on where a surface is not opaque.
            mirror_rays(wave: &WaveOf<Self>) -> Self::Rays;
            /// Merges the mirrored rays of each pixel that meet one surface, with what they see.
            merged_rays(wave: &WaveOf<Self>) -> (Self::Rays, Self::Hits);
        }
    };
}

/// Declares the methods.
macro_rules! stage_methods {
    ($($(#[$doc:meta])* $stage:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $($(#[$doc])* fn $stage(&self, $($argument: $type),*) -> Result<$result, RenderError>;)*
    };
}

/// Implements them by the CPU's functions, which cannot fail.
macro_rules! stages_on_cpu {
    ($($(#[$doc:meta])* $stage:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(fn $stage(&self, $($argument: $type),*) -> Result<$result, RenderError> {
            Ok(crate::stages::$stage::cpu::$stage($($argument),*))
        })*
    };
}

/// Implements them by the functions of CUDA devices.
macro_rules! stages_on_cuda {
    ($($(#[$doc:meta])* $stage:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(fn $stage(&self, $($argument: $type),*) -> Result<$result, RenderError> {
            crate::stages::$stage::cuda::$stage(self, $($argument),*)
        })*
    };
}

pub(super) use {stage_methods, stage_table, stages_on_cpu, stages_on_cuda};
