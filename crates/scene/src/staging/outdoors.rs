//! A model under a sky as one would photograph it: from lower than in a studio, so that the horizon is in the image, on a ground that fades
//! into the sky with distance.
//!
//! The ground [catches shadows](Scene::add_ground): elsewhere it shows what surrounds the scene below the horizon, so haze there is haze on the
//! ground. At an angle e below the horizon, a level ground is 1 / tan e heights of the eye away, and haze hides the share exp(−tan e / tan `HAZE`)
//! of it: all of it at the horizon, nothing below one's feet.

use std::f32::consts::PI;

use glam::Vec3;

use crate::{Added, Environment, Scene, Up, Viewpoint};

/// How far below the horizon haze hides a third of the ground, degrees.
const HAZE: f32 = 4.0;

impl Scene {
    /// Completes a scene that has surroundings, such as one under a [sky](crate::Sky): adds haze, a [ground](Scene::add_ground) and, if there is
    /// no camera, one that frames it with the horizon in the upper part of the image. An interior that would be looked at from inside gets
    /// its [usual camera](Scene::default_camera) and nothing else, and no ground is put above the scene's first camera.
    ///
    /// ```
    /// use lightmesh_scene::{Scene, Sky, Up};
    ///
    /// let mut scene = Scene::new("empty", lightmesh_scene::Geometry::default());
    /// scene.lights.surround(Sky::clear(Sky::SUN).surroundings(Up::Y)?);
    /// assert!(scene.complete_outdoors(Up::Y, 1.5).outdoors && scene.cameras[0].direction.y < 0.0);
    /// # Ok::<(), lightmesh_scene::SkyError>(())
    /// ```
    pub fn complete_outdoors(&mut self, up: Up, aspect: f32) -> Added {
        let Some(around) = self.lights.environment.clone() else {
            return self.complete_for(up, aspect);
        };
        let (camera, viewpoint) = self.camera_outdoors(up, aspect);
        let added = self.cameras.is_empty();
        let eye = self.cameras.first().map_or(camera.position, |camera| camera.position);
        if added {
            self.cameras.push(camera);
        }
        let height = |place: Vec3| place.dot(up.axis());
        let bounds = self.geometry.mesh.bounds();
        let is_above = bounds.is_empty() || height(eye) > height(bounds.min);
        let is_interior = viewpoint == Viewpoint::Inside;
        let outdoors = !is_interior && is_above;
        if outdoors {
            self.lights.environment = Some(hazy(&around).into());
            self.lights.outdoors = true;
            self.add_ground(up);
        }
        let viewpoint = if added { viewpoint } else { Viewpoint::default() };
        Added { camera: added, viewpoint, outdoors, indoors: is_interior, ..Added::default() }
    }
}

/// With a ground that fades into the row above the horizon. The same from everywhere stays the same.
fn hazy(around: &Environment) -> Environment {
    let [width, height] = around.size().map(|side| side as usize);
    let below = height.div_ceil(2);
    around.redrawn(&|texels| {
        let (above, ground) = texels.split_at(below * width);
        let horizon = &above[(below - 1) * width..];
        let row = |(row, texels): (usize, &[[f32; 3]])| -> Vec<[f32; 3]> {
            let depth = PI * ((below + row) as f32 + 0.5) / height as f32 - 0.5 * PI;
            let haze = (-depth.tan() / HAZE.to_radians().tan()).exp();
            let mixed =
                |at: usize| [0, 1, 2].map(|channel| haze * horizon[at][channel] + (1.0 - haze) * texels[at][channel]);
            (0..width).map(mixed).collect()
        };
        let faded = ground.chunks(width).enumerate().flat_map(row);
        above.iter().copied().chain(faded).collect()
    })
}
