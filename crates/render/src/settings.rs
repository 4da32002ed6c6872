//! What the user may choose, and what becomes of "auto".

use lightmesh_scene::{Camera, Up, Weight};

/// How visibility is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The light mesh method.
    #[default]
    LightMesh,
    /// One hard shadow ray per light and pixel.
    RayTrace,
    /// Many shadow rays per light and pixel: the reference.
    Area,
}

impl Mode {
    /// The word on the command line and in statistics.
    pub fn name(self) -> &'static str {
        match self {
            Mode::LightMesh => "light-mesh",
            Mode::RayTrace => "ray-trace",
            Mode::Area => "area",
        }
    }
}

/// How light-mesh mode finds the visibility of a light at a surface point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lookup {
    /// The best there is: half-ball.
    #[default]
    Auto,
    /// Formula (3).
    HalfBall,
}

/// The light-mesh step h.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Step {
    /// Tied to the size of a pixel in the scene.
    #[default]
    Auto,
    /// In scene units.
    Fixed(f32),
}

/// How the short tests are evaluated. The masks are the same in every bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShortTests {
    /// By light-mesh cell, with the cell's possible occluders found once.
    #[default]
    Cells,
    /// One segment after the other through the acceleration structure: the oracle.
    Plain,
}

/// The acceleration structure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Acceleration {
    /// The fastest on this device: the BVH.
    #[default]
    Auto,
    /// The regular grid of the thesis, built with cells along each axis as given or chosen.
    Grid(Option<[u32; 3]>),
    /// The regular grid kept in a file by `lightmesh grid`.
    GridFile(std::path::PathBuf),
    /// A wide BVH.
    Bvh,
    /// Every triangle, always: the oracle.
    BruteForce,
}

/// Everything that can be chosen about a picture, apart from the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How visibility is found.
    pub mode: Mode,
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The camera; `None`: the scene's first, else one that frames the scene.
    pub camera: Option<Camera>,
    /// Which way is up for a camera that frames the scene.
    pub up: Up,
    /// Light-mesh step; `None`: the scene's, else auto.
    pub step: Option<Step>,
    /// Interpolation radius in steps; `None`: the scene's, else 2.1.
    pub radius: Option<f32>,
    /// Weight of formula (3); `None`: the scene's, else smooth.
    pub weight: Option<Weight>,
    /// How light-mesh mode looks visibility up.
    pub lookup: Lookup,
    /// How short tests are evaluated.
    pub short_tests: ShortTests,
    /// Shadow rays per light with a size; `None`: 225 in area mode, 4 per light point in light-mesh mode.
    pub samples: Option<u32>,
    /// The acceleration structure.
    pub acceleration: Acceleration,
    /// Random pattern of sampled lights.
    pub seed: u64,
    /// Keep depth, normals, positions and visibility of every pixel beside its colour.
    pub layers: bool,
    /// Bytes to stay under: of the process on the CPU, of the device's own memory on a GPU; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            mode: Mode::LightMesh,
            bounces: 0,
            size: [1024, 1024],
            camera: None,
            up: Up::Y,
            step: None,
            radius: None,
            weight: None,
            lookup: Lookup::Auto,
            short_tests: ShortTests::Cells,
            samples: None,
            acceleration: Acceleration::Auto,
            seed: 0,
            layers: false,
            memory_limit: None,
        }
    }
}

impl Settings {
    /// Default interpolation radius in steps: with a weight that falls to the rim it beats R = 3.1 with w = 1 at a third of the
    /// short tests.
    pub const DEFAULT_RADIUS: f32 = 2.1;

    /// Shadow rays per light with a size in this mode.
    pub fn samples(&self) -> u32 {
        self.samples.unwrap_or(match self.mode {
            Mode::Area => 225,
            Mode::LightMesh | Mode::RayTrace => 4,
        })
    }
}
