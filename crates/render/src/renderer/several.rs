//! One image on several devices: bands of rows from a queue.
//!
//! A band is a crop of the image, and crops have the bytes of the image: so it does not matter who renders which, nor how they are cut. Each device
//! takes half of what it could do of the rest, by its speed so far, so that all end together; one that would take longer for a band than the others
//! for all that is left takes none. What it knows of light points and gathered light it keeps from band to band. The rows of a device that fails go
//! to the others.

use std::collections::HashSet;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use super::frame::Frame;
use super::picture::unfinished;
use crate::cache::MeshCache;
use crate::error::RenderError;
use crate::observer::{Observer, Progress};
use crate::prepared::PreparedScene;
use crate::settings::{Crop, Setting, Settings};
use crate::sync::locked;

/// Bands have so many rows at least, but for the first and the last of a device: smaller ones mostly repeat those around them.
const MIN_ROWS: u32 = 64;
/// The first band of a device whose speed is not known is one part in this many, of so many rows at least.
const FIRST: u32 = 64;
const MIN_FIRST: u32 = 8;

/// What renders bands.
pub trait Worker: Sync {
    /// What it is called.
    fn name(&self) -> String;

    /// The id of its device; `None`: the host.
    fn id(&self) -> Option<u64>;

    /// Renders a band.
    ///
    /// # Errors
    /// As [`Renderer::render_with`](crate::Renderer::render_with).
    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError>;
}

/// How fast workers rendered before: pixels per second.
#[derive(Debug, Default)]
pub struct Speeds(Mutex<Vec<Option<f64>>>);

/// Renders one image by several workers, whose speeds are kept for the next.
///
/// # Errors
/// As [`Renderer::render_with`](crate::Renderer::render_with); that of the last device if all have failed.
pub fn render_together(
    workers: &[&dyn Worker],
    speeds: &Speeds,
    (cache, scene, settings): (&mut MeshCache, &PreparedScene, &Settings),
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    let start = Instant::now();
    let whole = settings.crop.unwrap_or(Crop::new([0, 0], settings.size));
    let is_possible = whole.size[1] > 0 && whole.first[1].checked_add_unsigned(whole.size[1]).is_some();
    if workers.len() == 1 || !is_possible {
        return workers[0].render(cache, scene, settings, observer);
    }
    let mut known = locked(&speeds.0).clone();
    known.resize(workers.len(), None);
    let width = f64::from(whole.size[0].max(1));
    let together = Together::new(known.iter().map(|speed| speed.map(|speed| speed / width)), whole.size[1], observer);
    let ids: Vec<Option<u64>> = workers.iter().map(|worker| worker.id()).collect();
    let caches = cache.parted(&ids);
    let job = Job { scene, settings, whole, together: &together };
    let (bands, caches): (Vec<Vec<Band>>, Vec<MeshCache>) = thread::scope(|scope| {
        let begin = |((number, worker), cache)| scope.spawn(move || job.work(number, worker, cache));
        let working: Vec<_> = workers.iter().copied().enumerate().zip(caches).map(begin).collect();
        let join = |thread: thread::ScopedJoinHandle<_>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        working.into_iter().map(join).unzip()
    });
    cache.unite(caches);
    *locked(&speeds.0) = together.speeds().into_iter().map(|speed| speed.map(|speed| speed * width)).collect();
    let mut bands: Vec<Band> = bands.into_iter().flatten().collect();
    bands.sort_by_key(|band| band.first);
    let mut frame = job.joined(bands, together.error())?;
    frame.stats.device.name = names(workers);
    frame.stats.seconds.render = start.elapsed().as_secs_f64();
    if frame.stats.finished_rows.is_none() {
        observer.progress(Progress { done: 1.0, seconds: start.elapsed().as_secs_f64(), left: Some(0.0) });
    }
    Ok(frame)
}

/// What they are called.
pub(super) fn names(workers: &[&dyn Worker]) -> String {
    workers.iter().map(|worker| worker.name()).collect::<Vec<_>>().join(", ")
}

/// A finished band, or the finished rows of one that was stopped.
struct Band {
    /// Its first row in what is rendered.
    first: u32,
    frame: Frame,
}

impl Band {
    fn end(&self) -> u32 {
        self.first + self.frame.finished_rows()
    }
}

/// The image that all workers work on.
#[derive(Clone, Copy)]
struct Job<'a> {
    scene: &'a PreparedScene,
    settings: &'a Settings,
    /// What is rendered of the image.
    whole: Crop,
    together: &'a Together<'a>,
}

impl Job<'_> {
    /// Renders bands until there is none left, or a failure.
    fn work(&self, number: usize, worker: &dyn Worker, mut cache: MeshCache) -> (Vec<Band>, MeshCache) {
        let mut bands = Vec::new();
        let _stop = StopOnPanic(self.together);
        while let Some(rows) = self.together.take(number) {
            let start = Instant::now();
            let observer = ObserverOfBand { together: self.together, worker: number, rows: rows.len() as f64 };
            let rendered =
                worker.render(&mut cache, self.scene, &self.settings.clone().with_crop(self.crop(&rows)), &observer);
            match rendered {
                Ok(frame) => {
                    self.together.finish(number, frame.finished_rows(), start.elapsed().as_secs_f64());
                    bands.push(Band { first: rows.start, frame });
                }
                Err(error) => {
                    self.together.fail(rows, (number, worker), error);
                    break;
                }
            }
        }
        (bands, cache)
    }

    fn crop(&self, rows: &Range<u32>) -> Crop {
        let Crop { first: [x, y], size: [width, _] } = self.whole;
        Crop::new([x, y + rows.start as i32], [width, rows.len() as u32])
    }

    /// The frame of all bands. Of an image that was stopped, the finished rows from the top if these are asked for.
    fn joined(&self, mut bands: Vec<Band>, error: Option<RenderError>) -> Result<Frame, RenderError> {
        let height = self.whole.size[1];
        let mut finished = 0;
        bands.retain(|band| {
            let follows = band.first == finished;
            finished = if follows { band.end() } else { finished };
            follows
        });
        let is_part = finished < height;
        match error.filter(|_| is_part) {
            Some(error) if !matches!(error, RenderError::Cancelled) => return Err(error),
            _ if is_part && !(self.settings.partial && finished > 0) => return Err(RenderError::Cancelled),
            _ => {}
        }
        let mut stats = self.stats(&bands, is_part.then_some(finished));
        stats.counts.pixels = u64::from(self.whole.size[0]) * u64::from(finished);
        let mut images: Vec<lightmesh_image::Frame> = Vec::new();
        for Band { first, frame } in bands {
            let rows = frame.finished_rows();
            let crop = self.crop(&(first..first + rows));
            let whole = rows == frame.image.height();
            images.push(if whole {
                frame.image
            } else {
                frame.image.cropped(crop.first, crop.size).expect("it has them")
            });
        }
        if is_part {
            let rest = self.settings.clone().with_crop(self.crop(&(finished..height)));
            images.push(unfinished(self.scene, &rest)?);
        }
        let image = lightmesh_image::Frame::stacked(images).expect("bands of one image fit");
        Ok(Frame { image, stats })
    }

    fn stats(&self, bands: &[Band], finished_rows: Option<u32>) -> crate::stats::Stats {
        let all = || bands.iter().map(|band| &band.frame.stats);
        let mut stats = bands[0].frame.stats.clone();
        stats.finished_rows = finished_rows;
        stats.settings.crop = self.settings.crop.and(Some({
            let Crop { first: [x, y], size: [width, height] } = self.whole;
            [x.into(), y.into(), width.into(), height.into()]
        }));
        if all().any(|other| other.device.kind != stats.device.kind) {
            (stats.device.kind, stats.settings.device) = ("cuda,cpu", "cuda,cpu");
        }
        stats.settings.rows_per_band = all().map(|stats| stats.settings.rows_per_band).max().unwrap_or(0);
        all().skip(1).for_each(|other| stats.add(other));
        stats
    }
}

/// The queue of rows, and what is told of all bands.
struct Together<'a> {
    rows: u32,
    start: Instant,
    state: Mutex<State>,
    changed: Condvar,
    stopped: AtomicBool,
    observer: &'a dyn Observer,
}

struct State {
    /// The first row that nobody has taken.
    next: u32,
    /// Rows that failed.
    returned: Vec<Range<u32>>,
    /// Bands that are being rendered.
    running: usize,
    workers: Vec<Known>,
    error: Option<RenderError>,
    /// What was told.
    texts: HashSet<String>,
    /// The share that was told.
    told: f64,
}

/// What is known of a worker.
#[derive(Clone, Copy, Default)]
struct Known {
    /// Rows per second in earlier images.
    before: Option<f64>,
    rows: f64,
    seconds: f64,
    /// Rows of the band in progress that are done.
    current: f64,
    failed: bool,
}

impl Known {
    fn speed(&self) -> Option<f64> {
        if self.seconds > 0.0 { Some(self.rows / self.seconds) } else { self.before }
    }
}

impl<'a> Together<'a> {
    fn new(speeds: impl Iterator<Item = Option<f64>>, rows: u32, observer: &'a dyn Observer) -> Together<'a> {
        let workers: Vec<Known> = speeds.map(|before| Known { before, ..Known::default() }).collect();
        let state =
            State { next: 0, returned: Vec::new(), running: 0, workers, error: None, texts: HashSet::new(), told: 0.0 };
        let (changed, stopped) = (Condvar::new(), AtomicBool::new(false));
        Together { rows, start: Instant::now(), state: Mutex::new(state), changed, stopped, observer }
    }

    /// The next band of a worker; waits while others work, whose rows may come back. `None` if there is nothing left, or all stop.
    fn take(&self, worker: usize) -> Option<Range<u32>> {
        let mut state = locked(&self.state);
        loop {
            if self.cancelled() {
                return None;
            }
            let rows = state.returned.pop().or_else(|| state.cut(worker, self.rows));
            if rows.is_some() {
                state.running += 1;
                return rows;
            }
            if state.running == 0 && state.next == self.rows {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn finish(&self, worker: usize, rows: u32, seconds: f64) {
        let mut state = locked(&self.state);
        let known = &mut state.workers[worker];
        let (rows, seconds) = (known.rows + f64::from(rows), known.seconds + seconds);
        *known = Known { rows, seconds, current: 0.0, ..*known };
        state.running -= 1;
        self.changed.notify_all();
    }

    /// A worker has failed. If its device has, others take its rows; all stop if none is left, or the image is at fault.
    fn fail(&self, rows: Range<u32>, (number, worker): (usize, &dyn Worker), error: RenderError) {
        let mut state = locked(&self.state);
        state.running -= 1;
        state.workers[number].failed = true;
        if is_of_device(&error) && state.workers.iter().any(|known| !known.failed) {
            let rows_of_it = rows.len();
            state.returned.push(rows);
            drop(state);
            let name = worker.name();
            self.observer.note(&format!(
                "{name} has failed; other devices take its {rows_of_it} rows, and render the rest: {error}"
            ));
        } else {
            // What ends all is told rather than that they were stopped for it.
            if state.error.is_none() || !matches!(error, RenderError::Cancelled) {
                state.error = Some(error);
            }
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    /// Rows per second of each.
    fn speeds(&self) -> Vec<Option<f64>> {
        locked(&self.state).workers.iter().map(Known::speed).collect()
    }

    fn error(&self) -> Option<RenderError> {
        locked(&self.state).error.take()
    }

    fn cancelled(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.observer.cancelled()
    }

    /// So many rows of a worker's band are done.
    fn progress(&self, worker: usize, rows: f64) {
        let mut state = locked(&self.state);
        state.workers[worker].current = rows;
        let rows: f64 = state.workers.iter().map(|known| known.rows + known.current).sum();
        state.told = (rows / f64::from(self.rows)).clamp(state.told, 1.0);
        let (done, seconds) = (state.told, self.start.elapsed().as_secs_f64());
        let left = (done > 0.0).then(|| seconds * (1.0 - done) / done);
        self.observer.progress(Progress { done, seconds, left });
    }

    /// Whether a text was not told before.
    fn is_new(&self, text: &str) -> bool {
        locked(&self.state).texts.insert(text.to_owned())
    }
}

/// Lets others end if a worker panics: they would wait for its rows.
struct StopOnPanic<'a>(&'a Together<'a>);

impl Drop for StopOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.stopped.store(true, Ordering::Relaxed);
            // Who is about to wait holds the lock.
            drop(locked(&self.0.state));
            self.0.changed.notify_all();
        }
    }
}

impl State {
    /// The next band of a worker, if it takes one.
    fn cut(&mut self, worker: usize, rows: u32) -> Option<Range<u32>> {
        let (first, left) = (self.next, rows - self.next);
        let wanted = match self.workers[worker].speed() {
            None => (rows / FIRST).max(MIN_FIRST),
            Some(speed) => self.share(speed, worker, left)?,
        };
        // The last one is no smaller than others.
        let count = if left < wanted + MIN_ROWS / 2 { left } else { wanted };
        self.next += count;
        (count > 0).then_some(first..first + count)
    }

    /// Half of what a worker would do of the rest if all went on as they did; `None` if the others do all of it before.
    fn share(&self, speed: f64, worker: usize, left: u32) -> Option<u32> {
        let left = f64::from(left);
        let others = self.workers.iter().enumerate().filter(|(number, known)| *number != worker && !known.failed);
        // Of those whose speed is not known it is taken to be the same.
        let others: Vec<f64> = others.map(|(_, known)| known.speed().unwrap_or(speed)).collect();
        let (all, fastest) = (others.iter().sum::<f64>(), others.iter().copied().fold(0.0, f64::max));
        let wanted = (0.5 * left * speed / (speed + all)).max(f64::from(MIN_ROWS)).min(left);
        // The fastest of all is never late, so that somebody goes on.
        let is_late = wanted / speed > (left / all).max(wanted / fastest);
        (!is_late).then(|| wanted.ceil() as u32)
    }
}

/// Whether another device may do what failed.
fn is_of_device(error: &RenderError) -> bool {
    let fails = matches!(
        error,
        RenderError::Device { .. } | RenderError::DeviceFault { .. } | RenderError::DeviceMemory { .. }
    );
    fails || error.is_of_memory()
}

/// Hears of a band, and tells of the whole.
struct ObserverOfBand<'a> {
    together: &'a Together<'a>,
    worker: usize,
    rows: f64,
}

impl Observer for ObserverOfBand<'_> {
    fn progress(&self, progress: Progress) {
        self.together.progress(self.worker, self.rows * progress.done);
    }

    fn report_default(&self, setting: Setting, text: &str) {
        if self.together.is_new(text) {
            self.together.observer.report_default(setting, text);
        }
    }

    fn note(&self, text: &str) {
        if self.together.is_new(text) {
            self.together.observer.note(text);
        }
    }

    fn cancelled(&self) -> bool {
        self.together.cancelled()
    }
}
