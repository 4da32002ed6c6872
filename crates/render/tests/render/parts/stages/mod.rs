mod adaptive_shadows;
mod interpolate;
mod light_points;
mod long_tests;
mod merged_rays;
mod mirror_rays;
mod primary_rays;
mod short_tests;
