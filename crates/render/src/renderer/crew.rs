//! Work that several devices share: each takes the next part of it when it is free, until none is left. The part of a device that fails goes to the
//! others.

use std::collections::HashSet;
use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread::{self, ScopedJoinHandle};
use std::time::Instant;

use super::worker::Worker;
use crate::observer::{Observer, Progress};
use crate::settings::Setting;
use crate::sync::locked;

/// Work that is taken in parts.
pub trait Work: Send {
    /// Some of it.
    type Part: Clone + Send;

    /// The next part for a worker, first of all one that was given back; `None` if it takes none now.
    fn take(&mut self, worker: usize, team: &Team) -> Option<Self::Part>;

    /// A worker could not do its part.
    fn give_back(&mut self, part: Self::Part);

    /// Whether all parts are taken.
    fn is_taken(&self) -> bool;

    /// How much there is to do, in the unit of [`Work::size`].
    fn whole(&self) -> f64;

    /// How much there is to do in a part.
    fn size(part: &Self::Part) -> f64;

    /// What messages call a part: "12 rows".
    fn name(part: &Self::Part) -> String;
}

/// Why a worker could not do its part.
pub trait Failure: Display + Send {
    /// Whether another one may be able to.
    fn is_of_device(&self) -> bool;

    /// Whether it was asked to stop.
    fn is_cancelled(&self) -> bool;
}

/// Workers that do some work together.
pub struct Crew<'a, W: Work, E> {
    start: Instant,
    state: Mutex<State<W, E>>,
    changed: Condvar,
    stopped: AtomicBool,
    observer: &'a dyn Observer,
}

struct State<W, E> {
    work: W,
    team: Team,
    /// Parts that are being done.
    running: usize,
    /// What ends the work.
    error: Option<E>,
    /// What the last worker failed by whose part others took.
    of_device: Option<E>,
    /// How many workers have ended.
    ended: usize,
    /// What was told.
    texts: HashSet<String>,
    /// The share that was told.
    told: f64,
}

/// What is known of the workers.
pub struct Team(Vec<Known>);

/// What is known of a worker. Speeds are those of [`Work::size`] per second.
#[derive(Clone, Copy, Default)]
struct Known {
    /// In earlier work.
    before: Option<f64>,
    done: f64,
    seconds: f64,
    /// How much is done of the part in progress.
    current: f64,
    /// Whether it takes no more parts.
    failed: bool,
}

impl Known {
    fn speed(&self) -> Option<f64> {
        if self.seconds > 0.0 { Some(self.done / self.seconds) } else { self.before }
    }
}

impl Team {
    /// How fast a worker is, if it is known.
    pub fn speed(&self, worker: usize) -> Option<f64> {
        self.0[worker].speed()
    }

    /// What a worker would do of what is `left` if all went on as they did.
    pub fn share(&self, worker: usize, speed: f64, left: f64) -> f64 {
        left * speed / (speed + self.others(worker, speed).sum::<f64>())
    }

    /// Whether a worker would still be at a part when others have done all that is `left`. The fastest of all never is, so that somebody goes on.
    pub fn is_late(&self, worker: usize, speed: f64, part: f64, left: f64) -> bool {
        let fastest = self.others(worker, speed).fold(0.0, f64::max);
        let all: f64 = self.others(worker, speed).sum();
        part / speed > (left / all).max(part / fastest)
    }

    /// The speeds of others that work. Of those whose speed is not known, it is taken to be the same.
    fn others(&self, worker: usize, speed: f64) -> impl Iterator<Item = f64> {
        let others = self.0.iter().enumerate().filter(move |(number, known)| *number != worker && !known.failed);
        others.map(move |(_, known)| known.speed().unwrap_or(speed))
    }

    /// Whether a worker has done anything.
    pub fn has_worked(&self, worker: usize) -> bool {
        self.0[worker].seconds > 0.0
    }

    /// How fast each is, if it is known.
    pub fn speeds(&self) -> impl Iterator<Item = Option<f64>> {
        self.0.iter().map(Known::speed)
    }
}

impl<W: Work, E> State<W, E> {
    fn is_over(&self, cancelled: bool) -> bool {
        self.ended == self.team.0.len() || self.running == 0 && (cancelled || self.work.is_taken())
    }
}

impl<'a, W: Work, E: Failure> Crew<'a, W, E> {
    /// Workers whose speeds may be known from earlier work.
    pub fn new(work: W, speeds: impl Iterator<Item = Option<f64>>, observer: &'a dyn Observer) -> Crew<'a, W, E> {
        let team = Team(speeds.map(|before| Known { before, ..Known::default() }).collect());
        let state =
            State { work, team, running: 0, error: None, of_device: None, ended: 0, texts: HashSet::new(), told: 0.0 };
        let (changed, stopped) = (Condvar::new(), AtomicBool::new(false));
        Crew { start: Instant::now(), state: Mutex::new(state), changed, stopped, observer }
    }

    /// Has each worker do `each` with something of its own, on threads of their own, and does something else `meanwhile`. Returns what they return.
    pub fn run<T: Send, U: Send, R>(
        &self,
        workers: &[&dyn Worker],
        own: Vec<T>,
        each: impl Fn(usize, &dyn Worker, T) -> U + Sync,
        meanwhile: impl FnOnce() -> R,
    ) -> (Vec<U>, R) {
        let work = |number, own| {
            let _ending = Ending { crew: self, workers };
            each(number, workers[number], own)
        };
        thread::scope(|scope| {
            let work = &work;
            let begin = |(number, own)| scope.spawn(move || work(number, own));
            let working: Vec<_> = own.into_iter().enumerate().map(begin).collect();
            let result = {
                let _stop = StopOnPanic(self);
                meanwhile()
            };
            let join =
                |thread: ScopedJoinHandle<_>| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            (working.into_iter().map(join).collect(), result)
        })
    }

    /// The next part for a worker; waits while others work, whose parts may come back. `None` if nothing is left, or all stop.
    pub fn take(&self, number: usize, worker: &dyn Worker) -> Option<W::Part> {
        if !self.is_awake(number, worker) {
            return None;
        }
        let mut state = locked(&self.state);
        loop {
            if self.cancelled() {
                return None;
            }
            let State { work, team, .. } = &mut *state;
            if let Some(part) = work.take(number, team) {
                state.running += 1;
                return Some(part);
            }
            if state.is_over(false) {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether a worker takes part. Waits until it is awake, or nobody needs it any more.
    fn is_awake(&self, number: usize, worker: &dyn Worker) -> bool {
        let is_over = || locked(&self.state).is_over(false) || self.cancelled();
        let awake = worker.wake(&is_over);
        if let Err(error) = &awake {
            self.observer.note(&format!("{error}; other devices render its part"));
        }
        let is_awake = awake.unwrap_or(false);
        if !is_awake && !self.cancelled() {
            self.lose(&mut locked(&self.state), number);
        }
        is_awake
    }

    /// A worker takes no more parts. If none is left, what the last one failed by ends the work.
    fn lose(&self, state: &mut State<W, E>, number: usize) {
        let known = &mut state.team.0[number];
        (known.failed, known.current) = (true, 0.0);
        if state.team.0.iter().all(|known| known.failed) {
            state.error = state.error.take().or(state.of_device.take());
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    /// A worker has done so much in so many seconds, and puts it to the work.
    pub fn finish(&self, worker: usize, (size, seconds): (f64, f64), put: impl FnOnce(&mut W)) {
        let mut state = locked(&self.state);
        let known = &mut state.team.0[worker];
        let (done, seconds) = (known.done + size, known.seconds + seconds);
        *known = Known { done, seconds, current: 0.0, ..*known };
        put(&mut state.work);
        state.running -= 1;
        self.changed.notify_all();
    }

    /// A worker has failed. If its device has, others take its part; all stop if none is left, or the work is at fault.
    pub fn fail(&self, part: W::Part, (number, worker): (usize, &dyn Worker), error: E) {
        let mut state = locked(&self.state);
        state.running -= 1;
        if error.is_of_device() {
            let (name, of_it) = (worker.name(), W::name(&part));
            let text = format!("{name} has failed; other devices take its {of_it}, and render the rest: {error}");
            state.work.give_back(part);
            state.of_device = Some(error);
            self.lose(&mut state, number);
            drop(state);
            if !self.stopped.load(Ordering::Relaxed) {
                self.observer.note(&text);
            }
        } else {
            // What ends all is told rather than that they were stopped for it.
            if state.error.is_none() || !error.is_cancelled() {
                state.error = Some(error);
            }
            self.stopped.store(true, Ordering::Relaxed);
            self.changed.notify_all();
        }
    }

    /// All stop.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
        // Who is about to wait holds the lock.
        drop(locked(&self.state));
        self.changed.notify_all();
    }

    /// Changes the work where others may wait for it.
    pub fn change<T>(&self, change: impl FnOnce(&mut W) -> T) -> T {
        let changed = change(&mut locked(&self.state).work);
        self.changed.notify_all();
        changed
    }

    /// Waits for something that is found in the work. `find` is told whether nobody works any more.
    pub fn wait_for<T>(&self, mut find: impl FnMut(&mut W, bool) -> Option<T>) -> T {
        let mut state = locked(&self.state);
        loop {
            let is_over = state.is_over(self.cancelled());
            if let Some(found) = find(&mut state.work, is_over) {
                return found;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Part of a worker's part is done.
    pub fn progress(&self, worker: usize, size: f64) {
        let mut state = locked(&self.state);
        state.team.0[worker].current = size;
        let done: f64 = state.team.0.iter().map(|known| known.done + known.current).sum();
        state.told = (done / state.work.whole()).clamp(state.told, 1.0);
        let (done, seconds) = (state.told, self.start.elapsed().as_secs_f64());
        let left = (done > 0.0).then(|| seconds * (1.0 - done) / done);
        self.observer.progress(Progress { done, seconds, left });
    }

    /// Whether all shall stop.
    pub fn cancelled(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.observer.cancelled()
    }

    /// The work, what is known of the workers, and what has ended it if it is not done.
    pub fn into_result(self) -> (W, Team, Option<E>) {
        let State { work, team, error, .. } = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        (work, team, error)
    }

    /// Whether a text was not told before.
    fn is_new(&self, text: &str) -> bool {
        locked(&self.state).texts.insert(text.to_owned())
    }
}

/// The end of a worker, by whatever cause.
struct Ending<'a, 'b, W: Work, E: Failure> {
    crew: &'a Crew<'b, W, E>,
    workers: &'a [&'a dyn Worker],
}

impl<W: Work, E: Failure> Drop for Ending<'_, '_, W, E> {
    fn drop(&mut self) {
        let Ending { crew, workers } = self;
        // Others would wait for the part of one that panics.
        crew.stopped.fetch_or(thread::panicking(), Ordering::Relaxed);
        locked(&crew.state).ended += 1;
        crew.changed.notify_all();
        // All may be done: nobody waits for those that do not work yet.
        workers.iter().for_each(|worker| worker.nudge());
    }
}

/// Lets workers end if something else panics.
struct StopOnPanic<'a, 'b, W: Work, E: Failure>(&'a Crew<'b, W, E>);

impl<W: Work, E: Failure> Drop for StopOnPanic<'_, '_, W, E> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stop();
        }
    }
}

/// Hears of a worker's part, and tells of the whole.
pub struct ObserverOfPart<'a, 'b, W: Work, E> {
    crew: &'a Crew<'b, W, E>,
    worker: usize,
    size: f64,
}

impl<'a, 'b, W: Work, E> ObserverOfPart<'a, 'b, W, E> {
    /// Of a part that a worker has taken.
    pub fn new(crew: &'a Crew<'b, W, E>, worker: usize, part: &W::Part) -> ObserverOfPart<'a, 'b, W, E> {
        ObserverOfPart { crew, worker, size: W::size(part) }
    }
}

impl<W: Work, E: Failure> Observer for ObserverOfPart<'_, '_, W, E> {
    fn progress(&self, progress: Progress) {
        self.crew.progress(self.worker, self.size * progress.done);
    }

    fn report_default(&self, setting: Setting, text: &str) {
        if self.crew.is_new(text) {
            self.crew.observer.report_default(setting, text);
        }
    }

    fn note(&self, text: &str) {
        if self.crew.is_new(text) {
            self.crew.observer.note(text);
        }
    }

    fn cancelled(&self) -> bool {
        self.crew.cancelled()
    }
}
