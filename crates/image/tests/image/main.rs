//! Images through the public interface: saved, loaded and compared; and parts of the crate by themselves.

mod comparison;
mod formats;
mod parts;
mod pictures;
mod reading;
mod saving;
