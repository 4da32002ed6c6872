mod file;
mod host;
mod noticed;
