mod batch;
mod cells;
mod masks;
