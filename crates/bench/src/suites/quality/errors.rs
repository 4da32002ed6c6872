//! The reference, and errors relative to it.

use std::time::{Duration, Instant};

use lightmesh::image::{self, CompareError, compare};
use lightmesh::render::PreparedScene;
use lightmesh::{Mode, Observer, Settings};

use crate::engine::Engine;
use crate::measure::Silent;
use crate::{BenchError, Plan, Row};

/// Shadow rays per light of the reference, and in the short version.
const SAMPLES: [u32; 2] = [1024, 256];
/// With fewer, it is not a reference for 64.
const FEWEST: u32 = 128;
/// Shadow rays of the trial that estimates the time of the reference.
const TRIAL: u32 = 4;
/// Share of the time available for two references.
const SHARE: f64 = 0.4;
/// Different from seed 0, which all measurements use.
const SEEDS: [u64; 2] = [1, 2];

/// Errors of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Errors {
    /// RMSE of visibility over all surface points and lights.
    pub(super) visibility_rmse: f64,
    /// RMSE of display values over all pixels and channels.
    pub(super) rmse: f64,
    /// Mean FLIP.
    pub(super) mean_flip: f64,
}

/// Area shadows with enough samples to count as converged.
pub(super) struct Reference {
    /// The image, with layers.
    pub(super) frame: image::Frame,
    /// Shadow rays per pixel and light.
    pub(super) samples: u32,
    /// Its own errors, estimated with another seed.
    pub(super) residue: Errors,
    wanted: u32,
}

impl Reference {
    /// Renders it twice, with different seeds, and with fewer samples if `share` is too short.
    pub(super) fn converge(
        plan: &Plan,
        engine: &Engine,
        scene: &PreparedScene,
        side: u32,
        share: Duration,
        observer: &dyn Observer,
    ) -> Result<Reference, BenchError> {
        let render = |samples, seed| {
            let settings = Settings::default()
                .with_aa(1)
                .with_mode(Mode::Area)
                .with_size([side; 2])
                .with_samples(samples)
                .with_seed(seed)
                .with_layers(true);
            engine.renderer.render_prepared(scene, &settings, &Silent(observer)).map(|frame| frame.image)
        };
        render(TRIAL, SEEDS[0])?;
        let begin = Instant::now();
        render(TRIAL, SEEDS[0])?;
        let both_by_sample = 2.0 * begin.elapsed().as_secs_f64() / f64::from(TRIAL);
        let wanted = SAMPLES[usize::from(plan.quick)];
        let mut samples = wanted;
        while samples > FEWEST && f64::from(samples) * both_by_sample > SHARE * share.as_secs_f64() {
            samples /= 2;
        }
        let (frame, other) = (render(samples, SEEDS[0])?, render(samples, SEEDS[1])?);
        let apart = Errors::between(&frame, &other)?;
        // The errors of both are of equal size and independent: squared errors of visibility add up.
        let residue = Errors {
            visibility_rmse: apart.visibility_rmse / f64::sqrt(2.0),
            rmse: apart.rmse / f64::sqrt(2.0),
            mean_flip: apart.mean_flip,
        };
        Ok(Reference { frame, samples, residue, wanted })
    }

    /// A note if time was short.
    pub(super) fn note(&self, scene: &str) -> Option<String> {
        (self.samples < self.wanted).then(|| {
            let (samples, wanted) = (self.samples, self.wanted);
            format!("The time budget limited the reference of {scene} to {samples} instead of {wanted} samples.")
        })
    }
}

impl Errors {
    /// Errors of `test`; both have layers.
    pub(super) fn between(reference: &image::Frame, test: &image::Frame) -> Result<Errors, CompareError> {
        let comparison = compare(reference, test)?;
        Ok(Errors {
            visibility_rmse: visibility_rmse(reference, test),
            rmse: comparison.rmse,
            mean_flip: comparison.mean_flip,
        })
    }

    /// Adds them to a row.
    pub(super) fn fill(&self, row: &mut Row) {
        let figures = [("visibility_rmse", self.visibility_rmse), ("rmse", self.rmse), ("mean_flip", self.mean_flip)];
        row.values.extend(figures.map(|(name, figure)| (name.to_owned(), figure)));
    }
}

/// 0 if there is no surface point or light.
pub(in crate::suites) fn visibility_rmse(reference: &image::Frame, test: &image::Frame) -> f64 {
    let (Some(reference), Some(test)) = (reference.layers(), test.layers()) else { return 0.0 };
    let (mut sum, mut count) = (0.0, 0_usize);
    for (reference_plane, test_plane) in reference.visibility.iter().zip(&test.visibility) {
        for ((a, b), depth) in reference_plane.iter().zip(test_plane).zip(&reference.depth) {
            if depth.is_finite() {
                sum += f64::from(a - b).powi(2);
                count += 1;
            }
        }
    }
    (sum / count.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use lightmesh::image::{Frame, Layers};

    use super::*;

    fn frame(visibility: [f32; 4]) -> Frame {
        let layers = Layers {
            depth: vec![1.0, 1.0, f32::INFINITY, 1.0],
            normal: vec![[0.0; 3]; 4],
            position: vec![[0.0; 3]; 4],
            visibility: vec![visibility.to_vec()],
            used: vec![0; 4],
            ..Layers::default()
        };
        Frame::new(2, 2, vec![[0.5; 3]; 4]).unwrap().with_layers(layers).unwrap()
    }

    #[test]
    fn errors_of_visibility_are_of_surface_points_alone() {
        let errors = Errors::between(&frame([1.0, 1.0, 0.0, 0.0]), &frame([1.0, 0.5, 1.0, 0.5])).unwrap();
        assert!((errors.visibility_rmse - (0.5_f64 / 3.0).sqrt()).abs() < 1e-12, "{errors:?}");
        assert_eq!((errors.rmse, errors.mean_flip), (0.0, 0.0));
    }
}
