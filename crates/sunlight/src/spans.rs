//! A few closed intervals of time.

/// At most so many: a plane cuts the sun's way in two places, and where it only touches, the drift adds two.
const MOST: usize = 4;

/// Closed intervals of time that rise and do not touch, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spans {
    count: usize,
    spans: [(f64, f64); MOST],
}

impl Spans {
    /// From `begin` to `end`; none if that is nothing.
    #[inline]
    pub fn one(begin: f64, end: f64) -> Spans {
        let mut one = Spans::default();
        one.push(begin, end);
        one
    }

    /// Adds one after all others, unless it is nothing.
    #[inline]
    pub(crate) fn push(&mut self, begin: f64, end: f64) {
        if self.count < MOST && begin < end {
            self.spans[self.count] = (begin, end);
            self.count += 1;
        }
    }

    /// The intervals.
    #[inline]
    pub fn list(&self) -> &[(f64, f64)] {
        &self.spans[..self.count]
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// What they leave of the time from `begin` to `end`. It shares its ends with them, to the bit.
    #[inline]
    pub(crate) fn complement(&self, begin: f64, end: f64) -> Spans {
        let (mut rest, mut from) = (Spans::default(), begin);
        for &(first, last) in self.list() {
            rest.push(from, first);
            from = last;
        }
        rest.push(from, end);
        rest
    }

    /// What is in both.
    #[inline]
    pub(crate) fn and(&self, other: &Spans) -> Spans {
        let (mut both, mut a, mut b) = (Spans::default(), 0, 0);
        while a < self.count && b < other.count {
            let (own, others) = (self.spans[a], other.spans[b]);
            both.push(own.0.max(others.0), own.1.min(others.1));
            if own.1 < others.1 { a += 1 } else { b += 1 }
        }
        both
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complements_share_their_ends_and_meets_are_in_both() {
        let mut spans = Spans::one(1.0, 2.0);
        spans.push(3.0, 5.0);
        spans.push(5.0, 5.0);
        assert_eq!(spans.complement(0.0, 4.5).list(), [(0.0, 1.0), (2.0, 3.0)]);
        assert_eq!(spans.complement(1.0, 6.0).list(), [(2.0, 3.0), (5.0, 6.0)]);
        assert_eq!(Spans::default().complement(1.0, 2.0).list(), [(1.0, 2.0)]);
        let mut other = Spans::one(0.0, 1.5);
        other.push(4.0, 9.0);
        assert_eq!(spans.and(&other).list(), [(1.0, 1.5), (4.0, 5.0)]);
        assert!(spans.and(&Spans::one(2.0, 3.0)).is_empty());
    }
}
