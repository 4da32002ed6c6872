//! Skies: of a clear day, the same everywhere, or from one colour to another.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};

use super::directions::frame;
use super::panorama::Environment;
use super::sun::{SUN_ANGLE, Sun};
use super::sun_position::SunPosition;
use crate::model::colors::luminance;
use crate::{Light, Up};

/// Width and height of the panorama of a clear sky. Half of the rows are above the horizon.
const SIZE: [u32; 2] = [1024, 512];
/// Rows of a sky that changes with the elevation alone.
const ROWS: u32 = 512;

/// A sky, and the ground below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// What it looks like.
    pub kind: SkyKind,
    /// Factor of all radiances. With 1, a white surface that faces the sun of a clear sky shows 1.
    pub strength: f32,
    /// The direction of the scene that is north, clockwise from −Z if Y is up, from +Y if Z is up, degrees.
    pub north: f32,
}

/// What a sky looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyKind {
    /// A cloudless sky (Hosek, Wilkie: *An Analytic Model for Full Spectral Sky-Dome Radiance*, SIGGRAPH 2012) with its sun.
    Clear {
        /// Where the sun stands.
        sun: SunPosition,
        /// Haze: 1 is the clearest air, 10 fog; 3 is usual.
        turbidity: f32,
        /// What the ground reflects, from 0 to 1 by channel: it lights the sky, and is seen below the horizon.
        ground: Vec3,
    },
    /// The same radiance from everywhere, also from below.
    Uniform {
        /// Radiance.
        color: Vec3,
    },
    /// From one radiance at the horizon to another at the zenith, in proportion to the sine of the elevation; a third below the horizon.
    Gradient {
        /// Radiance straight above.
        zenith: Vec3,
        /// Radiance at the horizon.
        horizon: Vec3,
        /// Radiance of the ground.
        ground: Vec3,
    },
}

/// Why there is no sky.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// The sun of a clear sky has set.
    #[error("the sun is {:.2} degrees below the horizon, and twilight is not modelled; choose another time or an elevation from 0 to 90", -elevation)]
    Night {
        /// Its elevation, degrees.
        elevation: f64,
    },
    /// A number out of range.
    #[error("the {what} is {value:?}; it can be from {least} to {most}")]
    Range {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
        /// The smallest value.
        least: f64,
        /// The largest value.
        most: f64,
    },
}

/// What surrounds a scene, and the lights that belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// What is seen, and lights from everywhere.
    pub environment: Environment,
    /// The sun as a light, if there is one.
    pub sun: Option<Light>,
    /// The lights that bright regions of an image are.
    pub discs: Vec<Light>,
}

impl From<Environment> for Surroundings {
    fn from(environment: Environment) -> Surroundings {
        let sun = environment.sun().and_then(|sun| sun.light().ok());
        let discs = environment.discs().iter().filter_map(|disc| disc.part_of_image().ok()).collect();
        Surroundings { environment, sun, discs }
    }
}

impl Sky {
    /// Where the sun stands if nothing says so: to the left behind a camera that looks north.
    pub const SUN: SunPosition = SunPosition { elevation: 40.0, azimuth: 225.0 };
    /// Usual haze.
    pub const TURBIDITY: f32 = 3.0;
    /// What grass and streets reflect, and the radiance below a gradient.
    pub const GROUND: Vec3 = Vec3::splat(0.2);
    /// The zenith of a gradient.
    pub const ZENITH: Vec3 = Vec3::new(0.25, 0.45, 0.9);
    /// The horizon of a gradient.
    pub const HORIZON: Vec3 = Vec3::new(0.8, 0.9, 1.0);

    /// A sky of this kind with strength 1.
    pub fn new(kind: SkyKind) -> Sky {
        Sky { kind, strength: 1.0, north: 0.0 }
    }

    /// A clear sky with usual haze over grass, and the sun at this place.
    pub fn clear(sun: SunPosition) -> Sky {
        Sky::new(SkyKind::Clear { sun, turbidity: Sky::TURBIDITY, ground: Sky::GROUND })
    }

    /// The sky as surroundings of a scene in which `up` is up.
    ///
    /// # Errors
    /// [`SkyError`]
    pub fn surroundings(&self, up: Up) -> Result<Surroundings, SkyError> {
        let environment = match self.kind {
            SkyKind::Clear { sun, turbidity, ground } => clear(sun, turbidity, ground, up)?,
            SkyKind::Uniform { color } => Environment::new("uniform sky", [1; 2], vec![color.to_array()], up),
            SkyKind::Gradient { zenith, horizon, ground } => {
                let row = |row: u32| {
                    let height = (PI * (0.5 - (row as f32 + 0.5) / ROWS as f32)).sin();
                    if height > 0.0 { horizon + height * (zenith - horizon) } else { ground }.to_array()
                };
                Environment::new("gradient sky", [1, ROWS], (0..ROWS).map(row).collect(), up)
            }
        };
        in_range("strength", f64::from(self.strength), 0.0, 1e9)?;
        in_range("direction of north", f64::from(self.north), -360.0, 360.0)?;
        Ok(environment.turned(self.north).scaled(self.strength).into())
    }
}

fn in_range(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), SkyError> {
    if (least..=most).contains(&value) { Ok(()) } else { Err(SkyError::Range { what, value, least, most }) }
}

/// A cloudless sky with its sun, and below the horizon the ground that they light.
pub fn clear(sun: SunPosition, turbidity: f32, ground: Vec3, up: Up) -> Result<Environment, SkyError> {
    if !(0.0..=90.0).contains(&sun.elevation) {
        let elevation = sun.elevation;
        return Err(match elevation {
            below if below < 0.0 => SkyError::Night { elevation },
            value => SkyError::Range { what: "elevation of the sun", value, least: 0.0, most: 90.0 },
        });
    }
    in_range("azimuth of the sun", sun.azimuth, -360.0, 360.0)?;
    in_range("turbidity", f64::from(turbidity), 1.0, 10.0)?;
    for channel in ground.to_array() {
        in_range("reflectance of the ground", f64::from(channel), 0.0, 1.0)?;
    }
    let elevation = sun.elevation.to_radians() as f32;
    let params = SkyParams { elevation: elevation.min(FRAC_PI_2), turbidity, albedo: ground.to_array() };
    let state = SkyState::new(&params).expect("its parameters are in range");

    // 1. The sky, in candela per square metre: the model gives radiance, of which 683 lumens are a watt.
    let frame = frame(up);
    let direction = sun.direction(up);
    let [_, zenith, _] = frame;
    let dome = Environment::seen("clear sky", SIZE, up, |way| {
        if zenith.dot(way) < 0.0 {
            return Vec3::ZERO;
        }
        let theta = zenith.dot(way).min(1.0).acos();
        let gamma = direction.dot(way).clamp(-1.0, 1.0).acos();
        let radiance = |channel| (LUMENS_PER_WATT * state.radiance(theta, gamma, channel)).max(0.0);
        Vec3::new(radiance(Channel::R), radiance(Channel::G), radiance(Channel::B))
    });

    // 2. The sun, and the ground that both light.
    let illuminance = sun_illuminance(elevation, turbidity);
    let from_sky = dome.irradiance(zenith);
    let lit = ground * (from_sky + elevation.sin() * illuminance) / PI;
    let mut texels = dome.levels.image;
    texels[(SIZE[0] * SIZE[1] / 2) as usize..].fill(lit.to_array());

    // 3. White that faces the sun shows 1.
    let facing = luminance(illuminance + from_sky) / PI;
    let environment = Environment::new("clear sky", SIZE, texels, up);
    Ok(environment.with_sun(Some(Sun::new(direction, SUN_ANGLE, illuminance))).scaled(1.0 / facing))
}

/// Luminous efficacy of the radiances of the model.
const LUMENS_PER_WATT: f32 = 683.0;
/// Illuminance by the sun outside of the atmosphere, lux (Darula, Kittler, Gueymard: *Reference luminous solar constant and solar luminance for
/// illuminance calculations*, Solar Energy 79, 2005).
const SUN_LUX: f32 = 133_334.0;
/// Its colour: a black body of 5778 K, relative to white of the same luminance, in linear sRGB.
const SUN_COLOR: Vec3 = Vec3::new(1.118, 0.974, 0.911);
/// The wavelengths that dominate the primaries of sRGB, micrometres.
const WAVELENGTHS: [f32; 3] = [0.611, 0.549, 0.464];
/// How much a centimetre of ozone absorbs of them (Preetham, Shirley, Smits 1999, table 2).
const OZONE: [f32; 3] = [0.12, 0.085, 0.008];
/// Ozone above us, centimetres.
const OZONE_DEPTH: f32 = 0.35;

/// What the sun gives to a surface that faces it, lux by channel: molecules, haze and ozone absorb and scatter (Preetham, Shirley, Smits:
/// *A Practical Analytic Model for Daylight*, SIGGRAPH 1999, appendix 1).
pub fn sun_illuminance(elevation: f32, turbidity: f32) -> Vec3 {
    let from_zenith = 90.0 - elevation.to_degrees();
    // The air on the way, in units of that above us.
    let mass = 1.0 / (elevation.sin() + 0.15 * (93.885 - from_zenith).powf(-1.253));
    let haze = 0.04608 * turbidity - 0.04586;
    let arrives = |channel: usize| {
        let length = WAVELENGTHS[channel];
        let molecules = 0.008735 * length.powf(-4.08);
        (-mass * (molecules + haze.max(0.0) * length.powf(-1.3) + OZONE[channel] * OZONE_DEPTH)).exp()
    };
    SUN_LUX * SUN_COLOR * Vec3::new(arrives(0), arrives(1), arrives(2))
}
