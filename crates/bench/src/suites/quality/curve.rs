//! The cost of an error, interpolated between the measured numbers of samples.

/// Area shadows with some number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// The error, in some measure.
    pub(super) error: f64,
    /// Their cost.
    pub(super) cost: Cost,
}

/// The cost of area shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    /// Shadow rays per pixel and light.
    pub(super) samples: f64,
    /// Shadow rays in total.
    pub(super) rays: f64,
    /// Median seconds of the render.
    pub(super) seconds: f64,
}

/// Where a curve reaches an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reach {
    /// Its first point already has a smaller error: its cost is an upper bound.
    AtMost(Cost),
    /// At this cost, interpolated.
    At(Cost),
    /// No point has an error this small.
    Never,
}

/// The cost of `error` on the curve through `points`, which are ordered by samples: where the curve first falls to the error.
/// Errors and costs are approximately powers of the number of samples, so logarithms are interpolated.
pub(super) fn cost_at(points: &[Point], error: f64) -> Reach {
    let Some(index) = points.iter().position(|point| point.error <= error) else { return Reach::Never };
    if index == 0 {
        return Reach::AtMost(points[0].cost);
    }
    let (before, after) = (points[index - 1], points[index]);
    let place = share(before.error, after.error, error);
    let between = |a: f64, b: f64| log(a).mul_add(1.0 - place, log(b) * place).exp();
    let (a, b) = (before.cost, after.cost);
    Reach::At(Cost {
        samples: between(a.samples, b.samples),
        rays: between(a.rays, b.rays),
        seconds: between(a.seconds, b.seconds),
    })
}

/// The number of samples that take `seconds`, rounded down; at least 1. Beyond the measured numbers, time is proportional to
/// samples.
pub(super) fn samples_in(points: &[Point], seconds: f64) -> u32 {
    let costs = points.iter().map(|point| point.cost);
    let samples = match costs.clone().zip(costs.clone().skip(1)).find(|(_, next)| next.seconds > seconds) {
        Some((a, b)) => {
            let place = share(a.seconds, b.seconds, seconds);
            log(a.samples).mul_add(1.0 - place, log(b.samples) * place).exp()
        }
        None => {
            points.last().map(|point| point.cost).map_or(1.0, |cost| cost.samples * (seconds / cost.seconds).max(1.0))
        }
    };
    (samples as u32).clamp(1, u32::from(u16::MAX))
}

/// The position of `value` between `from` and `to`, by logarithms.
fn share(from: f64, to: f64, value: f64) -> f64 {
    let way = log(to) - log(from);
    if way == 0.0 { 1.0 } else { (log(value) - log(from)) / way }
}

/// Errors may be 0.
fn log(value: f64) -> f64 {
    value.max(f64::MIN_POSITIVE).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors 1/√n; a second and two rays per sample.
    fn curve() -> Vec<Point> {
        let cost = |n: f64| Cost { samples: n, rays: 2.0 * n, seconds: n };
        [1.0, 4.0, 16.0].map(|n: f64| Point { error: 1.0 / n.sqrt(), cost: cost(n) }).to_vec()
    }

    #[test]
    fn powers_are_interpolated_exactly() {
        let Reach::At(cost) = cost_at(&curve(), 1.0 / 8.0_f64.sqrt()) else { panic!("not reached") };
        for (found, expected) in [(cost.samples, 8.0), (cost.rays, 16.0), (cost.seconds, 8.0)] {
            assert!((found - expected).abs() < 1e-9, "{cost:?}");
        }
    }

    #[test]
    fn beyond_its_ends_a_curve_says_so() {
        assert_eq!(cost_at(&curve(), 0.2), Reach::Never);
        assert_eq!(cost_at(&curve(), 2.0), Reach::AtMost(curve()[0].cost));
        assert_eq!(cost_at(&[], 1.0), Reach::Never);
    }

    #[test]
    fn a_curve_that_stands_still_does_not_divide_by_zero() {
        let points = [curve()[0], Point { error: 0.0, ..curve()[1] }];
        assert!(matches!(cost_at(&points, 0.0), Reach::At(cost) if (cost.seconds - 4.0).abs() < 1e-9));
    }

    #[test]
    fn equal_times_give_samples() {
        assert_eq!(
            [0.1, 1.0, 2.1, 15.0, 16.0, 64.0].map(|seconds| samples_in(&curve(), seconds)),
            [1, 1, 2, 15, 16, 64]
        );
    }
}
