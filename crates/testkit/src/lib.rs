//! Shared code of rendering tests: small scenes with known answers, the shared models, the matrix of devices and settings, and
//! image checks.
//!
//! * [`SceneDraft`] assembles analytic scenes in double precision, anywhere in the world.
//! * [`FAMILIES`] are shapes of any number of triangles, in a row, on top of each other, within each other.
//! * [`MODELS`] lists the models next to the repository, with cameras and lights.
//! * [`each_device`], [`ACCELERATIONS`], [`RADII`] and others are the cases for which a guarantee must hold.
//! * [`runs_all`] says whether the whole products of cases run, or a part of them.
//! * [`Watch`] is an observer that checks progress.
//! * [`Picture`] reads the planes of a rendered frame and checks them. Every check has a test in which it fails.
//!
//! Helpers panic with the reason: a test whose setup fails has failed.

mod draft;
mod extent;
mod families;
mod matrix;
mod models;
mod picture;
mod random;
mod scenes;
mod watch;

pub use draft::SceneDraft;
pub use extent::{runs_all, seed};
pub use families::{FAMILIES, Family};
pub use matrix::{ACCELERATIONS, MODES, RADII, TECHNIQUES, WEIGHTS, each_device, render};
pub use models::{MODELS, Model};
pub use picture::{Picture, mean_difference, rms_difference};
pub use random::Random;
pub use scenes::{
    BALL_LIGHT, BOX_IN_MIRRORS, EYE_IN_MIRRORS, MIRROR_ROOM, glazed, half_plane, many_balls, mirror_room, open_floor,
    perforated, pile, soup, thicket, thin_wall,
};
pub use watch::{Watch, Watched};
