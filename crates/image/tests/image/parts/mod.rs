//! Parts of the crate by themselves.

mod bmp;
mod compare;
mod deflate;
mod display;
mod exposure;
mod exr;
mod format;
mod frame;
mod jpg;
mod matte;
mod options;
mod png;
mod transfer;
