mod gpu;
#[cfg(feature = "cuda")]
mod library;
#[cfg(feature = "cuda")]
mod open;
#[cfg(feature = "cuda")]
mod ptx;
