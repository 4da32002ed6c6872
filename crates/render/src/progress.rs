//! Progress over all stages of an image: the share of its time that has passed.
//!
//! What an image costs is not known before it is rendered: how many fragments and mirror rays there will be turns out on the way, and a ray that
//! gathers light takes thousands of times as long as one that does not. So work is counted by stage, in pieces that are known or
//! [guessed](Work::replace), and time is measured by stage:
//!
//! ```text
//! left = Σ_s (expected_s − done_s) · seconds_s / done_s
//! ```
//!
//! A stage that has not run yet takes as long as [`cost`] says, by the measure of those that have: a guess, and while that is most of what is left, little
//! is told to be done; then as much as is known. What a stage did once, for all that it does later, is not counted again. The share that is done rises
//! from one report to the next by the time between them, as a part of this time and what is left: so it never falls, and estimates that were wrong do
//! little harm.

use std::iter::Sum;
use std::ops::{AddAssign, SubAssign};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use crate::observer::{Observer, Progress};
use crate::stage::Stage;

/// Minimum time between two progress reports on the whole image, seconds.
const INTERVAL: f64 = 0.05;
/// The share of a stage that must be done before its time says something.
const TELLING: f64 = 0.02;

/// The share that is told at most while more than half of what is left is a guess.
const GUESSED: f64 = 0.29;

/// Microseconds for which [`cost`] is trusted as much as what is measured.
const TRUSTED: f64 = 2e5;

/// Microseconds that a piece of a stage takes on two threads of a CPU, more or less: what is expected before anything is measured.
fn cost(stage: Stage) -> f64 {
    match stage {
        Stage::Gather => 500.0,
        Stage::AreaShadows | Stage::ShadowRays => 10.0,
        Stage::AdaptiveShadows | Stage::Transmittance => 2.0,
        Stage::OccluderLists | Stage::ShortTests => 0.4,
        Stage::CameraRays => 0.06,
        _ => 0.15,
    }
}

/// Pieces of work by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pieces([f64; Stage::ALL.len()]);

impl Pieces {
    /// Those of one stage.
    pub fn of(stage: Stage, pieces: f64) -> Pieces {
        Pieces::default().and(stage, pieces)
    }

    /// With those of a stage.
    pub fn and(mut self, stage: Stage, pieces: f64) -> Pieces {
        self.0[stage as usize] += pieces;
        self
    }

    fn stage(&self, stage: Stage) -> f64 {
        self.0[stage as usize]
    }
}

impl AddAssign for Pieces {
    fn add_assign(&mut self, other: Pieces) {
        self.0.iter_mut().zip(other.0).for_each(|(pieces, more)| *pieces += more);
    }
}

impl Sum for Pieces {
    fn sum<I: Iterator<Item = Pieces>>(pieces: I) -> Pieces {
        pieces.fold(Pieces::default(), |mut sum, pieces| {
            sum += pieces;
            sum
        })
    }
}

impl SubAssign for Pieces {
    fn sub_assign(&mut self, other: Pieces) {
        self.0.iter_mut().zip(other.0).for_each(|(pieces, less)| *pieces -= less);
    }
}

/// The work of an image.
///
/// A wave of n rays counts as n pieces in each of its stages.
#[derive(Debug)]
pub struct Work {
    start: Instant,
    state: Mutex<State>,
    /// Milliseconds between the start and the latest progress report on the whole image.
    reported: AtomicU64,
    /// Held by the thread that tells of it: others would tell their news late.
    telling: Mutex<()>,
}

/// What is known of it.
#[derive(Debug)]
struct State {
    counted: Counted,
    /// By stage, the seconds that what is done took.
    seconds: Pieces,
    /// How many of them were taken once, for all that is done later, too.
    once: Pieces,
    /// The stage in progress.
    current: Option<Current>,
    /// The share of the image that was done before the part in progress, and is after it.
    part: [f64; 2],
    /// The share that was told, and when: seconds after the start.
    told: (f64, f64),
    /// Whether most of what was left then was a guess.
    guesses: bool,
}

/// Work that is expected, and done.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counted {
    expected: Pieces,
    done: Pieces,
}

/// A stage in progress.
#[derive(Clone, Copy, Debug)]
struct Current {
    stage: Stage,
    start: Instant,
    /// Its own pieces.
    total: u64,
    done: u64,
    /// The share of its time that has passed, where that is not the share of pieces.
    share: Option<f64>,
    /// Seconds after its start when the latest of them was done.
    when: f64,
    /// Pieces of the image that it counts as.
    pieces: f64,
}

impl Default for Work {
    fn default() -> Work {
        Work::new()
    }
}

impl Work {
    /// Nothing is expected yet.
    pub fn new() -> Work {
        let state = State {
            counted: Counted::default(),
            seconds: Pieces::default(),
            once: Pieces::default(),
            current: None,
            part: [0.0, 1.0],
            told: (0.0, 0.0),
            guesses: false,
        };
        Work { start: Instant::now(), state: Mutex::new(state), reported: AtomicU64::new(0), telling: Mutex::new(()) }
    }

    /// Adds pieces to the image's total.
    pub fn expect(&self, pieces: Pieces) {
        self.state().counted.expected += pieces;
    }

    /// Something better is known than `guess`, which was expected.
    pub fn replace(&self, guess: &mut Pieces, better: Pieces) {
        let mut state = self.state();
        state.counted.expected -= std::mem::replace(guess, better);
        state.counted.expected += better;
    }

    /// A part begins that is the share of the image from `before` to `after`: what is expected from now on is its own, and other parts of the same
    /// size take as long.
    pub fn begin_part(&self, part: [f64; 2]) {
        let mut state = self.state();
        state.part = part;
        state.counted.expected = state.counted.done;
    }

    /// What is counted, for [`rewind`](Work::rewind).
    pub(crate) fn counted(&self) -> Counted {
        self.state().counted
    }

    /// Work that was done since then will be repeated.
    pub(crate) fn rewind(&self, counted: Counted) {
        self.state().counted = counted;
    }

    /// Whether all is done that is expected.
    pub fn is_done(&self) -> bool {
        let Counted { expected, done } = self.state().counted;
        expected == done
    }

    /// A stage begins that has `total` pieces of its own and counts as `pieces` pieces of the image.
    pub fn begin(&self, observer: &dyn Observer, stage: Stage, total: u64, pieces: f64) {
        self.state().current =
            Some(Current { stage, start: Instant::now(), total, done: 0, share: None, when: 0.0, pieces });
        observer.begin(stage, total);
    }

    /// Some pieces of the current stage are done.
    pub(crate) fn advance(&self, observer: &dyn Observer, pieces: u64) {
        if let Some(current) = &mut self.state().current {
            current.done += pieces;
            if pieces > 0 {
                current.when = current.start.elapsed().as_secs_f64();
            }
            debug_assert!(current.done <= current.total, "{:?}: {} of {}", current.stage, current.done, current.total);
        }
        observer.advance(pieces);
        self.report(observer, false);
    }

    /// Some pieces of the current stage are done, and this share of its time has passed. Unlike pieces, it may fall.
    pub(crate) fn advance_in_time(&self, observer: &dyn Observer, pieces: u64, share: f64) {
        if let Some(current) = &mut self.state().current {
            (current.share, current.when) = (Some(share), current.start.elapsed().as_secs_f64());
        }
        self.advance(observer, pieces);
    }

    /// The current stage has taken so many seconds for what all that is done later shares.
    pub(crate) fn took_once(&self, seconds: f64) {
        let mut state = self.state();
        if let Some(current) = state.current {
            state.once += Pieces::of(current.stage, seconds);
        }
    }

    /// The stage has ended. Pieces that it did not report are done as well.
    pub fn end(&self, observer: &dyn Observer, stage: Stage) {
        let rest = self.state().current.map_or(0, |current| current.total - current.done);
        if rest > 0 {
            observer.advance(rest);
        }
        let mut state = self.state();
        if let Some(current) = state.current.take() {
            state.counted.done += Pieces::of(stage, current.pieces);
            state.seconds += Pieces::of(stage, current.start.elapsed().as_secs_f64());
        }
        drop(state);
        self.report(observer, true);
        observer.end(stage);
    }

    /// The image is finished.
    pub(crate) fn finish(&self, observer: &dyn Observer) {
        observer.progress(Progress { done: 1.0, seconds: self.start.elapsed().as_secs_f64(), left: Some(0.0) });
    }

    fn report(&self, observer: &dyn Observer, always: bool) {
        let seconds = self.start.elapsed().as_secs_f64();
        let (now, last) = ((1e3 * seconds) as u64, self.reported.load(Ordering::Relaxed));
        if !always && ((now - last.min(now)) as f64) < 1e3 * INTERVAL {
            return;
        }
        let _telling = match (self.telling.try_lock(), always) {
            (Ok(telling), _) => telling,
            (Err(_), true) => self.telling.lock().unwrap_or_else(PoisonError::into_inner),
            (Err(_), false) => return,
        };
        self.reported.store(now, Ordering::Relaxed);
        let seconds = self.start.elapsed().as_secs_f64();
        let mut state = self.state();
        let Some([left, guessed]) = state.left(seconds) else { return };
        let (told, when) = state.told;
        let passed = (seconds - when).max(f64::MIN_POSITIVE);
        let risen = told + (1.0 - told) * passed / (passed + left);
        let (did_guess, guesses) = (state.guesses, guessed > 0.5 * left);
        let done = match (did_guess, guesses) {
            (_, true) => risen.min(GUESSED.max(told)),
            (true, false) => told.max(seconds / (seconds + left)),
            (false, false) => risen,
        };
        (state.told, state.guesses) = ((done, seconds), guesses);
        drop(state);
        observer.progress(Progress { done, seconds, left: Some(left) });
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// About how many seconds the rest takes, `seconds` after the start, and how many of them are a guess; `None` before anything is known.
    fn left(&self, seconds: f64) -> Option<[f64; 2]> {
        let Counted { expected, done } = &self.counted;
        if *expected == Pieces::default() {
            return None;
        }
        let speed = self.speed();
        let (mut left, mut guessed) = (0.0, 0.0);
        for &stage in &Stage::ALL {
            let is_measured = done.stage(stage) > 0.0;
            let mut rate =
                if is_measured { self.repeated(stage, 0.0) / done.stage(stage) } else { speed * cost(stage) };
            let (mut pieces, mut is_guess, mut own) = (expected.stage(stage) - done.stage(stage), !is_measured, 0.0);
            if let Some(current) = self.current.filter(|current| current.stage == stage) {
                pieces -= current.pieces;
                let (elapsed, share) = (current.start.elapsed().as_secs_f64(), current.share());
                if share >= TELLING {
                    let whole = current.when / share;
                    rate = self.repeated(stage, whole) / (done.stage(stage) + current.pieces).max(1.0);
                    own = (whole - elapsed).max(0.25 * (elapsed - current.when));
                    is_guess = false;
                } else if current.pieces > 0.0 {
                    // It has taken longer than it was thought to in all: then for half as long again.
                    own = (rate * current.pieces - elapsed).max(0.5 * elapsed);
                }
            }
            let stage_left = own + rate * pieces.max(0.0);
            left += stage_left;
            guessed += if is_guess { stage_left } else { 0.0 };
        }
        let [_, after] = self.part;
        left.is_finite().then(|| [(seconds + left) / after - seconds, guessed])
    }

    /// The seconds that a stage took, and `more`, but for what it did once.
    fn repeated(&self, stage: Stage, more: f64) -> f64 {
        (self.seconds.stage(stage) + more - self.once.stage(stage)).max(0.0)
    }

    /// Seconds in which this machine does what [`cost`] calls a microsecond. What gathers light says nothing of others.
    fn speed(&self) -> f64 {
        let (mut spent, mut costs) = (0.0, 0.0);
        for &stage in Stage::ALL.iter().filter(|&&stage| stage != Stage::Gather) {
            spent += self.seconds.stage(stage);
            costs += cost(stage) * self.counted.done.stage(stage);
        }
        1e-6 * (1e6 * spent + TRUSTED) / (costs + TRUSTED)
    }
}

impl Current {
    /// The share that is done.
    fn share(&self) -> f64 {
        self.share.unwrap_or(self.done as f64 / self.total.max(1) as f64)
    }
}
