mod auto_step;
mod bricks;
mod cell_points;
mod lattice;
mod template;
mod window;
