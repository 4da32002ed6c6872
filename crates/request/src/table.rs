//! The table of all settings: what each is called, what it means, and how it is read and shown. Faces are made from it.
//!
//! The macro beside it declares the type `Request` and, for each of its fields, a row of this table. So a new setting is one entry there, and
//! then it is a flag with its help, a keyword argument with its annotation, a key of serialised requests, and a line of a film's manifest.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::value::Switch;
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

impl Group {
    /// Of reading a scene.
    pub const OPEN: &[Group] = &[Group::Reading, Group::Form, Group::Memory];
    /// Of an image of a scene that is in memory.
    pub const IMAGE: &[Group] = &[Group::Exposure, Group::Image, Group::Layers, Group::Memory];
    /// Of a film or a sun study of a file.
    pub const FILM: &[Group] = &[
        Group::Motion,
        Group::Frames,
        Group::Exposure,
        Group::Image,
        Group::Layers,
        Group::Storage,
        Group::Reading,
        Group::Form,
        Group::Memory,
    ];
    /// Of an image file.
    pub const SAVE: &[Group] = &[Group::Storage, Group::Exposure];
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

/// A setting: a field of a type of requests.
#[derive(Debug)]
pub struct FieldOf<R> {
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
    /// Whether it means something only where shadows come from light points.
    pub is_of_light_points: bool,
    /// Whether the bytes of images depend on it. Others say by what and how fast they are made.
    pub decides_bytes: bool,
    pub(crate) set: fn(&mut R, &Value) -> Result<(), String>,
    pub(crate) get: fn(&R) -> Option<Value>,
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
    pub(crate) fn text(&self, separator: &str) -> String {
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

impl<R: Default> FieldOf<R> {
    /// The value that holds if none is given, as it is typed; `None` if that depends on the scene or on other settings.
    pub fn default(&self) -> Option<String> {
        match self.kind {
            Kind::Value => (self.get)(&R::default()).map(|value| value.text(",")),
            Kind::Switch | Kind::List => None,
        }
    }

    /// Its value in a request, as it is typed, once for each time; none if it is not given.
    pub fn texts(&self, request: &R) -> Vec<String> {
        match (self.get)(request) {
            None => Vec::new(),
            Some(Value::List(items)) => items.iter().map(|item| item.text(",")).collect(),
            Some(value) => vec![value.text(",")],
        }
    }

    /// Whether its value is not the one that holds if none is given.
    pub fn is_given(&self, request: &R) -> bool {
        (self.get)(request) != (self.get)(&R::default())
    }

    /// Sets it in a request.
    pub(crate) fn apply(&self, request: &mut R, value: &Value) -> Result<(), String> {
        let whole = value.whole();
        if let (Some(range), Some(whole)) = (&self.range, whole) {
            let (first, last) = (i64::from(*range.start()), i64::from(*range.end()));
            if !(first..=last).contains(&whole) {
                return Err(format!("{whole} is not in {first}..={last}"));
            }
        }
        (self.set)(request, value)
    }

    /// Checks a value that is typed.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn check(&self, text: &str) -> Result<(), String> {
        self.apply(&mut R::default(), &Value::Text(text.to_owned()))
    }
}

impl From<bool> for Value {
    fn from(is_on: bool) -> Value {
        Value::Switch(is_on)
    }
}

impl From<i64> for Value {
    fn from(whole: i64) -> Value {
        Value::Whole(whole)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Value {
        Value::Number(number)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Value {
        Value::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Value {
        Value::Text(text)
    }
}

impl<T: Into<Value>> From<Vec<T>> for Value {
    fn from(items: Vec<T>) -> Value {
        Value::List(items.into_iter().map(Into::into).collect())
    }
}
