//! A camera as "x,y,z;x,y,z;degrees".

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use super::ValueError;
use super::number::{number, triple};

/// A perspective camera as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// The eye, world coordinates.
    pub position: DVec3,
    /// What it looks at; the distance is long enough to be normalised.
    pub target: DVec3,
    /// Vertical field of view, degrees.
    pub vfov: f32,
}

impl CameraView {
    /// Where it looks; not normalised.
    pub fn direction(&self) -> DVec3 {
        self.target - self.position
    }
}

impl fmt::Display for CameraView {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [a, b] = [self.position, self.target];
        write!(f, "{},{},{};{},{},{};{}", a.x, a.y, a.z, b.x, b.y, b.z, self.vfov)
    }
}

const FORM: ValueError = ValueError::Form {
    form: "POSITION;TARGET;VFOV, the vertical field of view in degrees",
    example: "\"0,2,5;0,1,0;45\"",
};

impl FromStr for CameraView {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<CameraView, ValueError> {
        let parts: Vec<&str> = text.split(';').collect();
        let [position, target, angle] = parts[..] else { return Err(FORM) };
        let position = triple(position)?.ok_or(FORM)?;
        let target = triple(target)?.ok_or(FORM)?;
        (target - position).try_normalize().ok_or(ValueError::NoDirection)?;
        let vfov = number(angle)? as f32;
        if vfov <= 0.0 || vfov >= 180.0 {
            let text = angle.trim().to_owned();
            return Err(ValueError::OutOfRange {
                what: "the vertical field of view",
                text,
                range: "between 0 and 180 degrees",
            });
        }
        Ok(CameraView { position, target, vfov })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn position_target_and_angle_are_read() {
        let view: CameraView = "1, 2, 7; 1, 2, -3.5; 45".parse().unwrap();
        assert_eq!((view.position, view.direction(), view.vfov), (DVec3::new(1.0, 2.0, 7.0), -10.5 * DVec3::Z, 45.0));
        assert_eq!((view.to_string().as_str(), view.to_string().parse()), ("1,2,7;1,2,-3.5;45", Ok(view)));
    }

    #[test]
    fn what_shows_nothing_is_refused() {
        let message = |text: &str| text.parse::<CameraView>().unwrap_err().to_string();
        assert!(message("1,2,3").contains("POSITION;TARGET"));
        assert!(message("1,2;1,2,3;45").contains("POSITION;TARGET"));
        assert!(message("1,2,3;1,2,3;45").contains("same point"));
        assert!(message("1,2,x;1,2,3;45").contains("`x` is not a valid number"));
        assert_eq!(
            message("1,2,3;0,0,0;180"),
            "the vertical field of view must be between 0 and 180 degrees, but is 180"
        );
    }
}
