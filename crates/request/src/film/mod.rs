//! Films: what moves, which frames are wanted, their rendering, and where they go.

mod container;
mod frames;
mod movie;
mod pipeline;
mod plan;
mod said;
mod together;
mod writer;

pub use container::Container;
pub use frames::{FrameRenderer, RenderedFrame};
pub(crate) use frames::{explain, summary};
pub use movie::check_encoder;
pub(crate) use pipeline::write;
pub use plan::{Film, FrameRange, Motion};
pub(crate) use together::{Finished, devices, render_ahead};
pub(crate) use writer::{FrameWriter, InFrame, begin};
