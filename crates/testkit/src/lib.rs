//! What tests of rendering share: small scenes with known answers, the shared models, the matrix of devices and settings, and
//! judges of pictures.
//!
//! * [`SceneDraft`] puts analytic scenes together in double precision, anywhere in the world.
//! * [`MODELS`] lists the models beside the repository with the cameras and lights to look at them with.
//! * [`each_device`], [`ACCELERATIONS`], [`RADII`] and their like are what a promise must hold for.
//! * [`Picture`] reads the planes of a rendered frame and judges them. Every judge has a test that it can say no.
//!
//! Helpers panic with the reason: a test that cannot set itself up has failed.

mod draft;
mod matrix;
mod models;
mod picture;
mod random;
mod scenes;

pub use draft::SceneDraft;
pub use matrix::{ACCELERATIONS, MODES, RADII, WEIGHTS, each_device, render};
pub use models::{MODELS, Model};
pub use picture::{Picture, mean_difference, rms_difference};
pub use random::Random;
pub use scenes::{BALL_LIGHT, half_plane, open_floor, pile, soup, thin_wall};
