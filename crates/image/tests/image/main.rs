//! Images through the public interface: saved, loaded and compared.

mod comparison;
mod formats;
mod pictures;
mod saving;
