//! Values of settings: each type is read from text and validated on construction, and shown as it is written.
//!
//! All lengths and positions are in world coordinates and scene units, in double precision like scene files.

mod camera;
mod choices;
mod frame_rate;
mod frames;
mod light;
mod memory;
mod number;
mod size;
mod sky;
mod smooth;
mod sun;

pub use camera::CameraView;
pub use choices::{Switch, UpChoice};
pub use frame_rate::FrameRate;
pub use frames::{Frames, numbered};
pub use light::{Background, Color, LightSpec};
pub use memory::ByteSize;
pub use number::{Bound, Exposure, Positive, number_and_unit};
pub use size::{Dims, Size};
pub use sky::{EnvironmentSpec, SkySpec};
pub use smooth::Smooth;
pub use sun::{SunSpec, clock};

/// Why a value is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// The text has the wrong form.
    #[error("write {form}, for instance {example}")]
    Form {
        /// The expected form.
        form: &'static str,
        /// A valid example.
        example: &'static str,
    },
    /// The text has too few parts, or too many.
    #[error("it has {count} parts between commas instead of {form}, for instance {example}")]
    Parts {
        /// How many it has.
        count: usize,
        /// How many it should have, and what they are.
        form: &'static str,
        /// A valid example.
        example: &'static str,
    },
    /// A part of the text cannot be read.
    #[error("{what} {}: write {form}, for instance {example}", missing_or(text))]
    Part {
        /// What the part is.
        what: &'static str,
        /// The part, which may be empty.
        text: String,
        /// What it should be.
        form: &'static str,
        /// A valid example of it.
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
        problem: lightmesh_scene::SunError,
    },
    /// The camera has no direction.
    #[error("position and target are the same point: move one of them")]
    NoDirection,
}

/// What is wrong with a part.
fn missing_or(text: &str) -> String {
    if text.is_empty() { "is missing".to_owned() } else { format!("cannot be `{text}`") }
}
