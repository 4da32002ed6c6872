//! Values of flags, read from text: each type is checked when it is made, so that nothing later has to doubt it.
//!
//! All lengths and positions are in world coordinates and scene units, in double precision as scene files are.

mod budget;
mod camera;
mod light;
mod memory;
mod number;
mod size;

pub(crate) use budget::Budget;
pub(crate) use camera::CameraView;
pub(crate) use light::{Color, LightSpec};
pub(crate) use memory::ByteSize;
pub(crate) use number::{Bound, Exposure, Positive, StepValue};
pub(crate) use size::{Dims, Size};

/// What is wrong with the text of a value. The parser of the command line puts the flag and the text before it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum ValueError {
    /// The text has another form.
    #[error("write {form}, for instance {example}")]
    Form {
        /// What is expected.
        form: &'static str,
        /// A text that would do.
        example: &'static str,
    },
    /// A part of the text is no number, or one that single precision cannot hold.
    #[error("`{text}` is not a number that can be used: write a decimal number, for instance 0.5")]
    NotANumber {
        /// The part.
        text: String,
    },
    /// A number is too large or too small.
    #[error("{what} {text} is not {range}")]
    OutOfRange {
        /// What the number is.
        what: &'static str,
        /// The number.
        text: String,
        /// What it must be.
        range: &'static str,
    },
    /// The camera has no direction.
    #[error("position and target are the same point: move one of them")]
    NoDirection,
}
