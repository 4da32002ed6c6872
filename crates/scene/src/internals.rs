//! Parts of the crate for its own tests, which are in `tests/scene/parts`. They are no interface: they change with any release.
//!
//! Tests are a crate of their own, so that this one is compiled once, not a second time with its tests.

pub mod animation {
    pub use crate::model::animation::parts::{Hold, Influences, Morph, Shape, Skin, Target, cofactors};
    pub use crate::model::animation::rig::{Node, Place, Rig};
    pub use crate::model::animation::track::{Interpolation, Kind, Track};
}

pub mod file_access {
    pub use crate::build::file_access::FileAccess;
}

pub mod builder {
    pub use crate::model::transforms::normal_placement;

    use glam::DMat4;

    use crate::build::loaded_mesh::LoadedMesh;
    use crate::{Position, SceneBuilder};

    /// Adds a mesh passed by value.
    pub fn take<P: Position>(builder: &mut SceneBuilder, mesh: LoadedMesh<P>, transform: &DMat4) {
        builder.take(mesh, transform);
    }
}

pub mod builtin {
    pub use crate::builtin::math::{Random, around, srgb};
}

pub mod camera {
    pub use crate::model::camera::{LARGEST_SHIFT, upper_edge};
}

pub mod draft {
    pub use crate::build::draft::Draft;
}

pub mod environment {
    use std::path::Path;

    use lightmesh_memory::Budget;

    use crate::{Environment, EnvironmentError, Up};

    pub use crate::model::colors::luminance;
    pub use crate::model::environment::from_angles;
    pub use crate::model::environment::sky::{clear, sun_illuminance};

    /// The image in the content of the file at `path`.
    pub fn decode(path: &Path, bytes: &[u8], up: Up, budget: Budget) -> Result<Environment, EnvironmentError> {
        Environment::decode(path, bytes, up, budget)
    }
}

pub mod error {
    pub use crate::build::error::suggestion;
}

pub mod formats {
    pub mod colors {
        pub use crate::model::colors::linear;
    }

    pub mod gltf {
        pub use crate::formats::gltf::integers::as_integers;
        pub use crate::formats::gltf::meshes::{Mode, triangles, vertices_used};
        pub use crate::formats::gltf::picture::affine;
        pub use crate::formats::gltf::strided::{Component, Strided};
        pub use crate::formats::gltf::uri::{Uri, decode};
    }

    pub mod notes {
        pub use crate::formats::notes::Notes;
    }

    pub mod obj {
        pub use crate::formats::obj::lines::Lines;
        pub use crate::formats::obj::map::Map;
        pub use crate::formats::obj::smoothing::{Smoothing, group};
    }

    pub mod polygon {
        pub use crate::formats::polygon::{Cutter, PATIENCE};
    }

    pub mod text {
        pub use crate::formats::text::{decoded, number, odd_number, quoted, with_line_feeds};
    }

    pub mod vertices {
        pub use crate::formats::vertices::{Corner, NONE, Vertices};
    }
}

pub mod framing {
    pub use crate::staging::framing::fitting::{FILL, VFOV, corner};
    pub use crate::staging::framing::sight::{Seen, Sight, distance};
}

pub mod geometry_check {
    pub use crate::build::geometry_check::first_beyond;
}

pub mod lamps {
    pub use crate::optics::lamps::lamps;
    pub use crate::optics::lamps::merged::LIGHTS;
}

pub mod loaded_mesh {
    pub use crate::build::loaded_mesh::LoadedMesh;
}

pub mod objects {
    use crate::Objects;

    /// Continues with the objects of another mesh.
    pub fn append(objects: &mut Objects, first: usize, other: &Objects, place: impl Fn(u32) -> usize) {
        objects.append(first, other, place);
    }
}

pub mod opacity {
    use crate::{OpacityChannel, Texture};

    /// The channel of an image of which nothing is said.
    pub fn suggested_by(texture: &Texture) -> OpacityChannel {
        OpacityChannel::suggested_by(texture)
    }
}

pub mod principled {
    use glam::Vec3;

    use crate::Principled;
    pub use crate::optics::principled::{SHARPEST, shininess};

    /// What the layer reflects at normal and at grazing incidence.
    pub fn reflectance(of: &Principled) -> (Vec3, f32) {
        of.reflectance()
    }
}

pub mod quote {
    pub use crate::build::quote::{MESSAGE, QUOTED, abridged, list, quote};
}

pub mod shapes {
    pub use crate::build::shapes::{Shape, tangents};
}

pub mod smooth {
    pub use crate::build::smooth::buckets::Buckets;
    pub use crate::build::smooth::facets::{corner_angle, normal};
    pub use crate::build::smooth::steps::STEPS;
    pub use crate::build::smooth::weld::weld;
    pub use crate::build::smooth::{Unsmooth, smooth};
}

pub mod texture {
    pub use crate::build::textures::decode::{Undecodable, decode};
    pub use crate::build::textures::missing_uvs::untextured;
    pub use crate::optics::heights::{is_grey, normals_of_heights};
    pub use crate::optics::packed::packed;
}

pub mod sanitize {
    pub use crate::build::sanitize::{clamp_reflectance, drop_invalid_positions, keep_finite, too_long, unseen};
}

pub mod vertices {
    pub use crate::build::vertices::Vertices;
}

pub mod warnings {
    pub use crate::build::warnings::{MOST, Warnings};
}
