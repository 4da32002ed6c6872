//! `[sky]` and `[environment]` to what surrounds the scene.

use super::check::{Source, required};
use super::schema::{EnvironmentEntry, SkyEntry, SkyName, UpName};
use super::spanned::Spanned;
use super::values::Text;
use crate::build::draft::Draft;
use crate::{Environment, EnvironmentError, LoadError, Moment, Sky, SkyKind, SunPosition, Surroundings, Up};

use glam::Vec3;

/// The sky that a table describes.
pub(super) fn read(source: &Source, table: &Spanned<SkyEntry>) -> Result<Surroundings, LoadError> {
    let entry = table.get_ref();
    refuse_foreign_keys(source, table)?;
    let color = |key, value: &Option<Spanned<super::values::Color>>, default: Vec3| {
        value.as_ref().map_or(Ok(default), |color| source.color(key, color))
    };
    let kind = match entry.kind.get_ref() {
        SkyName::Clear => SkyKind::Clear {
            sun: sun(source, table)?,
            turbidity: match &entry.turbidity {
                Some(turbidity) => source.between("turbidity", turbidity, 1.0, 10.0)? as f32,
                None => Sky::TURBIDITY,
            },
            ground: color("ground", &entry.ground, Sky::GROUND)?,
        },
        SkyName::Uniform => SkyKind::Uniform { color: color("color", &entry.color, Vec3::ONE)? },
        SkyName::Gradient => SkyKind::Gradient {
            zenith: color("zenith", &entry.zenith, Sky::ZENITH)?,
            horizon: color("horizon", &entry.horizon, Sky::HORIZON)?,
            ground: color("ground", &entry.ground, Sky::GROUND)?,
        },
    };
    let strength = entry.strength.as_ref().map_or(Ok(1.0), |value| source.between("strength", value, 0.0, 1e9))?;
    let north = entry.north.as_ref().map_or(Ok(0.0), |value| source.between("north", value, -360.0, 360.0))?;
    let sky = Sky { kind, strength: strength as f32, north: north as f32 };
    sky.surroundings(up(entry.up)).map_err(|error| source.refuse("sky", table, "cannot be", &error.to_string()))
}

/// The keys that other kinds of skies have.
fn refuse_foreign_keys(source: &Source, table: &Spanned<SkyEntry>) -> Result<(), LoadError> {
    let entry = table.get_ref();
    let (clear, uniform, gradient) = (SkyName::Clear, SkyName::Uniform, SkyName::Gradient);
    let keys: [(&str, bool, &[SkyName]); 8] = [
        ("sun", entry.sun.is_some(), &[clear]),
        ("place", entry.place.is_some(), &[clear]),
        ("time", entry.time.is_some(), &[clear]),
        ("turbidity", entry.turbidity.is_some(), &[clear]),
        ("ground", entry.ground.is_some(), &[clear, gradient]),
        ("color", entry.color.is_some(), &[uniform]),
        ("zenith", entry.zenith.is_some(), &[gradient]),
        ("horizon", entry.horizon.is_some(), &[gradient]),
    ];
    let kind = *entry.kind.get_ref();
    match keys.iter().find(|(_, is_there, kinds)| *is_there && !kinds.contains(&kind)) {
        Some((key, ..)) => {
            let problem = format!("has no `{key}`");
            Err(source.refuse("kind", &entry.kind, &problem, &format!("remove `{key}`, or choose another kind of sky")))
        }
        None => Ok(()),
    }
}

/// Where the sun stands.
fn sun(source: &Source, table: &Spanned<SkyEntry>) -> Result<SunPosition, LoadError> {
    let entry = table.get_ref();
    let (place, time) = match (&entry.sun, &entry.place, &entry.time) {
        (Some(sun), None, None) => {
            let [elevation, azimuth] = *sun.get_ref();
            source.all_finite("sun", sun, sun.get_ref())?;
            if !(0.0..=90.0).contains(&elevation) || !(-360.0..=360.0).contains(&azimuth) {
                return Err(source.refuse(
                    "sun",
                    sun,
                    "is below the horizon or no direction",
                    "give [elevation, azimuth], from 0 to 90 and from -360 to 360 degrees",
                ));
            }
            return Ok(SunPosition { elevation, azimuth });
        }
        (None, None, None) => return Ok(Sky::SUN),
        (Some(sun), ..) => {
            return Err(source.refuse("sun", sun, "is given twice", "remove `sun`, or `place` and `time`"));
        }
        (None, place, time) => (
            required(source, table, "place", place, "add `place = [latitude, longitude]`, in degrees")?,
            required(source, table, "time", time, "add `time`, such as `time = \"2026-06-21T15:00+02:00\"`")?,
        ),
    };
    let moment: Moment = time
        .get_ref()
        .parse()
        .map_err(|error: crate::SunError| source.refuse("time", time, "is no date with a time", &error.to_string()))?;
    let [latitude, longitude] = *place.get_ref();
    let position = SunPosition::of(latitude, longitude, &moment)
        .map_err(|error| source.refuse("place", place, "has no sun", &error.to_string()))?;
    if position.elevation < 0.0 {
        let problem = format!("is at night: the sun is {:.1} degrees below the horizon", -position.elevation);
        return Err(source.refuse("time", time, &problem, "choose a time of day"));
    }
    Ok(position)
}

/// The panorama that a table names.
pub(super) fn panorama(
    source: &Source,
    table: &Spanned<EnvironmentEntry>,
    draft: &mut Draft,
) -> Result<Surroundings, LoadError> {
    let entry = table.get_ref();
    let file: &Text = &entry.file;
    draft.refer(source.path, file.get_ref());
    let (path, bytes) =
        draft.read_nearby(source.path, file.get_ref()).map_err(|error| error.named_by(source.place(file.span())))?;
    let decoded = Environment::decode(&path, &bytes, up(entry.up), draft.access.budget);
    let environment = decoded.map_err(|error| match error {
        EnvironmentError::Memory { path, what, short } => LoadError::Memory { path, what, short },
        error => source.refuse("file", file, "cannot be used", &error.to_string()),
    })?;
    let rotation = entry.rotation.as_ref().map_or(Ok(0.0), |value| source.between("rotation", value, -360.0, 360.0))?;
    let strength = entry.strength.as_ref().map_or(Ok(1.0), |value| source.between("strength", value, 0.0, 1e9))?;
    Ok(environment.turned(rotation as f32).scaled(strength as f32).into())
}

fn up(name: Option<UpName>) -> Up {
    match name {
        None | Some(UpName::Y) => Up::Y,
        Some(UpName::Z) => Up::Z,
    }
}
