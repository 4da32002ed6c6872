mod file;
mod host;
mod invalidation;
