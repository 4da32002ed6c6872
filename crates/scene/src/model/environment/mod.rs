//! What surrounds a scene: radiance by direction, from beyond everything.

mod bright;
mod directions;
mod harmonics;
mod irradiance;
mod levels;
mod panorama;
pub(crate) mod sky;
mod sun;
mod sun_in_image;
mod sun_position;

pub use directions::from_angles;
pub use levels::EnvironmentLevel;
pub use panorama::Environment;
pub use sky::{Sky, SkyError, SkyKind, Surroundings};
pub use sun::Sun;
pub use sun_position::{Moment, SunError, SunPosition};
