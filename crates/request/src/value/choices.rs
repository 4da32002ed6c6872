//! Values that are chosen from a list and exist in requests alone.

use lightmesh_scene::{SceneFormat, Up, parse_by_name};

/// Something that is on or off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// On.
    On,
    /// Off.
    #[default]
    Off,
}

impl Switch {
    /// Both.
    pub const ALL: &[Switch] = &[Switch::On, Switch::Off];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Switch::On => "on",
            Switch::Off => "off",
        }
    }

    /// It needs none.
    pub fn help(self) -> &'static str {
        ""
    }
}

parse_by_name!(Switch, "switch");

/// The axis that points up, or how it is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpChoice {
    /// By the file's format, or the scene's shape.
    #[default]
    Auto,
    /// The y axis.
    Y,
    /// The z axis.
    Z,
}

impl UpChoice {
    /// All of them; the default comes first.
    pub const ALL: &[UpChoice] = &[UpChoice::Auto, UpChoice::Y, UpChoice::Z];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            UpChoice::Auto => "auto",
            UpChoice::Y => "y",
            UpChoice::Z => "z",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            UpChoice::Auto => "z for STL, y for others; for OBJ, PLY and STL without a camera, by the shape",
            UpChoice::Y => "glTF, most OBJ",
            UpChoice::Z => "CAD, most STL",
        }
    }

    /// The up axis of a scene of this format; built-in ones have none.
    pub fn of(self, format: Option<SceneFormat>) -> Up {
        match self {
            UpChoice::Auto => format.map_or(Up::Y, SceneFormat::usual_up),
            UpChoice::Y => Up::Y,
            UpChoice::Z => Up::Z,
        }
    }
}

parse_by_name!(UpChoice, "up axis");
