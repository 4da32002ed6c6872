mod dielectric;
mod environment;
mod facets;
mod lights;
mod normal_map;
mod tint;
