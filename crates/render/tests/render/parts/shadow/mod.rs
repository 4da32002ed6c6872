mod horizon;
mod rows;
mod sample_ray;
mod terminator;
