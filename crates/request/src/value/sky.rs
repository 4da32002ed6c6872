//! A sky and a panorama as "KIND;OPTIONS" and "FILE;OPTIONS".

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use glam::Vec3;
use lightmesh_scene::{Moment, Sky, SkyKind, SunPosition};

use super::ValueError;
use super::light::Color;
use super::number::{not_negative, number};

/// A sky as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkySpec {
    /// The sky.
    pub sky: Sky,
    /// Whether it replaces all lights of the scene, not only its suns.
    pub alone: bool,
}

/// A panorama as typed.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentSpec {
    /// The file.
    pub file: PathBuf,
    /// Degrees clockwise.
    pub rotation: f32,
    /// What its radiance is multiplied by.
    pub strength: f32,
    /// See [`SkySpec::alone`].
    pub alone: bool,
}

const SKY: ValueError = ValueError::Form {
    form: "clear, uniform or gradient, and options of that sky after semicolons (--help lists them)",
    example: "\"clear;sun=35,200;turbidity=4\"",
};
const ENVIRONMENT: ValueError = ValueError::Form {
    form: "an .hdr or .exr file, and then any of these after semicolons: rotation=DEGREES, strength=S, alone",
    example: "\"street.hdr;rotation=90\"",
};

impl SkySpec {
    /// A clear one with the usual options.
    pub fn clear() -> SkySpec {
        SkySpec { sky: Sky::clear(Sky::SUN), alone: false }
    }
}

impl fmt::Display for SkySpec {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Sky { kind, strength, north } = self.sky;
        match kind {
            SkyKind::Clear { sun: SunPosition { elevation, azimuth }, turbidity, ground } => {
                write!(f, "clear;sun={elevation},{azimuth};turbidity={turbidity};ground={}", Color(ground))
            }
            SkyKind::Uniform { color } => write!(f, "uniform;color={}", Color(color)),
            SkyKind::Gradient { zenith, horizon, ground } => {
                write!(f, "gradient;zenith={};horizon={};ground={}", Color(zenith), Color(horizon), Color(ground))
            }
        }?;
        let alone = if self.alone { ";alone" } else { "" };
        write!(f, ";north={north};strength={strength}{alone}")
    }
}

impl fmt::Display for EnvironmentSpec {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let EnvironmentSpec { file, rotation, strength, alone } = self;
        let alone = if *alone { ";alone" } else { "" };
        write!(f, "{};rotation={rotation};strength={strength}{alone}", file.display())
    }
}

impl FromStr for SkySpec {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<SkySpec, ValueError> {
        let mut parts = text.split(';').map(str::trim);
        let kind = parts.next().unwrap_or_default();
        let parts: Vec<(&str, Option<&str>)> = parts.map(key_and_value).collect();
        let known: &[&str] = match kind {
            "clear" => &["sun", "place", "time", "turbidity", "ground"],
            "uniform" => &["color"],
            "gradient" => &["zenith", "horizon", "ground"],
            _ => return Err(SKY),
        };
        check(&parts, known, &["north", "strength", "alone"], SKY)?;
        let get = |key| value_of(&parts, key);
        let color = |key, default: Vec3| match get(key) {
            Some(text) => text.parse().map(|Color(color)| color),
            None => Ok(default),
        };
        let kind = match kind {
            "clear" => SkyKind::Clear {
                sun: sun(get("sun"), get("place"), get("time"))?,
                turbidity: get("turbidity").map_or(Ok(f64::from(Sky::TURBIDITY)), number)? as f32,
                ground: color("ground", Sky::GROUND)?,
            },
            "uniform" => SkyKind::Uniform { color: color("color", Vec3::ONE)? },
            _ => SkyKind::Gradient {
                zenith: color("zenith", Sky::ZENITH)?,
                horizon: color("horizon", Sky::HORIZON)?,
                ground: color("ground", Sky::GROUND)?,
            },
        };
        let strength = get("strength").map_or(Ok(1.0), |text| not_negative("the strength", text))? as f32;
        let north = get("north").map_or(Ok(0.0), number)? as f32;
        Ok(SkySpec { sky: Sky { kind, strength, north }, alone: has(&parts, "alone") })
    }
}

impl FromStr for EnvironmentSpec {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<EnvironmentSpec, ValueError> {
        let mut parts = text.split(';');
        let file = parts.next().unwrap_or_default();
        if file.is_empty() {
            return Err(ENVIRONMENT);
        }
        let parts: Vec<(&str, Option<&str>)> = parts.map(|part| key_and_value(part.trim())).collect();
        check(&parts, &["rotation", "strength"], &["alone"], ENVIRONMENT)?;
        Ok(EnvironmentSpec {
            file: file.into(),
            rotation: value_of(&parts, "rotation").map_or(Ok(0.0), number)? as f32,
            strength: value_of(&parts, "strength").map_or(Ok(1.0), |text| not_negative("the strength", text))? as f32,
            alone: has(&parts, "alone"),
        })
    }
}

fn key_and_value(part: &str) -> (&str, Option<&str>) {
    part.split_once('=').map_or((part, None), |(key, value)| (key.trim(), Some(value.trim())))
}

/// Fails with `form` unless every key is known and stands there once, with a value exactly if it has one.
fn check(parts: &[(&str, Option<&str>)], own: &[&str], all: &[&str], form: ValueError) -> Result<(), ValueError> {
    let fits = |&(key, value): &(&str, Option<&str>)| {
        (own.contains(&key) || all.contains(&key)) && value.is_some() == (key != "alone")
    };
    let once = |index: usize| parts[..index].iter().all(|(key, _)| *key != parts[index].0);
    if parts.iter().all(fits) && (0..parts.len()).all(once) { Ok(()) } else { Err(form) }
}

fn value_of<'a>(parts: &[(&str, Option<&'a str>)], key: &str) -> Option<&'a str> {
    parts.iter().find(|(name, _)| *name == key).and_then(|(_, value)| *value)
}

fn has(parts: &[(&str, Option<&str>)], key: &str) -> bool {
    parts.iter().any(|(name, _)| *name == key)
}

/// Where the sun stands: as typed, or at a place and a time.
fn sun(position: Option<&str>, place: Option<&str>, time: Option<&str>) -> Result<SunPosition, ValueError> {
    let wrong = |problem: lightmesh_scene::SunError| ValueError::Sun { problem };
    match (position, place, time) {
        (None, None, None) => Ok(Sky::SUN),
        (Some(position), None, None) => {
            let [elevation, azimuth] = pair(position)?;
            Ok(SunPosition { elevation, azimuth })
        }
        (None, Some(place), Some(time)) => {
            let [latitude, longitude] = pair(place)?;
            let moment: Moment = time.parse().map_err(wrong)?;
            SunPosition::of(latitude, longitude, &moment).map_err(wrong)
        }
        _ => Err(SKY),
    }
}

fn pair(text: &str) -> Result<[f64; 2], ValueError> {
    let (first, second) = text.split_once(',').ok_or(SKY)?;
    Ok([number(first)?, number(second)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sky_has_defaults_for_everything() {
        let sky = |text: &str| text.parse::<SkySpec>().unwrap();
        assert_eq!(sky("clear"), SkySpec::clear());
        let clear = sky("clear; sun=35,200;turbidity=4;ground=.1,.2,.3;north=-20;strength=2;alone");
        let sun = SunPosition { elevation: 35.0, azimuth: 200.0 };
        let kind = SkyKind::Clear { sun, turbidity: 4.0, ground: Vec3::new(0.1, 0.2, 0.3) };
        assert_eq!(clear, SkySpec { sky: Sky { kind, strength: 2.0, north: -20.0 }, alone: true });
        for text in [
            "clear",
            "clear;sun=35.1,200.7;turbidity=4.3;alone",
            "uniform;color=.1,.2,.3",
            "gradient;north=-20;strength=.3",
        ] {
            assert_eq!(sky(&sky(text).to_string()), sky(text), "{text}");
        }
        assert_eq!(sky("uniform;color=0.5").sky.kind, SkyKind::Uniform { color: Vec3::splat(0.5) });
        let SkyKind::Gradient { horizon, ground, .. } = sky("gradient;horizon=1").sky.kind else { panic!() };
        assert_eq!((horizon, ground), (Vec3::ONE, Sky::GROUND));
        let SkyKind::Clear { sun, .. } = sky("clear;place=48.85,2.35;time=2026-06-21T12:00Z").sky.kind else {
            panic!()
        };
        assert!((64.0..65.0).contains(&sun.elevation), "{sun:?}");
    }

    #[test]
    fn what_is_no_sky_says_what_is() {
        let all = [
            "",
            "blue",
            "clear;sun=1",
            "clear;sun=1,2,3x",
            "clear;color=1",
            "clear;place=1,2",
            "clear;sun=1,2;sun=3,4",
            "clear;alone=1",
            "clear;strength",
            "uniform;sun=1,2",
            "clear;strength=-1",
            "clear;turbidity=hazy",
        ];
        for text in all {
            assert!(text.parse::<SkySpec>().is_err(), "{text}");
        }
        let error = "clear;place=1,2;time=noon".parse::<SkySpec>().unwrap_err().to_string();
        assert!(error.contains("`noon`") && error.contains("2026-06-21T15:00+02:00"), "{error}");
    }

    #[test]
    fn an_environment_is_a_file_with_options() {
        let spec = |text: &str| text.parse::<EnvironmentSpec>();
        let plain = EnvironmentSpec { file: "a b.hdr".into(), rotation: 0.0, strength: 1.0, alone: false };
        assert_eq!(spec("a b.hdr"), Ok(plain.clone()));
        assert_eq!(
            spec("a b.hdr; rotation=-90;strength=.5;alone"),
            Ok(EnvironmentSpec { rotation: -90.0, strength: 0.5, alone: true, ..plain })
        );
        let turned = spec("a b.hdr; rotation=-90;strength=.5;alone").unwrap();
        assert_eq!(spec(&turned.to_string()), Ok(turned));
        for text in ["", ";alone", "a.hdr;turn=3", "a.hdr;rotation=x"] {
            assert!(spec(text).is_err(), "{text}");
        }
    }
}
