//! Numbers that belong to a record, such as the kinds of lights: associated constants on both sides. `Hit::NONE` is written the same in
//! Rust and in C++.

use crate::geometry::{Hit, Tally};
use crate::literal::Constant;
use crate::mesh::LightMesh;
use crate::scene::{Light, Material, Texture};

macro_rules! constants_of_records {
    ($($record:ident { $($(#[doc = $doc:literal])* $name:ident = $value:expr;)* })*) => {
        $(impl $record { $($(#[doc = $doc])* pub const $name: u32 = $value;)* })*

        /// The constants of a record.
        pub(crate) fn of_record(record: &str) -> Vec<Constant> {
            match record {
                $(stringify!($record) => vec![$(Constant::new(stringify!($name), &[$($doc),*], $record::$name)),*],)*
                _ => Vec::new(),
            }
        }
    };
}

constants_of_records! {
    Hit {
        /// The triangle index that means "no triangle".
        NONE = u32::MAX;
    }
    Tally {
        /// Number of shards.
        SHARDS = 64;
    }
    Light {
        /// A point light.
        POINT = 0;
        /// Parallel light.
        DIRECTIONAL = 1;
        /// A spot without a size.
        SPOT = 2;
        /// A ball, with a cone if it is a spot. This kind and all that follow are area lights.
        SPHERE = 3;
        /// A disk.
        DISK = 4;
        /// A rectangle.
        RECTANGLE = 5;
        /// How it is seen: mirror rays see it,
        SEEN = 1;
        /// as a surface that is none of the scene's: rays that go on from any surface do,
        SURFACE = 2;
        /// and those of the camera.
        CAMERA = 4;
        /// Mirror rays see it in the image of what surrounds the scene, however rough the mirror is.
        PAINTED = 8;
        /// That image alone shows it in mirrors: what is seen there has no highlight of it.
        BOXED = 16;
    }
    Texture {
        /// The same again.
        REPEAT = 0;
        /// The same again, every other time mirrored.
        MIRROR = 1;
        /// The outermost texels.
        CLAMP = 2;
    }
    Material {
        /// The material has no texture.
        NO_TEXTURE = u32::MAX;
    }
    LightMesh {
        /// w of formula (3) is 1.
        WEIGHT_CONSTANT = 0;
        /// w falls with the square of the distance.
        WEIGHT_QUADRATIC = 1;
        /// w falls with the square of that.
        WEIGHT_SMOOTH = 2;
    }
}
