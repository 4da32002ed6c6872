//! `motion` of cameras, lights and objects: keys to tracks.
//!
//! Cameras and lights are read from their tables at any time as at rest, with the values of that time in place of those that have keys. So
//! they are checked by the same rules, at each key when the file is read. Between keys there may be a moment without a valid camera, when it
//! goes through its own target, say: there it stays as it is at rest.

use std::{ops::Range, path::Path, sync::Arc};

use glam::{DMat4, DVec3};

use super::{
    cameras,
    check::Source,
    lights,
    motion_schema::{CameraKey, InterpolationName, LightKey, ObjectMotionEntry},
    schema::{CameraEntry, LightEntry, LightKindName},
    spanned::Spanned,
    values::{Color, Number, Scale},
};
use crate::build::draft::Draft;
use crate::model::animation::rig::{Node, Place};
use crate::model::animation::track::{Interpolation, Kind, Track};
use crate::model::animation::views::{Keyed, Motion, numbered};
use crate::{Camera, Light, LoadError};

/// The latest time of a key, seconds: eleven days.
const LATEST: f64 = 1e6;

/// A value of a table that may have keys.
struct Property<Table, Key> {
    name: &'static str,
    /// Numbers of the value.
    width: usize,
    /// Whether a table has the value, or a default.
    is_there: fn(&Table) -> bool,
    /// The value at a key, if it has one.
    value: fn(&Key) -> Option<Vec<f64>>,
    /// Takes the value of a key, with its place in the text.
    copy: fn(&mut Table, &Key),
    /// Sets the value, found at a place in the text.
    set: fn(&mut Table, Range<usize>, &[f64]),
}

/// The property of an optional vector, or of a number, in a table and its keys.
macro_rules! property {
    ($name:ident, vector, $is_there:expr) => {
        property!($name, 3, $is_there, |value| value.to_vec(), |values| [values[0], values[1], values[2]])
    };
    ($name:ident, number, $is_there:expr) => {
        property!($name, 1, $is_there, |value| vec![*value], |values| values[0])
    };
    ($name:ident, $width:expr, $is_there:expr, |$value:ident| $numbers:expr, |$values:ident| $made:expr) => {
        Property {
            name: stringify!($name),
            width: $width,
            is_there: $is_there,
            value: |key| {
                key.$name.as_ref().map(|value| {
                    let $value = value.get_ref();
                    $numbers
                })
            },
            copy: |table, key| {
                if key.$name.is_some() {
                    table.$name = key.$name.clone();
                }
            },
            set: |table, span, $values| table.$name = Some(Spanned::new(span, $made)),
        }
    };
}

/// What a camera's keys may give.
const CAMERA: &[Property<CameraEntry, CameraKey>] = &[
    Property {
        name: "position",
        width: 3,
        is_there: |_| true,
        value: |key| key.position.as_ref().map(|value| value.get_ref().to_vec()),
        copy: |table, key| {
            if let Some(position) = &key.position {
                table.position = position.clone();
            }
        },
        set: |table, span, values| table.position = Spanned::new(span, [values[0], values[1], values[2]]),
    },
    property!(target, vector, |table| table.target.is_some()),
    property!(direction, vector, |table| table.direction.is_some()),
    property!(up, vector, |_| true),
    property!(vfov, number, |table| table.hfov.is_none() && table.height.is_none()),
    property!(hfov, number, |table| table.hfov.is_some()),
    property!(height, number, |table| table.height.is_some()),
    property!(shift, 2, |_| true, |value| value.to_vec(), |values| [values[0], values[1]]),
];

/// What a light's keys may give.
const LIGHT: &[Property<LightEntry, LightKey>] = &[
    property!(position, vector, |table| table.position.is_some()),
    property!(direction, vector, |table| table.direction.is_some()),
    property!(target, vector, |table| table.target.is_some()),
    property!(normal, vector, |table| table.normal.is_some()),
    property!(radius, number, |table| table.radius.is_some() || *table.kind.get_ref() == LightKindName::Spot),
    property!(angle, number, |_| true),
    property!(inner, number, |_| true),
    property!(outer, number, |_| true),
    property!(size, 2, |table| table.size.is_some(), |value| value.to_vec(), |values| [values[0], values[1]]),
    property!(
        intensity,
        3,
        |_| true,
        |value| match *value {
            Color::Grey(grey) => vec![grey; 3],
            Color::Rgb(rgb) => rgb.to_vec(),
        },
        |values| Color::Rgb([values[0], values[1], values[2]])
    ),
];

/// A table of a scene file that has keys.
trait Moving: Sized + Clone + 'static {
    /// What is made of it.
    type Made;
    type Key: 'static;

    const PROPERTIES: &'static [Property<Self, Self::Key>];

    fn read(source: &Source, table: &Spanned<Self>) -> Result<(Self::Made, DVec3), LoadError>;

    fn time(key: &Self::Key) -> &Number;
}

impl Moving for CameraEntry {
    type Made = Camera;
    type Key = CameraKey;

    const PROPERTIES: &'static [Property<CameraEntry, CameraKey>] = CAMERA;

    fn read(source: &Source, table: &Spanned<CameraEntry>) -> Result<(Camera, DVec3), LoadError> {
        cameras::read(source, table)
    }

    fn time(key: &CameraKey) -> &Number {
        &key.time
    }
}

impl Moving for LightEntry {
    type Made = Light;
    type Key = LightKey;

    const PROPERTIES: &'static [Property<LightEntry, LightKey>] = LIGHT;

    fn read(source: &Source, table: &Spanned<LightEntry>) -> Result<(Light, DVec3), LoadError> {
        lights::read(source, table)
    }

    fn time(key: &LightKey) -> &Number {
        &key.time
    }
}

/// The camera with its motion, if its table has one.
pub(super) fn camera(
    source: &Source,
    table: &Spanned<CameraEntry>,
    (camera, world): (Camera, DVec3),
    draft: &mut Draft,
) -> Result<(Camera, DVec3), LoadError> {
    let Some(motion) = &table.get_ref().motion else { return Ok((camera, world)) };
    let keyed = keyed(source, table, &motion.key, motion.interpolation, draft)?;
    let number = numbered(&mut draft.animation.cameras, Motion::Keys(keyed));
    Ok((Camera { motion: Some(number), ..camera }, world))
}

/// The light with its motion, if its table has one.
pub(super) fn light(
    source: &Source,
    table: &Spanned<LightEntry>,
    (light, world): (Light, DVec3),
    draft: &mut Draft,
) -> Result<(Light, DVec3), LoadError> {
    let Some(motion) = &table.get_ref().motion else { return Ok((light, world)) };
    let keyed = keyed(source, table, &motion.key, motion.interpolation, draft)?;
    let number = numbered(&mut draft.animation.lights, Motion::Keys(keyed));
    Ok((Light { motion: Some(number), ..light }, world))
}

/// A table with the tracks of its values.
#[derive(Debug)]
struct KeyedTable<T> {
    path: Box<Path>,
    text: Arc<str>,
    table: Spanned<T>,
    /// Each with the number of its property.
    tracks: Vec<(usize, Track)>,
}

impl<T: Moving> KeyedTable<T> {
    /// Sets a property to its value at `time`.
    fn set(&self, table: &mut T, number: usize, track: &Track, time: f64) {
        let mut values = vec![0.0; track.width()];
        track.sample(time, &mut values);
        (T::PROPERTIES[number].set)(table, self.table.span(), &values);
    }
}

impl<T> Keyed<T::Made> for KeyedTable<T>
where
    T: Moving + std::fmt::Debug + Send + Sync,
{
    fn at(&self, time: f64) -> Option<(T::Made, DVec3)> {
        let mut table = self.table.get_ref().clone();
        self.tracks.iter().for_each(|(number, track)| self.set(&mut table, *number, track, time));
        let source = Source { path: &self.path, text: &self.text };
        T::read(&source, &Spanned::new(self.table.span(), table)).ok()
    }
}

fn keyed<T>(
    source: &Source,
    table: &Spanned<T>,
    keys: &[Spanned<T::Key>],
    interpolation: Option<InterpolationName>,
    draft: &mut Draft,
) -> Result<Arc<dyn Keyed<T::Made>>, LoadError>
where
    T: Moving + std::fmt::Debug + Send + Sync + 'static,
{
    let times = times(source, keys, |key| T::time(key), draft)?;
    let mut tracks = Vec::new();
    for (number, property) in T::PROPERTIES.iter().enumerate() {
        let given = keys.iter().zip(&times);
        let given = given.filter_map(|(key, &time)| Some((key, time, (property.value)(key.get_ref())?)));
        let given: Vec<_> = given.collect();
        let Some((first, ..)) = given.first() else { continue };
        if !(property.is_there)(table.get_ref()) {
            let remedy = format!("the table itself must have `{}`, too", property.name);
            return Err(source.refuse("key", first, &format!("gives `{}`", property.name), &remedy));
        }
        let times = given.iter().map(|(_, time, _)| *time).collect();
        let values = given.iter().flat_map(|(.., values)| values).copied().collect();
        let track = Track::new(Kind::Numbers(property.width), times, values, Interpolation::from(interpolation));
        // The times are checked.
        tracks.extend(track.ok().map(|track| (number, track)));
    }
    let keyed = KeyedTable { path: source.path.into(), text: source.text.into(), table: table.clone(), tracks };
    check(source, &keyed, keys, &times)?;
    Ok(Arc::new(keyed))
}

/// Checks the table as it is at each key. The error names the place of a value that is wrong by itself, if there is one.
fn check<T: Moving>(
    source: &Source,
    keyed: &KeyedTable<T>,
    keys: &[Spanned<T::Key>],
    times: &[f64],
) -> Result<(), LoadError> {
    let at = |key: &Spanned<T::Key>, time: Option<f64>| {
        let mut table = keyed.table.get_ref().clone();
        for (number, track) in &keyed.tracks {
            if let Some(time) = time {
                keyed.set(&mut table, *number, track, time);
            }
            (T::PROPERTIES[*number].copy)(&mut table, key.get_ref());
        }
        T::read(source, &Spanned::new(keyed.table.span(), table)).err()
    };
    let wrong = keys.iter().zip(times).find_map(|(key, &time)| at(key, Some(time)));
    let Some(wrong) = wrong else { return Ok(()) };
    Err(keys.iter().find_map(|key| at(key, None)).unwrap_or(wrong))
}

/// The times of keys, ascending.
fn times<K>(
    source: &Source,
    keys: &[Spanned<K>],
    time: impl Fn(&K) -> &Number,
    draft: &mut Draft,
) -> Result<Vec<f64>, LoadError> {
    let mut times: Vec<f64> = Vec::with_capacity(keys.len());
    for key in keys {
        let number = time(key.get_ref());
        let seconds = source.between("time", number, 0.0, LATEST)?;
        if times.last().is_some_and(|&before| before >= seconds) {
            return Err(source.refuse("time", number, "is not after the key before", "put keys in the order of time"));
        }
        times.push(seconds);
    }
    let end = times.last().copied().unwrap_or(0.0);
    draft.animation.duration = draft.animation.duration.max(end);
    Ok(times)
}

impl From<Option<InterpolationName>> for Interpolation {
    fn from(name: Option<InterpolationName>) -> Interpolation {
        match name {
            None | Some(InterpolationName::Smooth) => Interpolation::Smooth,
            Some(InterpolationName::Linear) => Interpolation::Linear,
            Some(InterpolationName::Step) => Interpolation::Step,
        }
    }
}

/// Adds nodes to the rig for the motion of an object whose pivot is at `middle` by default, and returns the one that moves it.
pub(super) fn object(
    source: &Source,
    motion: &ObjectMotionEntry,
    middle: DVec3,
    draft: &mut Draft,
) -> Result<u32, LoadError> {
    let pivot = motion.pivot.as_ref().map_or(Ok(middle), |pivot| source.vector("pivot", pivot))?;
    let times = times(source, &motion.key, |key| &key.time, draft)?;
    let mut lists: [(Vec<f64>, Vec<f64>); 3] = Default::default();
    for (key, &time) in motion.key.iter().map(Spanned::get_ref).zip(&times) {
        let translate = key.translate.as_ref().map(|value| source.vector("translate", value)).transpose()?;
        let rotate = key.rotate.as_ref().map(|value| source.vector("rotate", value)).transpose()?;
        let scale = key.scale.as_ref().map(|value| scale(source, value)).transpose()?;
        let values = [translate.map(|translate| pivot + translate), rotate, scale];
        for ((times, list), value) in lists.iter_mut().zip(values) {
            times.extend(value.map(|_| time));
            list.extend(value.iter().flat_map(|value| value.to_array()));
        }
    }
    let interpolation = Interpolation::from(motion.interpolation);
    let [translation, rotation, scale] = lists.map(|(times, values)| {
        // None without keys; their times are checked.
        Track::new(Kind::Numbers(3), times, values, interpolation).ok().map(Arc::new)
    });
    let rig = &mut draft.animation.rig;
    let turned = rig.add(Node { parent: None, rest: Place::at(pivot), translation, rotation, scale });
    Ok(rig.add(Node::fixed(Some(turned), Place::Matrix(DMat4::from_translation(-pivot)))))
}

/// Factors of a key: 0 hides the object.
fn scale(source: &Source, value: &Spanned<Scale>) -> Result<DVec3, LoadError> {
    let factors = value.get_ref().factors();
    source.all_finite("scale", value, &factors.to_array())?;
    Ok(factors)
}
