//! Linear pictures with layers: transfer functions, file formats and comparison.
//!
//! A renderer fills a [`Frame`]: linear colour, and optionally the [`Layers`] that say what each pixel saw. From there,
//!
//! - [`Frame::save`] writes bmp, png, exr or jpg by the path's extension, and [`Frame::save_layers`] a multilayer exr;
//! - [`Frame::load`] reads the same formats back into linear values;
//! - [`compare`] measures how far two frames differ, as numbers and as a picture (FLIP).
//!
//! Only here is a transfer function ([`Transfer`]) applied; everything else in the workspace computes with linear values.
//!
//! ```
//! use lightmesh_image::{Frame, check_writable, compare};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("grey.png");
//! check_writable(&path)?; // before rendering, so that no time is lost on a typing error
//!
//! let frame = Frame::new(64, 48, vec![[0.18; 3]; 64 * 48])?;
//! frame.save(&path)?;
//!
//! let comparison = compare(&frame, &Frame::load(&path)?)?;
//! assert!(comparison.max_difference < 0.5 / 255.0); // 8 bits are all that was lost
//! assert_eq!(comparison.mean_flip, 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bmp;
mod compare;
mod exposure;
mod exr;
mod format;
mod frame;
mod jpg;
mod load;
mod png;
mod save;
mod transfer;

pub use compare::{CompareError, Comparison, compare};
pub use format::Format;
pub use frame::{Frame, FrameError, Layers};
pub use load::{DecodeError, LoadError};
pub use save::{EncodeError, SaveError, check_size, check_writable};
pub use transfer::Transfer;
