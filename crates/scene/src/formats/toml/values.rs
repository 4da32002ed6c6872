//! Values that several tables of a scene file have, as serde types.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::spanned::Spanned;

pub(super) type Number = Spanned<f64>;
pub(super) type Vector = Spanned<[f64; 3]>;
pub(super) type Text = Spanned<String>;

/// A number for all channels, or red, green and blue.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(untagged, expecting = "expected a number or [red, green, blue]")]
pub(crate) enum Color {
    Grey(f64),
    Rgb([f64; 3]),
}

/// One factor, or one per axis.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(untagged, expecting = "expected a number or [x, y, z]")]
pub(crate) enum Scale {
    Uniform(f64),
    ByAxis([f64; 3]),
}

impl Scale {
    /// The factors by axis.
    pub(super) fn factors(&self) -> DVec3 {
        match *self {
            Scale::Uniform(factor) => DVec3::splat(factor),
            Scale::ByAxis(factors) => factors.into(),
        }
    }
}
