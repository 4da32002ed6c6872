//! The values of flags that are chosen from a list, and what they stand for in the library.

use std::path::Path;

use clap::ValueEnum;
use lightmesh::{render, scene};

/// How visibility is found.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Mode {
    /// The method
    LightMesh,
    /// One hard shadow ray per light
    RayTrace,
    /// Many shadow rays per light: the reference
    Area,
}

impl From<Mode> for render::Mode {
    fn from(mode: Mode) -> render::Mode {
        match mode {
            Mode::LightMesh => render::Mode::LightMesh,
            Mode::RayTrace => render::Mode::RayTrace,
            Mode::Area => render::Mode::Area,
        }
    }
}

/// The weight of formula (3).
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Weight {
    /// w = 1, as in the thesis
    Constant,
    /// w = 1 − q²
    Quadratic,
    /// w = (1 − q²)²
    Smooth,
}

impl From<Weight> for scene::Weight {
    fn from(weight: Weight) -> scene::Weight {
        match weight {
            Weight::Constant => scene::Weight::Constant,
            Weight::Quadratic => scene::Weight::Quadratic,
            Weight::Smooth => scene::Weight::Smooth,
        }
    }
}

/// How light-mesh mode looks visibility up.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Lookup {
    /// The best there is
    Auto,
    /// The weighted mean over the light points of a half-ball, formula (3)
    HalfBall,
}

impl From<Lookup> for render::Lookup {
    fn from(lookup: Lookup) -> render::Lookup {
        match lookup {
            Lookup::Auto => render::Lookup::Auto,
            Lookup::HalfBall => render::Lookup::HalfBall,
        }
    }
}

/// How short tests are evaluated.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ShortTests {
    /// By light-mesh cell, with the cell's possible occluders found once
    Cells,
    /// One segment after the other: the oracle
    Plain,
}

impl From<ShortTests> for render::ShortTests {
    fn from(short_tests: ShortTests) -> render::ShortTests {
        match short_tests {
            ShortTests::Cells => render::ShortTests::Cells,
            ShortTests::Plain => render::ShortTests::Plain,
        }
    }
}

/// The acceleration structure; see `plan::settings` for what becomes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Accel {
    /// The fastest on the device
    Auto,
    /// The regular grid of the thesis
    Grid,
    /// A wide bounding volume hierarchy
    Bvh,
}

/// Which axis points up.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Up {
    /// What files of the scene's kind have: z for STL, else y
    Auto,
    /// glTF, most OBJ
    Y,
    /// CAD, most STL
    Z,
}

impl Up {
    /// The axis, for the scene in this file.
    pub(crate) fn of(self, scene: &Path) -> scene::Up {
        match self {
            Up::Auto => scene::Up::of_file(scene),
            Up::Y => scene::Up::Y,
            Up::Z => scene::Up::Z,
        }
    }
}

/// What distance does to a light.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Falloff {
    /// Nothing, as in the thesis
    None,
    /// Intensity is in candela
    InverseSquare,
}

impl From<Falloff> for scene::Falloff {
    fn from(falloff: Falloff) -> scene::Falloff {
        match falloff {
            Falloff::None => scene::Falloff::None,
            Falloff::InverseSquare => scene::Falloff::InverseSquare,
        }
    }
}

/// The transfer function of 8-bit files.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Transfer {
    /// For screens
    Srgb,
    /// For measuring
    Linear,
}

impl Transfer {
    /// The word on the command line and in statistics.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Transfer::Srgb => "srgb",
            Transfer::Linear => "linear",
        }
    }
}

impl From<Transfer> for lightmesh::Transfer {
    fn from(transfer: Transfer) -> lightmesh::Transfer {
        match transfer {
            Transfer::Srgb => lightmesh::Transfer::Srgb,
            Transfer::Linear => lightmesh::Transfer::Linear,
        }
    }
}

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Progress {
    /// A bar, unless --quiet
    Auto,
    /// A bar where stderr is a terminal
    Bar,
    /// One JSON object a line
    Json,
    /// Nothing
    None,
}
