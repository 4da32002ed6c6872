//! Progress of many things that are done in steps, the first of which take longest.

use std::time::Instant;

use crate::render_context::RenderContext;

/// Progress of work on many things that share what they need: the first ones take longest. It is done [in an order](spread) in which any number of
/// the first ones are a sample of all. The time of n of them is a power of n, whose exponent is that of the latest doubling.
pub(crate) struct Steps<'a> {
    context: &'a RenderContext<'a>,
    /// Pieces of the current stage that it counts as.
    pieces: u64,
    told: u64,
    start: Instant,
    /// How many were done, and the seconds until then.
    marks: Vec<(usize, f64)>,
}

impl<'a> Steps<'a> {
    /// None is done of work that counts as `pieces` pieces.
    pub(crate) fn new(context: &'a RenderContext<'a>, pieces: usize) -> Steps<'a> {
        Steps { context, pieces: pieces as u64, told: 0, start: Instant::now(), marks: Vec::new() }
    }

    /// `done` of `all` are done.
    pub(crate) fn tell(&mut self, done: usize, all: usize) {
        self.marks.push((done, self.start.elapsed().as_secs_f64()));
        let share = if done < all { self.share(done as f64 / all as f64) } else { 1.0 };
        self.tell_share(share);
    }

    /// Everything is done.
    pub(crate) fn end(mut self) {
        self.tell_share(1.0);
    }

    /// The share of the time that has passed when a share of the work is done; nothing before that can be told.
    fn share(&self, done: f64) -> f64 {
        let Some((&(last, now), before)) = self.marks.split_last() else { return 0.0 };
        // The latest mark at which at most half of that was done.
        let half = before.iter().rev().find(|(count, seconds)| 2 * count <= last && *seconds > 0.0);
        half.map_or(0.0, |&(count, seconds)| {
            let exponent = (now / seconds).ln() / (last as f64 / count as f64).ln();
            done.powf(exponent.clamp(0.0, 1.0))
        })
    }

    fn tell_share(&mut self, share: f64) {
        let pieces = (self.pieces as f64 * share) as u64;
        self.context.advance(pieces.saturating_sub(self.told));
        self.told = self.told.max(pieces);
    }
}

/// Numbers below `count` in an order in which any number of the first ones are spread evenly: the van der Corput sequence of base 2.
pub(crate) fn spread(count: usize) -> impl Iterator<Item = usize> {
    let bits = count.next_power_of_two().trailing_zeros();
    let reversed = move |number: usize| if bits == 0 { 0 } else { number.reverse_bits() >> (usize::BITS - bits) };
    (0..1 << bits).map(reversed).filter(move |&number| number < count)
}
