//! Flag values parsed from text: each type is validated on construction.
//!
//! All lengths and positions are in world coordinates and scene units, in double precision like scene files.

mod budget;
mod camera;
mod frame_rate;
mod frames;
mod light;
mod memory;
mod number;
mod size;
mod sky;
mod smooth;
mod sun;

pub(crate) use budget::Budget;
pub(crate) use camera::CameraView;
pub(crate) use frame_rate::FrameRate;
pub(crate) use frames::{Frames, numbered};
pub(crate) use light::{Background, Color, LightSpec};
pub(crate) use memory::ByteSize;
pub(crate) use number::{Bound, Exposure, Positive};
pub(crate) use size::{Dims, Size};
pub(crate) use sky::{EnvironmentSpec, SkySpec};
pub(crate) use smooth::Smooth;
pub(crate) use sun::{SunSpec, clock};

/// Why a value is invalid. The command line parser prepends the flag and the text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum ValueError {
    /// The text has the wrong form.
    #[error("write {form}, for instance {example}")]
    Form {
        /// The expected form.
        form: &'static str,
        /// A valid example.
        example: &'static str,
    },
    /// A part of the text is not a number, or out of range of single precision.
    #[error("`{text}` is not a valid number: write a decimal number, for instance 0.5")]
    NotANumber {
        /// The part.
        text: String,
    },
    /// A number is too large or too small.
    #[error("{what} must be {range}, but is {text}")]
    OutOfRange {
        /// The name of the number.
        what: &'static str,
        /// The number.
        text: String,
        /// Its valid range.
        range: &'static str,
    },
    /// There is no sun then, or there.
    #[error("{problem}")]
    Sun {
        /// Why.
        problem: lightmesh::scene::SunError,
    },
    /// The camera has no direction.
    #[error("position and target are the same point: move one of them")]
    NoDirection,
}
