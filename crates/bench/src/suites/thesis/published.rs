//! Values published in the thesis (Novosibirsk State University, 2012; chapter 5 and appendix), for a Core i7-950 at 3.07 GHz and
//! a Tesla C2070. Its scenes are not published: ours share counts and sizes, not shapes.

/// A scene of the thesis.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneOfThesis {
    /// The corresponding built-in scene.
    pub(super) name: &'static str,
    /// Lights in the tables.
    pub(super) lights: u32,
    /// Light-mesh step h in scene units.
    pub(super) step: f64,
}

/// The scenes of the tables.
pub(super) const SCENES: [SceneOfThesis; 3] = [
    SceneOfThesis { name: "gazebo", lights: 3, step: 2.0 },
    SceneOfThesis { name: "childpark", lights: 2, step: 1.0 },
    SceneOfThesis { name: "garden", lights: 1, step: 0.1 },
];

/// Lights of Garden in the appendix.
pub(super) const GARDEN_LIGHTS: u32 = 3;
/// Pixels along a side.
pub(super) const SIZES: [u32; 2] = [1024, 2048];
/// Interpolation radii R = r/h. Some cells print the larger as 3.2, which would not fit into the thesis' masks of 256 bits.
pub(super) const RADII: [f64; 2] = [2.1, 3.1];
/// Steps as fractions of the scene's.
pub(super) const STEP_PARTS: [f64; 2] = [1.0, 0.5];

/// Seconds per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seconds {
    pub(super) cpu: f64,
    pub(super) gpu: f64,
}

/// Seconds on (CPU, GPU) by scene and size, for (h, R = 2.1), (h, 3.1), (h/2, 2.1), (h/2, 3.1).
const SECONDS: [[[(f64, f64); 4]; 2]; 3] = [
    [
        [(8.46, 0.75), (23.06, 1.77), (9.27, 0.94), (24.28, 1.95)],
        [(33.05, 2.87), (91.06, 6.81), (35.07, 3.12), (94.41, 7.09)],
    ],
    [
        [(9.94, 0.81), (22.65, 1.66), (12.97, 1.80), (26.57, 2.69)],
        [(34.93, 2.52), (82.71, 5.55), (37.38, 3.54), (83.03, 6.59)],
    ],
    [
        [(8.80, 0.63), (25.08, 1.59), (7.63, 0.64), (19.48, 1.45)],
        [(34.20, 2.30), (99.05, 5.69), (28.55, 2.23), (75.29, 5.16)],
    ],
];

/// Seconds per frame in light-mesh mode; `None` if the tables have no such cell.
pub(super) fn seconds(scene: &str, lights: u32, size: u32, step: f64, radius: f64) -> Option<Seconds> {
    let row = SCENES.iter().position(|known| known.name == scene && known.lights == lights)?;
    let column = SIZES.iter().position(|&known| known == size)?;
    let part = STEP_PARTS.iter().position(|part| part * SCENES[row].step == step)?;
    let radius = RADII.iter().position(|&known| known == radius)?;
    let (cpu, gpu) = SECONDS[row][column][RADII.len() * part + radius];
    Some(Seconds { cpu, gpu })
}

/// Table 1, Garden with h = 0.1 and R = 3.1: by size, seconds of the list and mesh steps, and in total.
pub(super) const TABLE_1: [(u32, f64, f64); 2] = [(1024, 0.72, 43.70), (2048, 2.8, 171.76)];

/// Table 2: S_total, the number of light points, by scene and step.
pub(super) const TABLE_2: [(&str, f64, f64); 4] = [
    ("childpark", 1.0, 510_000.0),
    ("childpark", 0.5, 1_574_000.0),
    ("garden", 0.1, 102_000.0),
    ("garden", 0.05, 368_000.0),
];

/// Figure 1: shadow rays per light.
pub(super) const AREA_SAMPLES: [u32; 3] = [225, 1, 5];
/// Figures 1 and 11 to 15: the scene, with its step.
pub(super) const FIGURE_SCENE: SceneOfThesis = SCENES[1];
/// Figure 11: the interpolation radius.
pub(super) const LIGHTS_RADIUS: f64 = 2.0;
/// Figures 12 to 15: interpolation radii.
pub(super) const PICTURE_RADII: [f64; 5] = [1.1, 2.1, 3.1, 4.1, 5.1];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_by_what_was_done() {
        assert_eq!(seconds("gazebo", 3, 1024, 2.0, 2.1), Some(Seconds { cpu: 8.46, gpu: 0.75 }));
        assert_eq!(seconds("childpark", 2, 2048, 1.0, 3.1), Some(Seconds { cpu: 82.71, gpu: 5.55 }));
        assert_eq!(seconds("garden", 1, 1024, 0.05, 3.1), Some(Seconds { cpu: 19.48, gpu: 1.45 }));
        assert_eq!(seconds("garden", 3, 1024, 0.05, 3.1), None);
        assert_eq!(seconds("gazebo", 3, 512, 2.0, 2.1), None);
    }
}
