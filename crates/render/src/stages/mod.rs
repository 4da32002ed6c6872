//! The stages of an image: one folder each, with its contract in `mod.rs` and a file for each kind of device next to it:
//! `cpu.rs`, and `cuda.rs` with the kernels in `kernel.cu`. All have the same numbered steps.

pub(crate) mod adaptive_shadows;
pub(crate) mod area_shadows;
pub(crate) mod bundles;
pub(crate) mod cells;
pub(crate) mod fragments;
pub(crate) mod interpolate;
pub(crate) mod irradiance_cache;
pub(crate) mod light_points;
pub(crate) mod long_tests;
pub(crate) mod merged_rays;
pub(crate) mod mirror_rays;
pub(crate) mod occluder_lists;
pub(crate) mod pixel_samples;
pub(crate) mod primary_rays;
pub(crate) mod shade;
pub(crate) mod shadow_rays;
pub(crate) mod short_tests;
pub(crate) mod transmittance;
