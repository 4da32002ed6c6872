mod dielectric;
mod environment;
mod facets;
mod irradiance;
mod lights;
mod normal_map;
mod tint;
mod turns;
