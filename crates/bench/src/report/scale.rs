//! An axis, linear or logarithmic, with ticks at round numbers.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use super::numbers;

/// Maximum number of ticks at multiples of powers of ten on a logarithmic axis; beyond it, only powers have one.
const DECADES_WITH_MULTIPLES: f64 = 2.5;
/// Desired number of ticks on a linear axis.
const TICKS: f64 = 6.0;

/// An axis from a low to a high value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    low: f64,
    high: f64,
    log: bool,
}

impl Scale {
    /// An axis that shows all values, which must be above 0 if it is logarithmic; `None` if there are none. A linear axis begins
    /// at 0 unless values are negative, so that lengths can be compared.
    pub(crate) fn over(values: impl Iterator<Item = f64> + Clone, log: bool) -> Option<Scale> {
        let low = values.clone().min_by(f64::total_cmp)?;
        let high = values.max_by(f64::total_cmp)?;
        Some(if log {
            // A small margin, and never an empty axis.
            Scale { low: low / 1.15, high: high * 1.15, log }
        } else {
            let low = low.min(0.0);
            Scale { low, high: if high > low { high + 0.04 * (high - low) } else { low + 1.0 }, log }
        })
    }

    pub(crate) fn low(&self) -> f64 {
        self.low
    }

    pub(crate) fn high(&self) -> f64 {
        self.high
    }

    fn ticks(&self) -> Vec<f64> {
        let inside = |value: &f64| (self.low..=self.high).contains(value);
        if self.log {
            let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
            let multiples: &[f64] =
                if (self.high / self.low).log10() < DECADES_WITH_MULTIPLES { &[1.0, 2.0, 5.0] } else { &[1.0] };
            let all = (first..=last).flat_map(|power| multiples.iter().map(move |factor| factor * 10_f64.powi(power)));
            return all.filter(inside).collect();
        }
        let step = round_step((self.high - self.low) / TICKS);
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        (first..=last).map(|index| index as f64 * step).collect()
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|&round| round >= step).unwrap_or(step)
}

impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let place = |value: f64| if self.log { value.ln() } else { value };
        let share = (place(*value) - place(self.low)) / (place(self.high) - place(self.low));
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Scale {
    fn format_ext(&self, value: &f64) -> String {
        let text = numbers::significant(*value, 3);
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_axis() {
        let texts = |scale: Scale| scale.ticks().iter().map(|tick| scale.format_ext(tick)).collect::<Vec<_>>();
        assert_eq!(texts(Scale::over([3.0, 97.0].into_iter(), false).unwrap()), ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(texts(Scale::over([0.3, 40.0].into_iter(), true).unwrap()), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(texts(Scale::over([0.3, 4000.0].into_iter(), true).unwrap()), ["1", "10", "100", "1000"]);
        assert_eq!(texts(Scale::over([0.0].into_iter(), false).unwrap()).len(), 6);
    }
}
