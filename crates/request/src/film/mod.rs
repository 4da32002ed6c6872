//! Films: what moves, which frames are wanted, their rendering, and where they go.

mod container;
mod frames;
mod movie;
mod plan;
mod writer;

pub use container::Container;
pub use frames::{FrameRenderer, RenderedFrame};
pub(crate) use frames::{explain, summary};
pub use movie::check_encoder;
pub use plan::{Film, FrameRange, Motion};
pub(crate) use writer::{FrameWriter, begin, write};
