//! The suns of a study as lights.
//!
//! Where a step is asked for, the suns are discs, where they stand at the moments: hours are what a list of these moments gives.
//!
//! Else each is a *sweep*: all that the disc passes over in the time for which the moment stands. Shares of a sweep are shares of that time, so that
//! no edge of a shadow is a step early or late. The samples of one sun do for it, since those of its rows lie at different times. A sweep
//! is a rectangle: along the sun's path, a chord of the arc, which differs from it by less than a fiftieth of a degree in 15 minutes; across, as
//! wide as an even strip that spreads like a disc. It lies so far away that it is seen in the same direction from everywhere.

use glam::Vec3;
use lightmesh_scene::{Bounds, Light, LightError, LightKind, SunPosition, Up};

use crate::sun::{SunMoment, SunStudy};

/// Bytes that layers of suns may take at a time.
pub(super) const BYTES_AT_ONCE: usize = 256 << 20;
/// More suns at a time hardly save anything.
pub(super) const MAX_AT_ONCE: usize = 64;
/// The distance of a sweep in radii of the scene. At the scene's edge its direction is off by the inverse of it, 7 seconds of the sun's way; and
/// searches for what hides it have a margin of the distance over 2^16.
const DISTANCE: f32 = 2048.0;
/// The variance of a disc of radius 1 across its middle is 1/4, that of a strip from -a to a is a²/3.
const STRIP: f32 = 0.866_025_4;

/// The suns of a study, each with the hours that it shines.
pub(super) fn suns(study: &SunStudy, up: Up, scene: Bounds) -> Result<Vec<(Light, f64)>, LightError> {
    let sun = |position: &SunPosition| position.light(up, study.sky.sky.north);
    let light = |moment: &SunMoment| {
        let light = match study.spec.step {
            Some(_) => sun(&moment.sun)?,
            None => {
                let [begin, middle, end] = &moment.span;
                let middle = sun(middle)?;
                sweep([sun(begin)?, sun(end)?], &middle, scene).unwrap_or(middle)
            }
        };
        Ok((light, moment.hours))
    };
    study.moments.iter().map(light).collect()
}

/// What a sun passes over between two places; `None` if it stands still.
fn sweep(ends: [Light; 2], middle: &Light, scene: Bounds) -> Option<Light> {
    let way = |light: &Light| match light.kind {
        LightKind::Directional { direction, angle } => Some((-direction, angle)),
        _ => None,
    };
    let ([(begin, _), (end, _)], (to, angle)) = ([way(&ends[0])?, way(&ends[1])?], way(middle)?);
    let path = end - begin;
    let along = (path - path.dot(to) * to).try_normalize()?;
    let half = 0.5 * begin.angle_between(end);
    let (center, radius) = match scene.is_empty() {
        true => (Vec3::ZERO, 1.0),
        false => (scene.center(), 0.5 * scene.diagonal()),
    };
    let far = DISTANCE * radius.max(f32::MIN_POSITIVE);
    let across = STRIP * (0.5 * angle).tan() * far * to.cross(along);
    Light::rectangle(center + far * to, half.tan() * far * along, across).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::SkySpec;

    const SCENE: Bounds = Bounds { min: Vec3::splat(-3.0), max: Vec3::splat(5.0) };

    fn study(text: &str) -> SunStudy {
        SunStudy::of(text.parse().unwrap(), SkySpec::clear(), Vec::new())
    }

    #[test]
    fn sweeps_follow_each_other() {
        let suns = suns(&study("54.98,82.9,2026-06-21+07:00,00:00-24:00"), Up::Y, SCENE).unwrap();
        let ends: Vec<[Vec3; 2]> = suns
            .iter()
            .map(|(light, _)| {
                let LightKind::Rectangle { position, half_u, .. } = light.kind else { panic!("{light:?}") };
                [-1.0, 1.0].map(|side| (position + side * half_u - SCENE.center()).normalize())
            })
            .collect();
        assert!(ends.len() > 60);
        for (pair, number) in ends.windows(2).zip(0..) {
            let apart = pair[0][1].angle_between(pair[1][0]).to_degrees();
            assert!(apart < 0.04, "{number}: {apart}");
        }
        // 15 degrees an hour, less towards the poles of the sky.
        let LightKind::Rectangle { half_u, half_v, position } = suns[20].0.kind else { panic!() };
        let far = (position - SCENE.center()).length();
        let degrees = 2.0 * (half_u.length() / far).atan().to_degrees();
        assert!((degrees - 3.75 * 23.43_f32.to_radians().cos()).abs() < 0.01, "{degrees}");
        assert!((half_v.length() / far).to_degrees() < 0.27);
    }

    #[test]
    fn a_step_has_discs() {
        let study = study("54.98,82.9,2026-06-21+07:00,06:00-20:00/15m");
        for ((light, hours), moment) in suns(&study, Up::Y, SCENE).unwrap().iter().zip(&study.moments) {
            assert_eq!((light, *hours), (&moment.sun.light(Up::Y, 0.0).unwrap(), moment.hours));
        }
    }
}
