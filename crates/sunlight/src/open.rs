//! What is still open of a receiver's day, and who has taken the rest.

use crate::spans::Spans;

/// Of several objects.
pub const MANY: u32 = u32::MAX;

/// Shorter pieces vanish, in seconds: less than ends are exact to.
const TINY: f64 = 1e-3;

/// Time that is taken by an object, or by several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken {
    /// From when on.
    pub begin: f64,
    /// Until when.
    pub end: f64,
    /// By what; [`MANY`]: by more than one.
    pub object: u32,
}

/// The open times of a receiver, from which intervals are taken.
#[derive(Clone, Debug, Default)]
pub struct Open {
    open: Vec<(f64, f64)>,
    /// Times that one object alone takes, if that is asked for, in their order.
    alone: Vec<Taken>,
    attributes: bool,
    spare: Vec<Taken>,
}

impl Open {
    /// All of these times; `attributes`: whether to know who takes them.
    pub fn begin(&mut self, times: &Spans, attributes: bool) {
        self.attributes = attributes;
        self.open.clear();
        self.alone.clear();
        self.open.extend(times.list());
    }

    /// The spells: what nothing has taken.
    pub fn spells(&self) -> &[(f64, f64)] {
        &self.open
    }

    /// What one object alone has taken.
    pub fn alone(&self) -> &[Taken] {
        &self.alone
    }

    /// Whether nothing can be taken any more.
    #[inline]
    pub(crate) fn is_done(&self) -> bool {
        self.open.is_empty() && self.alone.is_empty()
    }

    /// Whether something of an object could take time within one of these bounds.
    #[inline]
    pub(crate) fn touches(&self, bounds: &[(f32, f32); 2], object: u32) -> bool {
        let meets = |begin: f64, end: f64| {
            let (begin, end) = (begin as f32, end as f32);
            bounds.iter().any(|&(first, last)| first <= end && last >= begin)
        };
        self.open.iter().any(|&(begin, end)| meets(begin, end))
            || self
                .alone
                .iter()
                .any(|taken| (taken.object != object || object == MANY) && meets(taken.begin, taken.end))
    }

    /// From the first to the last moment that can be taken.
    #[inline]
    pub(crate) fn hull(&self) -> (f64, f64) {
        let open = self.open.first().zip(self.open.last()).map(|(first, last)| (first.0, last.1));
        let alone = self.alone.first().zip(self.alone.last()).map(|(first, last)| (first.begin, last.end));
        let hull = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        match (open, alone) {
            (Some(open), Some(alone)) => hull(open, alone),
            (one, other) => one.or(other).unwrap_or((f64::INFINITY, f64::NEG_INFINITY)),
        }
    }

    /// An object hides the sun at these times.
    pub(crate) fn take(&mut self, times: &Spans, object: u32) {
        for &(begin, end) in times.list() {
            if self.attributes {
                self.take_from_others(begin, end, object);
            }
            self.take_from_open(begin, end, object);
        }
        if self.attributes {
            self.join();
        }
    }

    /// What another object alone had taken is taken by several.
    fn take_from_others(&mut self, begin: f64, end: f64, object: u32) {
        let is_cut = |taken: &Taken| taken.object != object && taken.begin < end && taken.end > begin;
        if !self.alone.iter().any(is_cut) {
            return;
        }
        self.spare.clear();
        for &taken in &self.alone {
            if !is_cut(&taken) {
                self.spare.push(taken);
                continue;
            }
            if begin - taken.begin > TINY {
                self.spare.push(Taken { end: begin, ..taken });
            }
            if taken.end - end > TINY {
                self.spare.push(Taken { begin: end, ..taken });
            }
        }
        std::mem::swap(&mut self.alone, &mut self.spare);
    }

    fn take_from_open(&mut self, begin: f64, end: f64, object: u32) {
        let mut at = 0;
        while at < self.open.len() {
            let (first, last) = self.open[at];
            if last <= begin {
                at += 1;
                continue;
            }
            if first >= end {
                break;
            }
            if self.attributes {
                self.alone.push(Taken { begin: first.max(begin), end: last.min(end), object });
            }
            let (before, after) = ((first, begin), (end, last));
            match [before, after].map(|(begin, end)| end - begin > TINY) {
                [true, true] => {
                    self.open[at] = before;
                    self.open.insert(at + 1, after);
                    at += 2;
                }
                [true, false] => {
                    self.open[at] = before;
                    at += 1;
                }
                [false, true] => {
                    self.open[at] = after;
                    at += 1;
                }
                [false, false] => {
                    self.open.remove(at);
                }
            }
        }
    }

    /// Joins what the same object has taken without a gap.
    fn join(&mut self) {
        self.alone.sort_unstable_by(|a, b| a.begin.total_cmp(&b.begin).then(a.object.cmp(&b.object)));
        self.spare.clear();
        for &taken in &self.alone {
            match self.spare.last_mut() {
                Some(last) if last.object == taken.object && taken.begin - last.end <= TINY => {
                    last.end = last.end.max(taken.end);
                }
                _ => self.spare.push(taken),
            }
        }
        std::mem::swap(&mut self.alone, &mut self.spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_two_objects_take_is_neithers() {
        let mut open = Open::default();
        open.begin(&Spans::one(0.0, 10.0), true);
        open.take(&Spans::one(2.0, 5.0), 1);
        open.take(&Spans::one(4.0, 7.0), 2);
        open.take(&Spans::one(5.0, 6.0), 2);
        assert_eq!(open.spells(), [(0.0, 2.0), (7.0, 10.0)]);
        let taken = |begin, end, object| Taken { begin, end, object };
        assert_eq!(open.alone(), [taken(2.0, 4.0, 1), taken(5.0, 7.0, 2)]);
        assert!(open.touches(&[(4.5, 4.6), (9.0, 9.5)], 1) && !open.touches(&[(4.5, 4.6), (4.2, 4.4)], 3));
        assert!(open.touches(&[(5.5, 5.6); 2], 1) && !open.touches(&[(5.5, 5.6); 2], 2));
        open.take(&Spans::one(-1.0, 11.0), 3);
        assert!(open.is_done() == open.alone().is_empty() && open.spells().is_empty());
        assert_eq!(open.alone(), [taken(0.0, 2.0, 3), taken(7.0, 10.0, 3)]);
    }
}
