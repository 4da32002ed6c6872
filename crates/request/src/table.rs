//! The table of all settings: what each is called, what it means, and how it is read and shown. Faces are made from it.
//!
//! [`settings!`](crate::request) declares the type [`Request`](crate::Request) and, for each of its fields, a row of this table. So a new setting is one entry there, and
//! then it is a flag with its help, a keyword argument with its annotation, a key of serialised requests, and a line of a film's manifest.

use std::ops::RangeInclusive;

use lightmesh_image::{BitDepth, ExrCompression, ExrParts, ExrSamples, Format, Transfer, View};
use lightmesh_render::{Acceleration, AmbientSource, Crop, Device, Filter, Lookup, Mode, Quality, ShortTests, Step};
use lightmesh_scene::{Falloff, Instancing, SceneFormat, Weight};
use serde::{Deserialize, Serialize};

use crate::request::Request;
use crate::value::{
    Background, ByteSize, CameraView, Color, Dims, EnvironmentSpec, Exposure, FrameRate, Frames, LightSpec, Positive,
    Size, SkySpec, Smooth, SunSpec, Switch, UpChoice,
};
use crate::words::Name;

/// What a setting is about, which decides where it can be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// How a scene is read.
    Reading,
    /// How much memory all of it may take.
    Memory,
    /// What moves in a film.
    Motion,
    /// Which frames of a film are rendered, and what becomes of those that exist.
    Frames,
    /// How meshes and animations are read.
    Form,
    /// How image files store what they show.
    Storage,
    /// How bright image files are.
    Exposure,
    /// What an image shows, and how it is computed.
    Image,
    /// Whether an image has layers.
    Layers,
    /// What the work is done by.
    Machine,
}

/// How a setting is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It is on if it is given.
    Switch,
    /// With one value.
    Value,
    /// With one value each time that it is given.
    List,
}

/// Whether a value may begin with a minus sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Minus {
    /// No.
    Never,
    /// It may be a negative number.
    Number,
    /// It may be any text.
    Text,
}

/// A word that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The word.
    pub name: &'static str,
    /// What it means; may be empty.
    pub help: &'static str,
}

/// A setting: a field of [`Request`].
#[derive(Debug)]
pub struct Field {
    /// Its name.
    pub name: Name,
    /// What it means: sentences in which names of settings stand in backquotes.
    pub doc: &'static str,
    /// What it is about.
    pub group: Group,
    /// The heading under which it is listed.
    pub heading: &'static str,
    /// What stands for its value in lists of settings; empty if its name does.
    pub placeholder: &'static str,
    /// How it is given.
    pub kind: Kind,
    /// Whether its value may begin with a minus sign.
    pub minus: Minus,
    /// The type of its value, as it is given by programs.
    pub shape: Shape,
    /// The words that can be chosen; none if there are others.
    pub choices: fn() -> Vec<Choice>,
    /// Whole numbers that are allowed.
    pub range: Option<RangeInclusive<u32>>,
    /// Settings that it cannot be given with.
    pub conflicts: &'static [Name],
    /// A setting that it cannot be given without.
    pub requires: Option<Name>,
    /// Whether the bytes of images depend on it. Others say by what and how fast they are made.
    pub decides_bytes: bool,
    pub(crate) set: fn(&mut Request, &Value) -> Result<(), String>,
    pub(crate) get: fn(&Request) -> Option<Value>,
}

/// The type of a value that a program gives, besides text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// True or false.
    Switch,
    /// A word or another text.
    Text,
    /// A whole number.
    Whole,
    /// A number, or one of these words.
    Number(&'static [&'static str]),
    /// A path.
    Path,
    /// So many whole numbers.
    Wholes(usize),
    /// One number, or three.
    Color,
    /// Texts.
    Texts,
}

/// The value of a setting, as programs and files give it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// On or off.
    Switch(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A text, as it is typed.
    Text(String),
    /// More than one.
    List(Vec<Value>),
}

impl Value {
    /// Its whole number, if it is one.
    pub(crate) fn whole(&self) -> Option<i64> {
        match self {
            Value::Whole(whole) => Some(*whole),
            Value::Text(text) => text.parse().ok(),
            _ => None,
        }
    }

    /// As it is typed, with the items of a list joined by `separator`.
    fn text(&self, separator: &str) -> String {
        match self {
            Value::Switch(true) => Switch::On.name().to_owned(),
            Value::Switch(false) => Switch::Off.name().to_owned(),
            Value::Whole(whole) => whole.to_string(),
            Value::Number(number) => number.to_string(),
            Value::Text(text) => text.clone(),
            Value::List(items) => items.iter().map(|item| item.text(",")).collect::<Vec<_>>().join(separator),
        }
    }
}

/// A type of values: read from text, and shown as it is read.
pub(crate) trait Item: Sized {
    const SHAPE: Shape = Shape::Text;
    const MINUS: Minus = Minus::Never;
    /// What separates numbers of a list when it is text.
    const SEPARATOR: &'static str = ",";

    fn read(text: &str) -> Result<Self, String>;
    fn show(&self) -> String;

    fn choices() -> Vec<Choice> {
        Vec::new()
    }
}

/// What a field holds: an item, perhaps one, some, or whether it is on.
pub(crate) trait Slot {
    const KIND: Kind = Kind::Value;
    const SHAPE: Shape;
    const MINUS: Minus = Minus::Never;

    fn set(&mut self, value: &Value) -> Result<(), String>;
    /// `None` if nothing is given.
    fn get(&self) -> Option<Value>;

    fn choices() -> Vec<Choice> {
        Vec::new()
    }
}

impl<T: Item> Slot for T {
    const SHAPE: Shape = T::SHAPE;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        *self = T::read(&value.text(T::SEPARATOR))?;
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        Some(Value::Text(self.show()))
    }

    fn choices() -> Vec<Choice> {
        T::choices()
    }
}

impl<T: Item> Slot for Option<T> {
    const SHAPE: Shape = T::SHAPE;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        *self = Some(T::read(&value.text(T::SEPARATOR))?);
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        self.as_ref().map(|item| Value::Text(item.show()))
    }

    fn choices() -> Vec<Choice> {
        T::choices()
    }
}

impl<T: Item> Slot for Vec<T> {
    const KIND: Kind = Kind::List;
    const SHAPE: Shape = Shape::Texts;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        let one = std::slice::from_ref(value);
        let items = if let Value::List(items) = value { items } else { one };
        *self = items.iter().map(|item| T::read(&item.text(T::SEPARATOR))).collect::<Result<_, _>>()?;
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        let items = || self.iter().map(|item| Value::Text(item.show())).collect();
        (!self.is_empty()).then(|| Value::List(items()))
    }
}

impl Slot for bool {
    const KIND: Kind = Kind::Switch;
    const SHAPE: Shape = Shape::Switch;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        match value {
            Value::Switch(is_on) => *self = *is_on,
            _ => return Err("it is a switch: give true or false".to_owned()),
        }
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        self.then_some(Value::Switch(true))
    }
}

/// Types that are read from text and shown as it.
macro_rules! items {
    ($($type:ty: $shape:expr, $minus:ident $(, $separator:literal)?;)*) => {
        $(impl Item for $type {
            const SHAPE: Shape = $shape;
            const MINUS: Minus = Minus::$minus;
            $(const SEPARATOR: &'static str = $separator;)?

            fn read(text: &str) -> Result<$type, String> {
                text.parse().map_err(|error| format!("{error}"))
            }

            fn show(&self) -> String {
                self.to_string()
            }
        })*
    };
}

/// Types that are a list of words.
macro_rules! words {
    ($($type:ty),* $(,)?) => {
        $(impl Item for $type {
            fn read(text: &str) -> Result<$type, String> {
                text.parse().map_err(|error| format!("{error}"))
            }

            fn show(&self) -> String {
                self.name().to_owned()
            }

            fn choices() -> Vec<Choice> {
                <$type>::ALL.iter().map(|choice| Choice { name: choice.name(), help: choice.help() }).collect()
            }
        })*
    };
}

items! {
    u32: Shape::Whole, Number;
    u64: Shape::Whole, Number;
    String: Shape::Text, Never;
    Step: Shape::Number(&["auto"]), Number;
    Positive: Shape::Number(&[]), Number;
    Exposure: Shape::Number(&["auto"]), Number;
    Smooth: Shape::Number(&["off"]), Number;
    FrameRate: Shape::Number(&[]), Never;
    Frames: Shape::Text, Never;
    Size: Shape::Wholes(2), Never, "x";
    Dims: Shape::Wholes(3), Never, "x";
    Crop: Shape::Wholes(4), Never;
    Background: Shape::Color, Text;
    Color: Shape::Color, Text;
    LightSpec: Shape::Text, Text;
    CameraView: Shape::Text, Text;
    SkySpec: Shape::Text, Text;
    SunSpec: Shape::Text, Text;
    EnvironmentSpec: Shape::Path, Never;
    ByteSize: Shape::Whole, Never;
    Device: Shape::Text, Never;
}

words! {
    Mode, Lookup, Quality, Filter, ShortTests, AmbientSource, Weight, Falloff, Instancing, SceneFormat, Acceleration, Transfer, View,
    ExrSamples, ExrCompression, ExrParts, Switch, UpChoice,
}

impl Item for std::path::PathBuf {
    const SHAPE: Shape = Shape::Path;

    fn read(text: &str) -> Result<Self, String> {
        Ok(text.into())
    }

    fn show(&self) -> String {
        self.to_string_lossy().into_owned()
    }
}

impl Item for Format {
    fn read(text: &str) -> Result<Format, String> {
        text.parse().map_err(|error| format!("{error}"))
    }

    fn show(&self) -> String {
        self.name().to_owned()
    }

    fn choices() -> Vec<Choice> {
        let built = Format::ALL.iter().filter(|format| format.is_built());
        built.map(|format| Choice { name: format.name(), help: format.help() }).collect()
    }
}

impl Item for BitDepth {
    const SHAPE: Shape = Shape::Whole;

    fn read(text: &str) -> Result<BitDepth, String> {
        match text {
            "8" => Ok(BitDepth::Eight),
            "16" => Ok(BitDepth::Sixteen),
            _ => Err("choose 8 or 16".to_owned()),
        }
    }

    fn show(&self) -> String {
        self.bits().to_string()
    }

    fn choices() -> Vec<Choice> {
        vec![
            Choice { name: "8", help: "256 codes, as screens show" },
            Choice { name: "16", help: "65536 codes, for further grading" },
        ]
    }
}

impl Field {
    /// The value that holds if none is given, as it is typed; `None` if that depends on the scene or on other settings.
    pub fn default(&self) -> Option<String> {
        match self.kind {
            Kind::Value => (self.get)(&Request::default()).map(|value| value.text(",")),
            Kind::Switch | Kind::List => None,
        }
    }

    /// Its value in a request, as it is typed, once for each time; none if it is not given.
    pub fn texts(&self, request: &Request) -> Vec<String> {
        match (self.get)(request) {
            None => Vec::new(),
            Some(Value::List(items)) => items.iter().map(|item| item.text(",")).collect(),
            Some(value) => vec![value.text(",")],
        }
    }

    /// Whether its value is not the one that holds if none is given.
    pub fn is_given(&self, request: &Request) -> bool {
        (self.get)(request) != (self.get)(&Request::default())
    }
}
