#[cfg(feature = "mesh-file")]
mod file;
mod host;
mod noticed;
