//! The range of values in a statement.

use super::document::Verdict;

/// Ratios that count as 1.
pub(crate) const EVEN: std::ops::Range<f64> = 0.95..1.05;

/// Minimum and maximum of some values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

/// The verdict on a ratio of times: below 1 wins, above 1 loses, about 1 is open.
pub(crate) fn verdict(ratio: f64) -> Verdict {
    if ratio < EVEN.start {
        Verdict::Wins
    } else if ratio > EVEN.end {
        Verdict::Loses
    } else {
        Verdict::Open
    }
}

impl Spread {
    /// `None` without values.
    pub(crate) fn of(figures: impl Iterator<Item = f64>) -> Option<Spread> {
        figures.fold(None, |spread: Option<Spread>, figure| {
            Some(spread.map_or(Spread { least: figure, most: figure }, |spread| Spread {
                least: spread.least.min(figure),
                most: spread.most.max(figure),
            }))
        })
    }

    /// Both, or one if they are formatted the same.
    pub(crate) fn text(&self, format: impl Fn(f64) -> String) -> String {
        let (least, most) = (format(self.least), format(self.most));
        if least == most { least } else { format!("{least} to {most}") }
    }

    /// The verdict on ratios of times: the common one, or that it depends.
    pub(crate) fn verdict(&self) -> Verdict {
        let (least, most) = (verdict(self.least), verdict(self.most));
        if least == most { least } else { Verdict::Depends }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::numbers;

    #[test]
    fn a_spread_wins_or_loses_as_a_whole_alone() {
        let verdict = |figures: [f64; 2]| Spread::of(figures.into_iter()).unwrap().verdict();
        assert_eq!(verdict([0.5, 0.9]), Verdict::Wins);
        assert_eq!(verdict([0.5, 2.0]), Verdict::Depends);
        assert_eq!(verdict([1.0, 2.0]), Verdict::Depends);
        assert_eq!(verdict([1.0, 1.01]), Verdict::Open);
        assert_eq!(verdict([1.2, 9.0]), Verdict::Loses);
        assert_eq!(Spread::of(std::iter::empty()), None);
    }

    #[test]
    fn a_spread_of_one_is_told_once() {
        let spread = Spread { least: 2.01, most: 2.04 };
        assert_eq!(spread.text(numbers::ratio), "2.0×");
        assert_eq!(Spread { most: 3.0, ..spread }.text(numbers::ratio), "2.0× to 3.0×");
    }
}
