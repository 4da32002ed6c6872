//! The plan of the garden, and its colours.

use glam::Vec2;

use crate::builtin::math::srgb;
use crate::builtin::parts::{Paint, Palette};

/// Number of triangles up to which the lawn is filled with blades of grass.
pub(super) const TRIANGLES: usize = 234_000;

/// Half the size of the garden in x and z.
pub(super) const HALF: Vec2 = Vec2::new(10.0, 14.0);

pub(super) struct Paints {
    pub(super) earth: Paint,
    pub(super) soil: Paint,
    pub(super) flags: [Paint; 3],
    pub(super) stones: [Paint; 4],
    pub(super) coping: Paint,
    pub(super) marble: Paint,
    pub(super) water: Paint,
    pub(super) bark: Paint,
    pub(super) shade: Paint,
    pub(super) foliage: [Paint; 3],
    pub(super) box_tree: [Paint; 3],
    pub(super) silver: [Paint; 3],
    pub(super) ivy: [Paint; 3],
    pub(super) grass: [Paint; 4],
    pub(super) flowers: [Paint; 5],
}

/// A flower bed: an ellipse of soil with its centre and half-axes in x and z.
pub(super) struct Bed {
    pub(super) center: Vec2,
    pub(super) radii: Vec2,
}

const fn bed(x: f32, z: f32, rx: f32, rz: f32) -> Bed {
    Bed { center: Vec2::new(x, z), radii: Vec2::new(rx, rz) }
}

/// The first four are visible in the image.
pub(super) const BEDS: [Bed; 8] = [
    bed(-2.0, -7.4, 1.1, 1.5),
    bed(2.5, -7.8, 1.1, 1.9),
    bed(-2.9, -12.0, 2.3, 1.3),
    bed(3.2, -12.2, 2.1, 1.2),
    bed(-6.4, -3.0, 1.6, 2.6),
    bed(6.2, 1.5, 1.7, 3.0),
    bed(-5.6, 7.6, 2.0, 2.4),
    bed(3.6, 10.4, 3.0, 1.6),
];

/// Position of the fountain.
pub(super) const FOUNTAIN: Vec2 = Vec2::new(0.1, -10.4);

pub(super) fn paints(palette: &mut Palette) -> Paints {
    Paints {
        earth: palette.matt("earth", srgb(0x748c48)),
        soil: palette.matt("soil", srgb(0x6e5138)),
        flags: [0xcdc4b2, 0xbdb3a1, 0xd8cfbd].map(|hex| palette.matt("flagstone", srgb(hex))),
        stones: [0xc4a98a, 0xb3967a, 0xcdb79b, 0xa98e77].map(|hex| palette.matt("stone", srgb(hex))),
        coping: palette.matt("coping", srgb(0xd6cbb8)),
        marble: palette.glossy("marble", srgb(0xe9e4d8), 0.12, 30.0),
        water: palette.glossy("water", srgb(0x5fa7b8), 0.4, 60.0),
        bark: palette.matt("bark", srgb(0x80644c)),
        shade: palette.matt("crown shade", srgb(0x3f6630)),
        foliage: [0x6ea043, 0x82b550, 0x5c8c3c].map(|hex| palette.matt("leaf", srgb(hex))),
        box_tree: [0x4e8546, 0x5f9950, 0x41743f].map(|hex| palette.matt("box leaf", srgb(hex))),
        silver: [0x9db592, 0x87a583, 0xb1c5a4].map(|hex| palette.matt("silver leaf", srgb(hex))),
        ivy: [0x3f7a3c, 0x4f8d45, 0x6aa351].map(|hex| palette.matt("ivy", srgb(hex))),
        grass: [0x86b24a, 0x97c256, 0x75a244, 0xa8cc66].map(|hex| palette.matt("grass", srgb(hex))),
        flowers: [0xe2557c, 0xf4c534, 0x8a66c8, 0xf6f0e4, 0xe8743b].map(|hex| palette.matt("petal", srgb(hex))),
    }
}
