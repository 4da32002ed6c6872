//! Requests by the names of their fields: setting one, checking all, reading and writing them.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser::SerializeMap};

use crate::error::RequestError;
use crate::request::{FIELDS, Field, Request};
use crate::settings::without_light_points;
use crate::table::{Group, Kind, Value};
use crate::words::Name;

/// Names at least this much alike are suggested for each other.
const ALIKE: f64 = 0.75;

/// The setting of this name.
pub fn field(name: &str) -> Option<&'static Field> {
    FIELDS.iter().find(|field| field.name == name)
}

impl Request {
    /// Sets what `name` names.
    ///
    /// # Errors
    /// [`RequestError::Unknown`] with a similar name if there is none like it, [`RequestError::Value`] if the value cannot be used.
    pub fn set(&mut self, name: &str, value: impl Into<Value>) -> Result<(), RequestError> {
        self.set_in(name, value, |_| true)
    }

    /// The same for settings of some groups only; there are no others.
    ///
    /// # Errors
    /// As [`Request::set`].
    pub fn set_in(
        &mut self,
        name: &str,
        value: impl Into<Value>,
        has: impl Fn(Group) -> bool,
    ) -> Result<(), RequestError> {
        let known = || FIELDS.iter().filter(|field| has(field.group));
        let Some(field) = known().find(|field| field.name == name) else {
            let similar = nearest(name, known().map(|field| field.name));
            return Err(RequestError::Unknown { name: name.to_owned(), similar });
        };
        let value = value.into();
        let problem = match field.apply(self, &value) {
            Ok(()) => return Ok(()),
            Err(problem) => advice(field, problem),
        };
        Err(RequestError::Value { setting: field.name, value, problem })
    }

    /// The settings that are given of the frames of a film.
    pub(crate) fn of_frames(&self) -> impl Iterator<Item = Name> {
        FIELDS.iter().filter(|field| field.group == Group::Frames && field.is_given(self)).map(|field| field.name)
    }

    /// The setting that says what becomes of frames that exist, if one is given.
    pub(crate) fn of_existing_frames(&self) -> Option<Name> {
        self.of_frames().find(|name| ["resume", "skip_existing", "overwrite"].contains(name))
    }

    /// Checks that settings can be given together.
    ///
    /// # Errors
    /// [`RequestError::Conflict`], [`RequestError::Requires`] or [`RequestError::NoLightPoints`].
    pub fn check(&self) -> Result<(), RequestError> {
        let given: Vec<&Field> = FIELDS.iter().filter(|field| field.is_given(self)).collect();
        let is_given = |name: &str| given.iter().any(|field| field.name == name);
        for field in &given {
            if let Some(second) = field.conflicts.iter().find(|name| is_given(name)) {
                return Err(RequestError::Conflict { first: field.name, second });
            }
            if let Some(needed) = field.requires.filter(|name| !is_given(name)) {
                return Err(RequestError::Requires { setting: field.name, needed });
            }
            if let Some(chosen) = without_light_points(self).filter(|_| field.is_of_light_points) {
                return Err(RequestError::NoLightPoints { setting: field.name, chosen });
            }
        }
        Ok(())
    }
}

/// Only what differs from the default, by name.
impl Serialize for Request {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for field in FIELDS.iter().filter(|field| field.is_given(self)) {
            map.serialize_entry(field.name, &(field.get)(self))?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Request {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Request, D::Error> {
        let mut request = Request::default();
        for (name, value) in BTreeMap::<String, Value>::deserialize(deserializer)? {
            request.set(&name, value).map_err(de::Error::custom)?;
        }
        request.check().map_err(de::Error::custom)?;
        Ok(request)
    }
}

/// What is wrong with a value, or the words that can be chosen.
fn advice(field: &Field, problem: String) -> String {
    let choices = if field.kind == Kind::Value { (field.choices)() } else { Vec::new() };
    let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("choose {} or {last}", others.join(", ")),
        _ => problem,
    }
}

/// A name like this one, if there is one.
pub fn nearest(name: &str, names: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    let likeness = |other: &str| strsim::jaro(name, other);
    let nearest = names.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(nearest) > ALIKE).then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::Size;

    fn read(json: &str) -> Result<Request, String> {
        serde_json::from_str(json).map_err(|error| error.to_string())
    }

    #[test]
    fn a_request_is_read_as_it_is_written() {
        let mut request = Request::default();
        assert_eq!(serde_json::to_string(&request).unwrap(), "{}");
        let values: [(&str, Value); 9] = [
            ("size", vec![Value::Whole(64), Value::Whole(48)].into()),
            ("quality", "draft".into()),
            ("light", vec!["1,2,3", "4,5,6;0.5;1"].into()),
            ("sky", "clear;sun=30,200;alone".into()),
            ("exposure", Value::Number(-1.5)),
            ("smooth", "off".into()),
            ("bit_depth", Value::Whole(16)),
            ("dither", true.into()),
            ("partial", true.into()),
        ];
        for (name, value) in values {
            request.set(name, value).unwrap();
        }
        assert_eq!(request.size, Size([64, 48]));
        assert_eq!(request.light.len(), 2);
        assert_eq!(read(&serde_json::to_string(&request).unwrap()), Ok(request));
    }

    #[test]
    fn every_default_is_a_value_of_its_own_setting() {
        for field in FIELDS {
            if let Some(default) = field.default() {
                let mut request = Request::default();
                request.set(field.name, default.as_str()).unwrap();
                assert_eq!(request, Request::default(), "{}: {default}", field.name);
            }
        }
    }

    #[test]
    fn what_cannot_be_set_says_why() {
        let message = |json: &str| read(json).unwrap_err();
        assert_eq!(message(r#"{"qualty": "draft"}"#), "there is no setting qualty; did you mean quality?");
        assert!(message(r#"{"quality": "fast"}"#).starts_with("quality cannot be `fast`: choose draft, good or final"));
        assert!(message(r#"{"size": [64]}"#).contains("WIDTHxHEIGHT"));
        assert_eq!(message(r#"{"aa": 0}"#), "aa cannot be 0: 0 is not in 1..=65536");
        assert_eq!(message(r#"{"ground": 1}"#), "ground cannot be 1: it is a switch: give true or false");
        assert_eq!(
            message(r#"{"studio": true, "sky": "clear"}"#),
            "studio and sky cannot be given together; leave out one of them"
        );
        assert_eq!(
            message(r#"{"step": 0.5, "lookup": "lists"}"#),
            "step is of light points, which lookup=lists does not have; leave it out, or choose lookup=half-ball"
        );
        assert_eq!(
            message(r#"{"falloff": "inverse-square"}"#),
            "falloff needs light; give it, too, or leave falloff out"
        );
    }

    #[test]
    fn names_in_the_table_are_names_of_settings() {
        for Field { name, conflicts, requires, .. } in FIELDS {
            for other in conflicts.iter().chain(requires) {
                assert!(field(other).is_some(), "{name}: {other}");
            }
        }
    }
}
