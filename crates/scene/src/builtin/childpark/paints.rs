//! The colours of the playground.

use crate::builtin::math::srgb;
use crate::builtin::parts::{Paint, Palette};

pub(super) struct Paints {
    pub(super) lawn: Paint,
    pub(super) path: Paint,
    pub(super) rubber: Paint,
    pub(super) sand: Paint,
    pub(super) castle: Paint,
    pub(super) timber: Paint,
    pub(super) plank: Paint,
    pub(super) steel: Paint,
    pub(super) iron: Paint,
    pub(super) white: Paint,
    pub(super) red: Paint,
    pub(super) blue: Paint,
    pub(super) yellow: Paint,
    pub(super) green: Paint,
    pub(super) chute: Paint,
    pub(super) bark: Paint,
    pub(super) shade: Paint,
    pub(super) foliage: [Paint; 3],
    pub(super) autumn: [Paint; 3],
    pub(super) grass: [Paint; 3],
}

pub(super) fn paints(palette: &mut Palette) -> Paints {
    Paints {
        lawn: palette.matt("lawn", srgb(0x8fb355)),
        path: palette.matt("path", srgb(0xd8c8a4)),
        rubber: palette.matt("rubber", srgb(0xc98a5b)),
        sand: palette.matt("sand", srgb(0xeed9a2)),
        castle: palette.matt("wet sand", srgb(0xd9b878)),
        timber: palette.matt("timber", srgb(0xa9794c)),
        plank: palette.matt("plank", srgb(0xc79460)),
        steel: palette.glossy("steel", srgb(0xb4bac0), 0.25, 40.0),
        iron: palette.glossy("iron", srgb(0x4a5560), 0.15, 30.0),
        white: palette.matt("white paint", srgb(0xf2efe6)),
        red: palette.glossy("red paint", srgb(0xd8412f), 0.2, 40.0),
        blue: palette.glossy("blue paint", srgb(0x2f78c4), 0.2, 40.0),
        yellow: palette.glossy("yellow paint", srgb(0xf4bf2c), 0.2, 40.0),
        green: palette.glossy("green paint", srgb(0x3f8a5a), 0.15, 40.0),
        chute: palette.glossy("chute", srgb(0x35a0c8), 0.35, 30.0),
        bark: palette.matt("bark", srgb(0x7d5f47)),
        shade: palette.matt("crown shade", srgb(0x4c7a38)),
        foliage: [0x5f9440, 0x6ea548, 0x83b653].map(|hex| palette.matt("foliage", srgb(hex))),
        autumn: [0x9cab45, 0xb5b84c, 0x8aa542].map(|hex| palette.matt("light foliage", srgb(hex))),
        grass: [0x7fae4a, 0x94bd57, 0x6f9e44].map(|hex| palette.matt("grass", srgb(hex))),
    }
}
