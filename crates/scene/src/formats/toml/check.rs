//! Checks of a scene file's values: finite, in range, known. Every error names file, line, key and remedy.

use std::{collections::HashMap, fmt::Debug, ops::Range, path::Path};

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::spanned::Spanned;
use super::values::{Color, Number, Text, Vector};
use crate::LoadError;
use crate::build::error::Place;
use crate::build::quote::{abridged, quote};
use crate::model::camera::LARGEST_SHIFT;
use crate::model::transforms::{LARGEST_COORDINATE, unit};

/// Larger numbers are treated as typing errors: their squares must fit into `f32`.
const LARGEST: f64 = LARGEST_COORDINATE;

/// The file being read: converts positions in the text into lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) text: &'a str,
}

impl Source<'_> {
    /// The line of a position in the text.
    pub(super) fn place(&self, span: Range<usize>) -> Box<Place> {
        Box::new(Place::byte(self.path, self.text, span.start))
    }

    /// The error for an invalid value: "key = value `problem`; `remedy`".
    pub(super) fn refuse<T>(&self, key: &str, value: &Spanned<T>, problem: &str, remedy: &str) -> LoadError {
        LoadError::Value {
            place: self.place(value.span()),
            key: key.to_owned(),
            value: self.text.get(value.span()).unwrap_or_default().trim().replace('\n', " "),
            problem: problem.to_owned(),
            remedy: remedy.to_owned(),
        }
    }

    /// The error for a table without a required key.
    pub(super) fn missing<T>(&self, table: &Spanned<T>, key: &str, remedy: &str) -> LoadError {
        LoadError::MissingKey { place: self.place(table.span()), key: key.to_owned(), remedy: remedy.to_owned() }
    }

    pub(super) fn all_finite<T>(&self, key: &str, value: &Spanned<T>, numbers: &[f64]) -> Result<(), LoadError> {
        match numbers.iter().find(|number| !number.is_finite() || number.abs() > LARGEST) {
            Some(number) if number.is_finite() => {
                Err(self.refuse(key, value, "is too large", &format!("stay below {LARGEST:e}")))
            }
            Some(_) => Err(self.refuse(key, value, "is not finite", "give an ordinary number")),
            None => Ok(()),
        }
    }

    /// A finite number.
    pub(super) fn number(&self, key: &str, value: &Number) -> Result<f64, LoadError> {
        self.all_finite(key, value, &[*value.get_ref()])?;
        Ok(*value.get_ref())
    }

    /// A number above 0.
    pub(super) fn positive(&self, key: &str, value: &Number) -> Result<f64, LoadError> {
        let number = self.number(key, value)?;
        // Compared in the precision in which it will be stored: 1e-60 is 0 there.
        if number as f32 > 0.0 {
            Ok(number)
        } else {
            Err(self.refuse(key, value, "is not positive", &format!("give a {key} above 0")))
        }
    }

    /// A number from `low` to `high`.
    pub(super) fn between(&self, key: &str, value: &Number, low: f64, high: f64) -> Result<f64, LoadError> {
        let number = self.number(key, value)?;
        if (low..=high).contains(&number) {
            Ok(number)
        } else {
            let problem = format!("is not between {low} and {high}");
            Err(self.refuse(key, value, &problem, &format!("give a number from {low} to {high}")))
        }
    }

    /// A full field of view: above 0 and below 180 degrees.
    pub(super) fn view_angle(&self, key: &str, value: &Number) -> Result<f32, LoadError> {
        let degrees = self.positive(key, value)? as f32;
        if degrees < 180.0 {
            Ok(degrees)
        } else {
            Err(self.refuse(key, value, "is not under 180 degrees", "give the angle in degrees, such as 50"))
        }
    }

    /// A number of segments.
    pub(super) fn segments(&self, value: &Option<Spanned<i64>>) -> Result<u32, LoadError> {
        const RANGE: std::ops::RangeInclusive<i64> = 3..=2048;
        match value {
            None => Ok(crate::build::shapes::DEFAULT_SEGMENTS),
            Some(value) if RANGE.contains(value.get_ref()) => Ok(*value.get_ref() as u32),
            Some(value) => {
                let remedy = format!("give a whole number from {} to {}", RANGE.start(), RANGE.end());
                Err(self.refuse("segments", value, "cannot be used", &remedy))
            }
        }
    }

    /// A finite point or vector.
    pub(super) fn vector(&self, key: &str, value: &Vector) -> Result<DVec3, LoadError> {
        self.all_finite(key, value, value.get_ref())?;
        Ok(DVec3::from(*value.get_ref()))
    }

    /// A direction, normalised; one that has unit length to `f32` precision is kept digit for digit.
    pub(super) fn direction(&self, key: &str, value: &Vector) -> Result<DVec3, LoadError> {
        unit(self.vector(key, value)?)
            .ok_or_else(|| self.refuse(key, value, "has no direction", "give a vector that is not zero"))
    }

    /// Three numbers above 0.
    pub(super) fn lengths<const N: usize>(&self, key: &str, value: &Spanned<[f64; N]>) -> Result<[f64; N], LoadError> {
        self.all_finite(key, value, value.get_ref())?;
        if value.get_ref().iter().all(|&length| length as f32 > 0.0) {
            Ok(*value.get_ref())
        } else {
            Err(self.refuse(key, value, "has a component that is not positive", "give lengths above 0"))
        }
    }

    /// A shift of an image.
    pub(super) fn shift(&self, key: &str, value: &Spanned<[f64; 2]>) -> Result<Vec2, LoadError> {
        let shift = DVec2::from(*value.get_ref()).as_vec2();
        self.all_finite(key, value, value.get_ref())?;
        if shift.abs().max_element() <= LARGEST_SHIFT {
            return Ok(shift);
        }
        let problem = format!("is more than {LARGEST_SHIFT} heights of the image");
        Err(self.refuse(key, value, &problem, "give numbers such as 0.5"))
    }

    /// A colour or intensity: finite, no channel below 0.
    pub(super) fn color(&self, key: &str, value: &Spanned<Color>) -> Result<Vec3, LoadError> {
        let rgb = match *value.get_ref() {
            Color::Grey(grey) => [grey; 3],
            Color::Rgb(rgb) => rgb,
        };
        self.all_finite(key, value, &rgb)?;
        if rgb.iter().any(|&channel| channel < 0.0) {
            return Err(self.refuse(key, value, "is below 0", "give 0 or more"));
        }
        Ok(DVec3::from(rgb).as_vec3())
    }

    /// The index of a name among the known ones.
    pub(super) fn index_of(
        &self,
        kind: &'static str,
        name: &Text,
        known: &HashMap<String, u32>,
    ) -> Result<u32, LoadError> {
        known.get(name.get_ref()).copied().ok_or_else(|| {
            let mut names: Vec<&String> = known.keys().collect();
            names.sort_unstable_by_key(|&name| known[name]);
            LoadError::UnknownName {
                place: self.place(name.span()),
                kind,
                name: name.get_ref().clone(),
                known: names.into_iter().cloned().collect(),
            }
        })
    }
}

/// An error of toml and serde in our words.
pub(super) fn syntax_error(source: &Source, error: &toml::de::Error) -> LoadError {
    let place = source.place(error.span().unwrap_or(0..0));
    let message = error.message().lines().collect::<Vec<_>>().join(" ");
    let mut names = message.split('`').skip(1).step_by(2).map(str::to_owned);
    if message.starts_with("unknown field") {
        let key = names.next().unwrap_or_default();
        return LoadError::UnknownKey { place, key, known: names.collect() };
    }
    if message.starts_with("missing field") {
        let key = names.next().unwrap_or_default();
        let remedy = format!("add `{key} = …` to this table");
        return LoadError::MissingKey { place, key, remedy };
    }
    let remedy = match key_at(source, error.span()) {
        Some(key) => format!("use a value that is valid for `{}`", quote(key)),
        None => "correct the TOML syntax (see https://toml.io)".to_owned(),
    };
    LoadError::Syntax { place, problem: abridged(&message), remedy }
}

/// The key with the invalid value; `None` if not even the syntax is valid.
fn key_at<'a>(source: &Source<'a>, span: Option<Range<usize>>) -> Option<&'a str> {
    let before = source.text.get(..span?.start)?;
    let line = before.rsplit('\n').next()?;
    let (key, _) = line.split_once('=')?;
    Some(key.trim())
}

/// For messages: the keys in a list that are present.
pub(super) fn present<'a>(keys: &[(&'a str, bool)]) -> Vec<&'a str> {
    keys.iter().filter(|(_, there)| *there).map(|(key, _)| *key).collect()
}

/// A key that is required for some kinds of a table only.
pub(super) fn required<'a, T, E: Debug>(
    source: &Source,
    table: &Spanned<E>,
    key: &str,
    value: &'a Option<T>,
    remedy: &str,
) -> Result<&'a T, LoadError> {
    value.as_ref().ok_or_else(|| source.missing(table, key, remedy))
}
