//! A light as "x,y,z[;I[;RADIUS]]", a colour, and a background.

use std::fmt;
use std::str::FromStr;

use glam::{DVec3, Vec3};
use lightmesh_image::Transfer;

use super::ValueError;
use super::number::{not_negative, triple};

/// Red, green and blue, each at least 0: three numbers, or one for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub Vec3);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [r, g, b] = self.0.to_array();
        write!(f, "{r},{g},{b}")
    }
}

impl FromStr for Color {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Color, ValueError> {
        let parts: Vec<&str> = text.split(',').collect();
        let channel = |text| not_negative("the intensity", text).map(|value| value as f32);
        match parts[..] {
            [grey] => Ok(Color(Vec3::splat(channel(grey)?))),
            [r, g, b] => Ok(Color(Vec3::new(channel(r)?, channel(g)?, channel(b)?))),
            _ => Err(ValueError::Form { form: "one number, or three as red,green,blue", example: "0.9,0.8,0.7" }),
        }
    }
}

/// What is behind a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// Nothing.
    Transparent,
    /// A linear colour.
    Color(Color),
}

impl fmt::Display for Background {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Background::Transparent => f.write_str("transparent"),
            Background::Color(color) => color.fmt(f),
        }
    }
}

impl FromStr for Background {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Background, ValueError> {
        const FORM: ValueError = ValueError::Form {
            form: "transparent, one number, three as red,green,blue, or #rrggbb",
            example: "0.6,0.75,0.9",
        };
        match (text, text.strip_prefix('#')) {
            ("transparent", _) => Ok(Background::Transparent),
            (_, Some(digits)) => hexadecimal(digits).map(Background::Color).ok_or(FORM),
            _ => text.parse().map(Background::Color).map_err(|error| match error {
                ValueError::Form { .. } | ValueError::NotANumber { .. } => FORM,
                other => other,
            }),
        }
    }
}

/// The linear colour of six hexadecimal digits, which are codes on the sRGB curve.
fn hexadecimal(digits: &str) -> Option<Color> {
    let is_valid = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let codes = is_valid.then(|| u32::from_str_radix(digits, 16).ok())??.to_be_bytes();
    let [_, r, g, b] = codes.map(|code| Transfer::Srgb.decode(code));
    Some(Color(Vec3::new(r, g, b)))
}

/// A light as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSpec {
    /// Its centre, world coordinates.
    pub position: DVec3,
    /// Red, green and blue.
    pub intensity: Vec3,
    /// 0: a point.
    pub radius: f32,
}

impl fmt::Display for LightSpec {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let LightSpec { position, intensity, radius } = self;
        write!(f, "{},{},{};{};{radius}", position.x, position.y, position.z, Color(*intensity))
    }
}

const FORM: ValueError = ValueError::Form {
    form: "POSITION, POSITION;INTENSITY or POSITION;INTENSITY;RADIUS",
    example: "\"3,8,2;0.9;0.25\"",
};

impl FromStr for LightSpec {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<LightSpec, ValueError> {
        let parts: Vec<&str> = text.split(';').collect();
        let (position, intensity, radius) = match parts[..] {
            [position] => (position, "1", "0"),
            [position, intensity] => (position, intensity, "0"),
            [position, intensity, radius] => (position, intensity, radius),
            _ => return Err(FORM),
        };
        let position = triple(position)?.ok_or(FORM)?;
        let Color(intensity) = intensity.parse()?;
        Ok(LightSpec { position, intensity, radius: not_negative("the radius", radius)? as f32 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intensity_and_radius_may_be_left_out() {
        let light = |text: &str| text.parse::<LightSpec>().unwrap();
        let position = DVec3::new(-1.0, 2.0, 3.0);
        assert_eq!(light("-1,2,3"), LightSpec { position, intensity: Vec3::ONE, radius: 0.0 });
        assert_eq!(light("-1,2,3;0.5"), LightSpec { position, intensity: Vec3::splat(0.5), radius: 0.0 });
        let intensity = Vec3::new(1.0, 0.5, 0.25);
        assert_eq!(light("-1,2,3;1,.5,.25;2"), LightSpec { position, intensity, radius: 2.0 });
    }

    #[test]
    fn a_background_is_a_colour_or_nothing() {
        let color = |r, g, b| Ok(Background::Color(Color(Vec3::new(r, g, b))));
        assert_eq!("transparent".parse(), Ok(Background::Transparent));
        assert_eq!(["0.5".parse(), "1,0.5,0".parse()], [color(0.5, 0.5, 0.5), color(1.0, 0.5, 0.0)]);
        assert_eq!("#ff0080".parse(), color(1.0, 0.0, Transfer::Srgb.decode(128)));
        for text in ["", "none", "#ff00", "#ff00zz", "#+f0000", "#ääa", "1,2", "nan"] {
            let message = text.parse::<Background>().unwrap_err().to_string();
            assert!(message.contains("transparent") && message.contains("#rrggbb"), "{text}: {message}");
        }
        assert_eq!("-1".parse::<Background>().unwrap_err().to_string(), "the intensity must be 0 or more, but is -1");
    }

    #[test]
    fn what_does_not_shine_is_refused() {
        let message = |text: &str| text.parse::<LightSpec>().unwrap_err().to_string();
        assert!(message("").contains("POSITION"));
        assert!(message("1,2").contains("POSITION"));
        assert!(message("1,2,3;1,2").contains("red,green,blue"));
        assert_eq!(message("1,2,3;-1"), "the intensity must be 0 or more, but is -1");
        assert_eq!(message("1,2,3;1;-0.5"), "the radius must be 0 or more, but is -0.5");
        assert!(message("1,2,3;1;1;1").contains("POSITION"));
    }
}
