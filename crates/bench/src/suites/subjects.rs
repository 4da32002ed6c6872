//! The scenes of a suite that accepts any: the built-in ones, or those of the plan.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lightmesh::scene::{CreaseAngle, LightKind, LoadOptions, Up};
use lightmesh::{LoadError, Observer, Scene};

use crate::{BenchError, Plan};

/// The built-in scenes with the thesis' steps h, in scene units.
const BUILT_IN: [(&str, f32); 3] = [("builtin:gazebo", 2.0), ("builtin:childpark", 1.0), ("builtin:garden", 0.1)];
/// Radius of a light without extent, as a fraction of the scene's diagonal: that of the default lights.
const LIGHT_RADIUS: f32 = 0.02;

/// A scene to measure.
pub(super) struct Subject {
    /// The key `scene`.
    pub(super) name: String,
    /// The scene, with lights and a camera.
    pub(super) scene: Scene,
    /// Its usual step h; `None`: automatic.
    pub(super) step: Option<f32>,
}

/// Calls `study` for each scene of the plan with an equal share of the remaining time.
pub(super) fn each(
    plan: &Plan,
    observer: &dyn Observer,
    mut study: impl FnMut(&Subject, Duration) -> Result<(), BenchError>,
) -> Result<(), BenchError> {
    let (begin, paths) = (Instant::now(), paths(plan));
    for index in 0..paths.len() {
        let subject = Subject::open(&paths, index, plan.smooth)?;
        observer.note(&format!("scene {} of {}: {}", index + 1, paths.len(), subject.name));
        study(&subject, plan.budget.saturating_sub(begin.elapsed()) / (paths.len() - index) as u32)?;
    }
    Ok(())
}

/// The scenes of a plan.
fn paths(plan: &Plan) -> Vec<PathBuf> {
    match plan.scenes.as_slice() {
        [] => BUILT_IN.iter().map(|(path, _)| PathBuf::from(path)).collect(),
        scenes => scenes.to_vec(),
    }
}

impl Subject {
    /// Opens the scene `paths[index]`. Its name is short, or its path if another scene has the same short name.
    fn open(paths: &[PathBuf], index: usize, smooth: Option<CreaseAngle>) -> Result<Subject, LoadError> {
        let path = &paths[index];
        let mut scene = Scene::open_with(path, &LoadOptions::default().with_smooth(smooth))?;
        if scene.cameras.is_empty() {
            scene.cameras.push(scene.default_camera(Up::default()));
        }
        if scene.lights.is_empty() {
            let lights = scene.default_lights(&scene.cameras[0]);
            scene.lights.extend(lights);
        }
        let known = BUILT_IN.iter().find(|(name, _)| path.to_str() == Some(name)).map(|(_, step)| *step);
        let namesakes = paths.iter().filter(|other| short(other) == short(path)).count();
        let name = if namesakes == 1 { short(path) } else { path.display().to_string() };
        Ok(Subject { name, step: known.or(scene.light_mesh.step), scene })
    }

    /// The scene with its lights as balls, with the spread of area mode or a radius derived from the scene's size.
    pub(super) fn with_balls(&self) -> Scene {
        let mut scene = self.scene.clone();
        let usual = LIGHT_RADIUS * scene.geometry.mesh.bounds().diagonal();
        for light in &mut scene.lights {
            if let LightKind::Point { position, spread } = light.kind {
                light.kind = LightKind::Sphere { position, radius: if spread > 0.0 { spread } else { usual } };
            }
        }
        scene
    }
}

/// `garden?lights=3` for `builtin:garden?lights=3`, `bunny` for `models/bunny.ply`.
fn short(path: &Path) -> String {
    let whole = path.to_string_lossy();
    match whole.strip_prefix("builtin:") {
        Some(name) => name.to_owned(),
        None => path.file_stem().map_or_else(|| whole.to_string(), |stem| stem.to_string_lossy().into_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_short_unless_they_are_taken() {
        assert_eq!(short(Path::new("builtin:garden?lights=3")), "garden?lights=3");
        assert_eq!(short(Path::new("models/bunny.ply")), "bunny");
        let paths = ["builtin:gazebo", "builtin:gazebo?lights=1", "builtin:gazebo"].map(PathBuf::from);
        let names: Vec<String> = (0..2).map(|index| Subject::open(&paths, index, None).unwrap().name).collect();
        assert_eq!(names, ["builtin:gazebo", "gazebo?lights=1"]);
    }

    #[test]
    fn point_lights_become_balls_where_area_mode_strews_them() {
        let subject = Subject::open(&[PathBuf::from("builtin:childpark")], 0, None).unwrap();
        assert_eq!(subject.step, Some(1.0));
        for (point, ball) in subject.scene.lights.iter().zip(subject.with_balls().lights) {
            let LightKind::Point { position, spread } = point.kind else { panic!("{point:?}") };
            assert_eq!(ball.kind, LightKind::Sphere { position, radius: spread });
        }
    }
}
