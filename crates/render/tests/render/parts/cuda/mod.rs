mod gpu;
mod library;
mod open;
mod ptx;
