//! Parts of the renderer by themselves.

mod accel;
mod antialiasing;
mod bands;
mod cache;
mod counters;
mod cuda;
mod data;
mod device;
mod footprint;
mod gathered;
mod light_mesh;
mod material_ids;
mod passes;
mod prepared;
mod probes;
mod progress;
mod sampling;
mod settings;
mod shading;
mod shadow;
mod stage;
mod stages;
mod surface;
mod textures;
mod view;

use lightmesh_render::{Footprint, LightGroups, Plan};

/// A plan of an image without anything that was not asked for, with `left` bytes.
fn plain(size: [u32; 2], lights: LightGroups, left: Option<u64>) -> Plan {
    Plan {
        size,
        antialiasing: None,
        bounces: 0,
        lets_through: false,
        coverage: false,
        caught: false,
        layers: None,
        compositing: false,
        gathering: None,
        lights,
        most_rows: None,
        memory_limit: left,
        left,
        kept: 0,
        reserved: 0,
        footprint: Footprint::default(),
    }
}
