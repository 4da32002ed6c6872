//! What a picture of a file is: one typed [`Request`] that the command line, Rust programs, Python and Blender all fill in, and the work on it.
//!
//! ```text
//! Request ─▶ Plan ─▶ stage ─▶ prepare ─▶ expose ─▶ picture · film · sun study ─▶ files, manifest
//! ```
//!
//! * [`Request`] has a field for each setting. The [table](FIELDS) of them is what faces are made of: flags, keyword arguments, annotations.
//! * A [`Plan`] is a request that is checked as far as possible without the scene; [`Order`] names the scene and the files to write.
//! * A [`Session`] has the scene staged, which means that it has the camera, the lights and the ground that it lacked, and prepared. It renders
//!   pictures, [films](mod@film) and [sun studies](sun).
//! * A program that serves many orders keeps what is [`Warm`].
//! * [Many processes](cluster) render one film or picture together.
//! * A [`Host`] is the program around: it shows notes and progress, and can end the work.
//! * Errors name settings; each face [turns](Told) the names into its own [`Words`].
#![forbid(unsafe_code)]

mod clipping;
pub mod cluster;
mod context;
mod error;
mod expose;
mod fields;
pub mod files;
pub mod film;
mod host;
mod image_plan;
mod items;
mod manifest;
mod mesh_file;
mod open;
mod order;
mod plan;
mod report;
mod request;
mod save;
mod session;
mod settings;
mod stage;
mod staged;
pub mod sun;
pub mod table;
mod told;
pub mod value;
mod warm;
mod words;

pub use error::{ClusterError, Error, ManifestError, MovieChoiceError, MovieError, RequestError, StageError};
pub use fields::{field, nearest};
pub use host::{BUILDING, FrameDone, Host, Part, Parts, RENDERING};
pub use image_plan::{ImagePlan, StagedImage, StoragePlan};
pub use open::{FilmFrames, Picture, film, picture, sun_hours};
pub use order::{Order, format_of};
pub use plan::{Plan, load_options};
pub use request::{FIELDS, Field, Request};
pub use save::describe;
pub use session::{Frames, Session, fewer_threads};
pub use told::Told;
pub use warm::{Warm, WarmDevices};
pub use words::{Name, Words};
