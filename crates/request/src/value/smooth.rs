//! The crease angle of files without normals.

use std::fmt;
use std::str::FromStr;

use lightmesh_scene::CreaseAngle;

use super::ValueError;
use super::number::number;

/// A crease angle in degrees, or `off`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Smooth(pub Option<CreaseAngle>);

impl Smooth {
    /// Facets.
    pub const OFF: Smooth = Smooth(None);
}

/// Smooth, with the usual angle.
impl Default for Smooth {
    fn default() -> Smooth {
        Smooth(Some(CreaseAngle::default()))
    }
}

impl fmt::Display for Smooth {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            Some(crease) => write!(f, "{}", crease.degrees()),
            None => f.write_str("off"),
        }
    }
}

impl FromStr for Smooth {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Smooth, ValueError> {
        let text = text.trim();
        if text == "off" {
            return Ok(Smooth::OFF);
        }
        let crease = CreaseAngle::from_degrees(number(text)?);
        let range = "above 0 and at most 180 degrees, or off";
        crease.map(|crease| Smooth(Some(crease))).ok_or(ValueError::OutOfRange {
            what: "the crease angle",
            text: text.to_owned(),
            range,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_is_read_back_as_it_is_shown() {
        for text in ["30", "0.5", "180", "off"] {
            assert_eq!(text.parse::<Smooth>().unwrap().to_string(), text);
        }
        assert_eq!(Smooth::default().to_string(), "30");
    }

    #[test]
    fn what_is_no_angle_is_refused() {
        for text in ["", "on", "nan", "30deg", "0", "-30", "180.1"] {
            assert!(text.parse::<Smooth>().is_err(), "{text}");
        }
        assert_eq!(
            "0".parse::<Smooth>().unwrap_err().to_string(),
            "the crease angle must be above 0 and at most 180 degrees, or off, but is 0"
        );
    }
}
