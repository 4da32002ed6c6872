//! Order and progress of work whose parts take different times.
//!
//! Where some parts of a picture take longer than others, they are done in an [order](spread) in which any number of the first ones are a sample of all:
//! so the time that these took tells how long the rest takes.

use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;

use crate::render_context::RenderContext;

/// How many doublings of what is done must be measured to count as much as what is expected.
const TRUSTED_DOUBLINGS: f64 = 2.0;
/// The exponent of the latest steps is measured between so many of them and all.
const LATEST: usize = 4;

/// How much work on many things shares what it needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sharing {
    /// The time of n things of the first part, and of others, is about n to this power.
    exponents: [f64; 2],
    /// What a thing of a later part counts as, if one of the first part counts as one.
    later: f64,
    /// This share of what the first step takes is done once for all.
    once: f64,
}

impl Sharing {
    /// Each takes its own time.
    pub(crate) const NONE: Sharing = Sharing { exponents: [1.0; 2], later: 1.0, once: 0.0 };

    /// The `first` ones of all find nothing yet; each part is a sample of all, or not. Measured with gathered light in seven scenes: the exponents were
    /// .04 to .22, .5 to .7, .15 to .5.
    pub(crate) fn of_parts(first: bool, sampled: bool) -> Sharing {
        let later = if sampled { 0.05 } else { 0.6 };
        match first {
            true => Sharing { exponents: [0.16, 0.3], later, once: 0.8 },
            false => Sharing { exponents: [0.6, 0.3], later, once: 0.0 },
        }
    }
}

/// Progress of work on many things, in parts that are done in steps. The time of n things of a part is a power of n, whose exponent is that of the
/// latest steps.
pub(crate) struct Steps<'a> {
    context: &'a RenderContext<'a>,
    sharing: Sharing,
    /// Pieces of the current stage until the end of each part.
    ends: Vec<u64>,
    part: usize,
    told: u64,
    start: Instant,
    /// How many were done of the part, and the seconds until then.
    marks: Vec<(usize, f64)>,
}

impl<'a> Steps<'a> {
    /// None is done of the parts, whose sizes in pieces of the current stage are given.
    pub(crate) fn new(
        context: &'a RenderContext<'a>,
        sizes: impl Iterator<Item = usize> + Clone,
        sharing: Sharing,
    ) -> Steps<'a> {
        let pieces: usize = sizes.clone().sum();
        let weight = |(part, size): (usize, usize)| size as f64 * if part == 0 { 1.0 } else { sharing.later };
        let whole: f64 = sizes.clone().enumerate().map(weight).sum();
        let mut sum = 0.0;
        let end = |part| {
            sum += weight(part);
            (pieces as f64 * (sum / whole)) as u64
        };
        let ends = sizes.enumerate().map(end).collect();
        Steps { context, sharing, ends, part: 0, told: 0, start: Instant::now(), marks: Vec::new() }
    }

    /// `done` of `all` things of the part are done.
    pub(crate) fn tell(&mut self, done: usize, all: usize) {
        let seconds = self.start.elapsed().as_secs_f64();
        if self.part == 0 && self.marks.is_empty() {
            self.context.work.took_once(self.sharing.once * seconds);
        }
        self.marks.push((done, seconds));
        let share = if done < all { (done as f64 / all as f64).powf(self.exponent()) } else { 1.0 };
        self.tell_share(share);
    }

    /// The part is done.
    pub(crate) fn end_part(&mut self) {
        self.tell_share(1.0);
        (self.part, self.start) = (self.part + 1, Instant::now());
        self.marks.clear();
    }

    /// That by which the time of the part seems to rise: what is expected, and the more what is measured the more there is of it.
    fn exponent(&self) -> f64 {
        let expected = self.sharing.exponents[self.part.min(1)];
        let Some((&(last, now), before)) = self.marks.split_last() else { return expected };
        let latest = before.iter().rev().find(|(count, _)| LATEST * count <= last).or(before.first());
        let Some(&(count, seconds)) = latest.filter(|(_, seconds)| *seconds > 0.0) else { return expected };
        let measured = (now / seconds).ln() / (last as f64 / count as f64).ln();
        let doublings = (last as f64 / before[0].0 as f64).log2();
        ((TRUSTED_DOUBLINGS * expected + doublings * measured) / (TRUSTED_DOUBLINGS + doublings)).clamp(0.0, 1.0)
    }

    fn tell_share(&mut self, share: f64) {
        let Range { start, end } = self.pieces_of_part();
        let exact = start as f64 + (end - start) as f64 * share;
        let pieces = (exact as u64).saturating_sub(self.told);
        self.told += pieces;
        self.context.advance_in_time(pieces, exact / self.ends.last().map_or(1.0, |&all| all.max(1) as f64));
    }

    fn pieces_of_part(&self) -> Range<u64> {
        let end = |part: Option<usize>| part.and_then(|part| self.ends.get(part)).copied();
        let start = end(self.part.checked_sub(1)).unwrap_or(0);
        start..end(Some(self.part)).unwrap_or(start)
    }
}

/// Numbers below `count` in an order in which any number of the first ones are spread evenly: the van der Corput sequence of base 2.
pub(crate) fn spread(count: usize) -> impl Iterator<Item = usize> {
    let bits = count.next_power_of_two().trailing_zeros();
    let reversed = move |number: usize| if bits == 0 { 0 } else { number.reverse_bits() >> (usize::BITS - bits) };
    (0..1 << bits).map(reversed).filter(move |&number| number < count)
}

/// Tasks with their numbers, for all threads, in this order.
pub(crate) fn spread_out<T: Send>(tasks: impl IntoIterator<Item = T>) -> rayon::vec::IntoIter<(usize, T)> {
    let mut tasks: Vec<Option<T>> = tasks.into_iter().map(Some).collect();
    let tasks: Vec<(usize, T)> =
        spread(tasks.len()).filter_map(|number| Some((number, tasks[number].take()?))).collect();
    tasks.into_par_iter()
}
