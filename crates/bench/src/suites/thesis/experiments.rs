//! Names of experiments that several modules know.

/// The method by scene, size, step and radius, and hard shadows.
pub(super) const TIMINGS: &str = "timings";
/// Area shadows with few and many samples.
pub(super) const AREA_SHADOWS: &str = "figure 1";
/// Time against the number of lights.
pub(super) const LIGHTS: &str = "figure 11";
/// Images for growing R.
pub(super) const PICTURES: &str = "figures 12-15";
