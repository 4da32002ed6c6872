//! Settings chosen by name: mode, lookup, short tests; and the step.

use std::fmt;
use std::str::FromStr;

use lightmesh_scene::{Scene, parse_by_name};

use crate::techniques::table::technique_table;

macro_rules! words {
    (
        modes { $($(#[doc = $mode_help:literal])* $mode:ident = $mode_word:literal,)* }
        lookups { $($(#[doc = $lookup_help:literal])* $lookup:ident = $lookup_word:literal,)* }
        techniques $techniques:tt
    ) => {
        /// How visibility is computed.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Mode {
            #[default]
            $($(#[doc = $mode_help])* $mode,)*
        }

        impl Mode {
            /// All modes; the default comes first.
            pub const ALL: &[Mode] = &[$(Mode::$mode),*];

            /// The name on the command line and in statistics.
            pub fn name(self) -> &'static str {
                match self {
                    $(Mode::$mode => $mode_word,)*
                }
            }

            /// A short description.
            pub fn help(self) -> &'static str {
                match self {
                    $(Mode::$mode => concat!($($mode_help),*).trim_ascii_start(),)*
                }
            }
        }

        /// How light-mesh mode determines the visibility of a light at a surface point.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Lookup {
            /// Occluder lists, or a half-ball if step, radius or weight are set, which only that has.
            #[default]
            Auto,
            $($(#[doc = $lookup_help])* $lookup,)*
        }

        impl Lookup {
            /// All lookups; the default comes first.
            pub const ALL: &[Lookup] = &[Lookup::Auto, $(Lookup::$lookup),*];

            /// The name on the command line and in statistics.
            pub fn name(self) -> &'static str {
                match self {
                    Lookup::Auto => "auto",
                    $(Lookup::$lookup => $lookup_word,)*
                }
            }

            /// A short description.
            pub fn help(self) -> &'static str {
                match self {
                    Lookup::Auto => "Lists, or half-ball if step, radius or weight are set.",
                    $(Lookup::$lookup => concat!($($lookup_help),*).trim_ascii_start(),)*
                }
            }
        }
    };
}

technique_table!(words);
parse_by_name!(Mode, "mode");
parse_by_name!(Lookup, "lookup");

/// The light-mesh step h. As text: `auto`, or a number above 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Step {
    /// Derived from the size of a pixel in the scene.
    #[default]
    Auto,
    /// In scene units.
    Fixed(f32),
}

impl From<f32> for Step {
    /// This many scene units.
    fn from(step: f32) -> Step {
        Step::Fixed(step)
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Step::Auto => f.pad("auto"),
            Step::Fixed(step) => step.fmt(f),
        }
    }
}

impl FromStr for Step {
    type Err = UnknownStep;

    fn from_str(text: &str) -> Result<Step, UnknownStep> {
        if text == "auto" {
            return Ok(Step::Auto);
        }
        let step = text.trim().parse().ok().filter(|step: &f32| *step > 0.0 && step.is_finite());
        step.map(Step::Fixed).ok_or_else(|| UnknownStep(text.to_owned()))
    }
}

/// A text that is not a light-mesh step.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("invalid light-mesh step `{0}`: use a number above 0, or auto")]
pub struct UnknownStep(pub String);

/// How the short tests are evaluated. The masks are bit-identical.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShortTests {
    /// By light-mesh cell: the possible occluders of a cell are found once.
    #[default]
    Cells,
    /// One segment after another through the acceleration structure: the reference.
    Plain,
}

impl ShortTests {
    /// All of them.
    pub const ALL: &'static [ShortTests] = &[ShortTests::Cells, ShortTests::Plain];

    /// Its name, also in statistics.
    pub fn name(self) -> &'static str {
        match self {
            ShortTests::Cells => "cells",
            ShortTests::Plain => "plain",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            ShortTests::Cells => "By light-mesh cell: the possible occluders of a cell are found once",
            ShortTests::Plain => "One segment after another: the reference",
        }
    }
}

parse_by_name!(ShortTests, "short-test method");

/// How area mode tests the samples of a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShadowTests {
    /// Row by row: each triangle between a surface point and a light hides some samples of each row. The reference for occluder lists,
    /// which give the same bits.
    #[default]
    Rows,
    /// A ray to each sample, for comparison: next to an edge a ray may be rounded to the other side.
    Rays,
}

impl ShadowTests {
    /// All of them.
    pub const ALL: &'static [ShadowTests] = &[ShadowTests::Rows, ShadowTests::Rays];

    /// Its name, also in statistics.
    pub fn name(self) -> &'static str {
        match self {
            ShadowTests::Rows => "rows",
            ShadowTests::Rays => "rays",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            ShadowTests::Rows => "Row by row of samples, by the triangles in the way",
            ShadowTests::Rays => "A ray to each sample",
        }
    }
}

parse_by_name!(ShadowTests, "shadow-test method");

/// What surfaces do to shadows that let light through: panes, curtains and bodies of glass. The camera sees them in any case, and what is
/// [cut out](lightmesh_scene::OpacityMode::Mask) hides where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Glass {
    /// Where less than half of the light stops, nothing is hidden; elsewhere they are opaque.
    #[default]
    Open,
    /// They are opaque.
    Closed,
    /// They leave as much of the light as they let through.
    Tinted,
}

impl Glass {
    /// All of them; the default comes first.
    pub const ALL: &'static [Glass] = &[Glass::Open, Glass::Closed, Glass::Tinted];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Glass::Open => "open",
            Glass::Closed => "closed",
            Glass::Tinted => "tinted",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Glass::Open => "It hides no sun; what is at least half opaque does",
            Glass::Closed => "It hides the sun as a wall does",
            Glass::Tinted => "Behind it counts the share of the light that it lets through",
        }
    }
}

parse_by_name!(Glass, "glass");

/// How good the shadows of lights with a size are, and how much time they may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quality {
    /// 16 samples of a light in a pixel, 4 samples of the pixel.
    Draft,
    /// 64, and 8 of the pixel.
    #[default]
    Good,
    /// 256, and 16 of the pixel.
    Final,
}

impl Quality {
    /// All of them.
    pub const ALL: &'static [Quality] = &[Quality::Draft, Quality::Good, Quality::Final];

    /// Its name, also in statistics.
    pub fn name(self) -> &'static str {
        match self {
            Quality::Draft => "draft",
            Quality::Good => "good",
            Quality::Final => "final",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Quality::Draft => "16 samples of a light in a pixel, 4 of the pixel: for a quick look",
            Quality::Good => "64, and 8 of the pixel: hardly any noise",
            Quality::Final => "256, and 16 of the pixel: no visible noise",
        }
    }

    /// Samples of a pixel.
    pub fn pixel_samples(self) -> u32 {
        match self {
            Quality::Draft => 4,
            Quality::Good => 8,
            Quality::Final => 16,
        }
    }

    /// Samples of a light with a size in a pixel.
    pub fn samples(self) -> u32 {
        match self {
            Quality::Draft => 16,
            Quality::Good => 64,
            Quality::Final => 256,
        }
    }
}

parse_by_name!(Quality, "quality");

/// The filter over which a pixel's colour is averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filter {
    /// The pixel's square.
    Box,
    /// A bell with a standard deviation of 0.375 pixels, cut off at three of them.
    Gauss,
    /// Blackman and Harris' window, 1.5 pixels to either side: smooth edges, hardly blurred.
    #[default]
    BlackmanHarris,
}

impl Filter {
    /// All of them.
    pub const ALL: &'static [Filter] = &[Filter::Box, Filter::Gauss, Filter::BlackmanHarris];

    /// Its name, also in statistics.
    pub fn name(self) -> &'static str {
        match self {
            Filter::Box => "box",
            Filter::Gauss => "gauss",
            Filter::BlackmanHarris => "blackman-harris",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Filter::Box => "The pixel's square",
            Filter::Gauss => "A bell with a standard deviation of 0.375 pixels",
            Filter::BlackmanHarris => "1.5 pixels to either side: smooth edges, hardly blurred",
        }
    }

    /// Its width in pixels.
    pub fn width(self) -> f64 {
        match self {
            Filter::Box => 1.0,
            Filter::Gauss => 2.25,
            // Widths of this filter are usually stated from the centre: this is "1.5" in Cycles.
            Filter::BlackmanHarris => 3.0,
        }
    }
}

parse_by_name!(Filter, "filter");

/// What stands for light that does not come from lights directly: from the surroundings, and from other surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum AmbientSource {
    /// The mesh where an environment gives the ambient light, or all lights are lamps, or the program put one into a room, unless ambient light is set or
    /// these are the lights of a [studio](lightmesh_scene::Lighting::Studio); else a constant.
    #[default]
    Auto,
    /// A constant, or what a sky gives to surfaces with nothing in between.
    Constant,
    /// What points of the surfaces gather from the surroundings and from other surfaces.
    Mesh,
    /// The same, gathered by each surface point on its own: what the mesh is compared with. Thousands of rays leave each of them, in the same
    /// directions everywhere, so that nothing changes but what is seen.
    Rays,
}

impl AmbientSource {
    /// All of them.
    pub const ALL: &'static [AmbientSource] =
        &[AmbientSource::Auto, AmbientSource::Constant, AmbientSource::Mesh, AmbientSource::Rays];

    /// Its name, also in statistics.
    pub fn name(self) -> &'static str {
        match self {
            AmbientSource::Auto => "auto",
            AmbientSource::Constant => "constant",
            AmbientSource::Mesh => "mesh",
            AmbientSource::Rays => "rays",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            AmbientSource::Auto => "Mesh with sky, environment or only lamps; constant otherwise, or by `ambient`",
            AmbientSource::Constant => "The ambient intensity; under a sky by direction, without shadows",
            AmbientSource::Mesh => "Gathered from the sky and other surfaces, in place of `ambient`",
            AmbientSource::Rays => "Gathered by thousands of rays at each surface point: slow, the reference",
        }
    }

    /// What is chosen for a scene.
    pub fn for_scene(self, scene: &Scene) -> AmbientSource {
        if self != AmbientSource::Auto {
            return self;
        }
        let lights = &scene.lights;
        match lights.ambient {
            None if lights.studio => AmbientSource::Constant,
            None if lights.environment.is_some() || lights.room || lights.are_lamps() => AmbientSource::Mesh,
            None if scene.geometry.glows() => AmbientSource::Mesh,
            _ => AmbientSource::Constant,
        }
    }
}

parse_by_name!(AmbientSource, "ambient light");

/// Whether samples of a pixel that lie on one surface are shaded together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Sharing {
    /// Where that is not seen.
    #[default]
    Unseen,
    /// Never: the reference. So it always is with more than 32 samples.
    Never,
}
