//! Timing of many images within a share of the time.
//!
//! 1. Each image is rendered once, most important first, until the share is used up; later ones are dropped.
//! 2. All of them are rendered again alternately, as often as fits into the remaining time. The first round then counts as warm-up.
//!
//! This needs no estimates; a share is exceeded by at most one image.

use std::time::{Duration, Instant};

use lightmesh::{Observer, RenderError};

use crate::measure::{Measured, Rounds, Variant, measure};

/// The measured variants.
pub(super) struct Turns {
    /// The measurements of the variants, from the first.
    pub(super) measured: Vec<Measured>,
    /// Variants that were dropped for lack of time.
    pub(super) left_out: usize,
    /// Repetitions of the others.
    pub(super) repetitions: usize,
    /// Whether there was an uncounted first round.
    pub(super) warm_up: bool,
}

impl Turns {
    /// Measures `variants` up to `repetitions` times within `share`, and at least the first one.
    ///
    /// # Errors
    /// As [`Renderer::render_prepared`](lightmesh::Renderer::render_prepared).
    pub(super) fn take(
        variants: &[Variant],
        repetitions: usize,
        share: Duration,
        observer: &dyn Observer,
    ) -> Result<Turns, RenderError> {
        let begin = Instant::now();
        let once = Rounds { warm_up: false, repetitions: 1 };
        let mut measured = Vec::with_capacity(variants.len());
        for variant in variants {
            if !measured.is_empty() && begin.elapsed() >= share {
                break;
            }
            measured.extend(measure(std::slice::from_ref(variant), once, observer)?);
        }
        let round = begin.elapsed().as_secs_f64();
        let fitting = (share.saturating_sub(begin.elapsed()).as_secs_f64() / round) as usize;
        let (left_out, warm_up) = (variants.len() - measured.len(), fitting > 0);
        let repetitions = repetitions.min(fitting).max(1);
        if warm_up {
            let rounds = Rounds { warm_up: false, repetitions };
            measured = measure(&variants[..measured.len()], rounds, observer)?;
        }
        Ok(Turns { measured, left_out, repetitions, warm_up })
    }

    /// Notes if time was short.
    pub(super) fn notes(&self, what: &str, wanted: usize) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.warm_up {
            notes.push(format!("Because of the time budget {what} was measured only once, without warm-up."));
        } else if self.repetitions < wanted {
            notes.push(format!(
                "Because of the time budget {what} was measured {} times instead of {wanted}.",
                self.repetitions
            ));
        }
        if self.left_out > 0 {
            notes.push(format!("Because of the time budget {} rows of {what} were dropped.", self.left_out));
        }
        notes
    }
}

#[cfg(test)]
mod tests {
    use lightmesh::render::Unobserved;
    use lightmesh::{Device, Renderer, Scene, Settings};

    use super::*;

    #[test]
    fn without_time_the_first_picture_is_made_once_and_with_time_all_are_repeated() {
        let (scene, renderer) = (Scene::open("builtin:gazebo").unwrap(), Renderer::new(Device::Cpu).unwrap());
        let settings = Settings::default().with_size([8, 8]);
        let prepared = renderer.prepare(&scene, &settings, &Unobserved).unwrap();
        let variant = || Variant { renderer: &renderer, scene: &prepared, settings: settings.clone() };
        let variants = [variant(), variant()];

        let short = Turns::take(&variants, 3, Duration::ZERO, &Unobserved).unwrap();
        assert_eq!((short.measured.len(), short.left_out, short.repetitions, short.warm_up), (1, 1, 1, false));
        assert_eq!(short.notes("gazebo", 3).len(), 2);

        let long = Turns::take(&variants, 3, Duration::from_secs(600), &Unobserved).unwrap();
        assert_eq!((long.measured.len(), long.left_out, long.repetitions, long.warm_up), (2, 0, 3, true));
        assert!(long.measured.iter().all(|measured| measured.seconds["render"].0.len() == 3));
        assert!(long.notes("gazebo", 3).is_empty());
    }
}
