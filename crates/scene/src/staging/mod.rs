//! What a picture needs and a file may lack: a view, lights, a ground, the axis that points up; and the moment that is shown.

pub(crate) mod framing;
mod ground;
mod missing;
mod moment;
mod outdoors;
mod studio;
mod up;

pub use framing::{Added, Lighting, UnknownCamera, Viewpoint};
pub use up::UpInfo;
