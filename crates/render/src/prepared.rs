//! A scene made ready for rays.

use std::any::Any;
use std::sync::{Arc, Mutex};

use glam::Vec3;
use lightmesh_scene::{Bounds, Scene};

use crate::accel::{Accelerator, BruteForce, Bvh, Grid, GridOptions, Triangle};
use crate::settings::Acceleration;
use crate::{Observer, RenderError, Stage};

/// A scene with its acceleration structure. Any number of pictures can be taken of it.
pub struct PreparedScene<'s> {
    /// The scene itself.
    pub scene: &'s Scene,
    /// The scene's triangles by index.
    pub triangles: Vec<Triangle>,
    /// What finds triangles.
    pub accelerator: Box<dyn Accelerator>,
    /// The box around all triangles that can be hit.
    pub bounds: Bounds,
    /// Seconds that building took.
    pub build_seconds: f64,
    /// Copies that devices hold, by [`Runtime::id`](crate::cuda::Runtime::id).
    pub(crate) resident: Mutex<Vec<(u64, Arc<dyn Any + Send + Sync>)>>,
    pub(crate) center: Vec3,
    /// A little more than the diagonal of the bounds; 1 where there are none.
    pub(crate) far: f32,
}

impl<'s> PreparedScene<'s> {
    /// Builds the acceleration structure over `scene`.
    pub fn new(
        scene: &'s Scene,
        acceleration: &Acceleration,
        observer: &dyn Observer,
    ) -> Result<PreparedScene<'s>, RenderError> {
        observer.begin(Stage::Build, scene.mesh.triangles.len() as u64);
        let start = std::time::Instant::now();
        let triangles: Vec<Triangle> = (0..scene.mesh.triangles.len())
            .map(|index| Triangle::new(scene.mesh.corners(index), index as u32))
            .collect();
        let accelerator: Box<dyn Accelerator> = match acceleration {
            Acceleration::Auto | Acceleration::Bvh => Box::new(Bvh::new(&triangles)),
            Acceleration::Grid(dims) => {
                Box::new(Grid::new(&triangles, &GridOptions { dims: *dims, ..GridOptions::default() })?)
            }
            Acceleration::GridFile(path) => Box::new(Grid::load(path, &triangles)?),
            Acceleration::BruteForce => Box::new(BruteForce::new(&triangles)),
        };
        let build_seconds = start.elapsed().as_secs_f64();
        observer.end(Stage::Build);
        // Triangles that cannot be hit take no part.
        let usable = triangles.iter().filter(|triangle| triangle.is_usable());
        let bounds = Bounds::around(usable.flat_map(Triangle::corners));
        let (center, far) =
            if bounds.is_empty() { (Vec3::ZERO, 1.0) } else { (bounds.center(), 1.25 * bounds.diagonal()) };
        Ok(PreparedScene {
            scene,
            bounds,
            triangles,
            accelerator,
            build_seconds,
            resident: Mutex::default(),
            center,
            far,
        })
    }

    /// How far a directional light stands from `from`: farther than any triangle. Asked for every segment, so without a root.
    #[inline(always)]
    pub fn reach(&self, from: Vec3) -> f32 {
        self.far + 2.0 * (from - self.center).abs().element_sum()
    }

    /// Bytes that the geometry takes on the host, acceleration structure included.
    pub fn memory(&self) -> usize {
        size_of_val(self.triangles.as_slice()) + self.accelerator.memory()
    }
}
