//! One image on several devices: bands of rows from a queue.
//!
//! A band is a crop of the image, and crops have the bytes of the image: so it does not matter who renders which, nor how they are cut. Each device
//! takes half of what it could do of the rest, by its speed so far, so that all end together; one that would take longer for a band than the others
//! for all that is left takes none. What it knows of light points and gathered light it keeps from band to band. The rows of a device that fails go
//! to the others. Finished bands are copied into the image while the rest is rendered, once and by all threads.

use std::ops::Range;
use std::sync::Mutex;
use std::time::Instant;

use super::crew::{Crew, Failure, ObserverOfPart, Team, Work};
use super::frame::Frame;
use super::picture::unfinished;
use super::worker::Worker;
use crate::cache::MeshCache;
use crate::error::RenderError;
use crate::observer::{Observer, Progress};
use crate::prepared::PreparedScene;
use crate::settings::{Crop, Settings};
use crate::stats::Stats;
use crate::sync::locked;

/// Bands have so many rows at least, but for the first and the last of a device: smaller ones mostly repeat those around them.
const MIN_ROWS: u32 = 64;
/// The first band of a device whose speed is not known is one part in this many, of so many rows at least.
const FIRST: u32 = 64;
const MIN_FIRST: u32 = 8;

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
    let rows = Rows { all: whole.size[1], next: 0, returned: Vec::new(), finished: Vec::new() };
    let crew = Crew::new(rows, known.iter().map(|speed| speed.map(|speed| speed / width)), observer);
    let ids: Vec<Option<u64>> = workers.iter().map(|worker| worker.id()).collect();
    let job = Job { scene, settings, whole };
    let work = |number, worker: &dyn Worker, cache| job.work(&crew, (number, worker), cache);
    let join = || {
        let mut joined = Joined::default();
        while let Some(band) = crew.wait_for(Rows::finished) {
            joined.put(band, &job);
        }
        joined
    };
    let (caches, joined) = crew.run(workers, cache.parted(&ids), work, join);
    cache.unite(caches);
    let (_, team, error) = crew.into_result();
    *locked(&speeds.0) = team.speeds().map(|speed| speed.map(|speed| speed * width)).collect();
    let mut frame = joined.into_frame(&job, error)?;
    let worked = workers.iter().enumerate().filter(|(number, _)| team.has_worked(*number));
    frame.stats.device.name = names(worked.map(|(_, worker)| *worker));
    frame.stats.seconds.render = start.elapsed().as_secs_f64();
    if frame.stats.finished_rows.is_none() {
        observer.progress(Progress { done: 1.0, seconds: frame.stats.seconds.render, left: Some(0.0) });
    }
    Ok(frame)
}

/// What they are called.
pub(super) fn names<'a>(workers: impl IntoIterator<Item = &'a dyn Worker>) -> String {
    workers.into_iter().map(Worker::name).collect::<Vec<_>>().join(", ")
}

/// The rows of an image.
struct Rows {
    all: u32,
    /// The first row that nobody has taken.
    next: u32,
    /// Rows that failed.
    returned: Vec<Range<u32>>,
    /// Bands that nobody has joined to others.
    finished: Vec<Band>,
}

impl Rows {
    /// A finished band; `None` in it if there will be none.
    fn finished(&mut self, is_over: bool) -> Option<Option<Band>> {
        let band = self.finished.pop();
        (band.is_some() || is_over).then_some(band)
    }
}

impl Work for Rows {
    type Part = Range<u32>;

    fn take(&mut self, worker: usize, team: &Team) -> Option<Range<u32>> {
        if let Some(rows) = self.returned.pop() {
            return Some(rows);
        }
        let (first, left) = (self.next, self.all - self.next);
        let wanted = match team.speed(worker) {
            None => (self.all / FIRST).max(MIN_FIRST),
            Some(speed) => {
                let left = f64::from(left);
                let wanted = (0.5 * team.share(worker, speed, left)).max(f64::from(MIN_ROWS)).min(left);
                (!team.is_late(worker, speed, wanted, left)).then(|| wanted.ceil() as u32)?
            }
        };
        // The last one is no smaller than others.
        let count = if left < wanted + MIN_ROWS / 2 { left } else { wanted };
        self.next += count;
        (count > 0).then_some(first..first + count)
    }

    fn give_back(&mut self, rows: Range<u32>) {
        self.returned.push(rows);
    }

    fn is_taken(&self) -> bool {
        self.next == self.all && self.returned.is_empty()
    }

    fn whole(&self) -> f64 {
        self.all.into()
    }

    fn size(rows: &Range<u32>) -> f64 {
        rows.len() as f64
    }

    fn name(rows: &Range<u32>) -> String {
        format!("{} rows", rows.len())
    }
}

impl Failure for RenderError {
    fn is_of_device(&self) -> bool {
        let fails = matches!(
            self,
            RenderError::Device { .. } | RenderError::DeviceFault { .. } | RenderError::DeviceMemory { .. }
        );
        fails || self.is_of_memory()
    }

    fn is_cancelled(&self) -> bool {
        matches!(self, RenderError::Cancelled)
    }
}

/// A band.
struct Band {
    /// Its rows that are finished, in what is rendered.
    rows: Range<u32>,
    /// With what may be around them.
    frame: Frame,
}

/// The image that all workers work on.
struct Job<'a> {
    scene: &'a PreparedScene,
    settings: &'a Settings,
    /// What is rendered of the image.
    whole: Crop,
}

impl Job<'_> {
    /// Renders bands until there is none left, or a failure.
    fn work(
        &self,
        crew: &Crew<Rows, RenderError>,
        (number, worker): (usize, &dyn Worker),
        mut cache: MeshCache,
    ) -> MeshCache {
        while let Some(rows) = crew.take(number, worker) {
            let start = Instant::now();
            let observer = ObserverOfPart::new(crew, number, &rows);
            let part = self.crop(&rows);
            let settings = self.settings.clone().with_crop(part);
            match worker.render_around(&mut cache, self.scene, &settings, &observer) {
                Ok(frame) => {
                    let finished = frame.finished_rows_of(part);
                    let rows = rows.start..rows.start + finished;
                    let done = (f64::from(finished), start.elapsed().as_secs_f64());
                    crew.finish(number, done, |all| all.finished.push(Band { rows, frame }));
                }
                Err(error) => {
                    crew.fail(rows, (number, worker), error);
                    break;
                }
            }
        }
        cache
    }

    fn crop(&self, rows: &Range<u32>) -> Crop {
        let Crop { first: [x, y], size: [width, _] } = self.whole;
        Crop::new([x, y + rows.start as i32], [width, rows.len() as u32])
    }
}

/// What is joined of an image while the rest is rendered.
#[derive(Default)]
struct Joined {
    image: Option<lightmesh_image::Frame>,
    bands: Vec<(Range<u32>, Stats)>,
}

impl Joined {
    /// Adds the rows of a band that are finished.
    fn put(&mut self, Band { rows, frame }: Band, job: &Job) {
        if rows.is_empty() {
            return;
        }
        let (whole, part) = (job.whole, job.crop(&rows));
        let blank = || lightmesh_image::Frame::around(&frame.image, whole.first, whole.size).expect("it has the band");
        let fits = self.image.get_or_insert_with(blank).put(&frame.image, part.first, part.size);
        assert!(fits, "bands of one image fit");
        self.bands.push((rows, frame.stats));
    }

    /// The frame of all bands. Of an image that was stopped, the finished rows from the top if these are asked for.
    fn into_frame(mut self, job: &Job, error: Option<RenderError>) -> Result<Frame, RenderError> {
        let height = job.whole.size[1];
        self.bands.sort_by_key(|(rows, _)| rows.start);
        let mut finished = 0;
        self.bands.retain(|(rows, _)| {
            let follows = rows.start == finished;
            finished = if follows { rows.end } else { finished };
            follows
        });
        let is_part = finished < height;
        match error.filter(|_| is_part) {
            Some(error) if !error.is_cancelled() => return Err(error),
            _ if is_part && !job.settings.partial => return Err(RenderError::Cancelled),
            _ => {}
        }
        let stats = self.stats(job, is_part.then_some(finished)).ok_or(RenderError::Cancelled)?;
        let mut image = self.image.ok_or(RenderError::Cancelled)?;
        if is_part {
            let rest = job.crop(&(finished..height));
            let unfinished = unfinished(job.scene, &job.settings.clone().with_crop(rest))?;
            assert!(image.put(&unfinished, rest.first, rest.size), "it is of the same image");
        }
        Ok(Frame { image, stats })
    }

    /// `None` if there are no bands.
    fn stats(&self, job: &Job, finished_rows: Option<u32>) -> Option<Stats> {
        let all = || self.bands.iter().map(|(_, stats)| stats);
        let mut stats = all().next()?.clone();
        let Crop { first: [x, y], size: [width, height] } = job.whole;
        stats.finished_rows = finished_rows;
        stats.settings.crop = job.settings.crop.and(Some([x.into(), y.into(), width.into(), height.into()]));
        if all().any(|other| other.device.kind != stats.device.kind) {
            (stats.device.kind, stats.settings.device) = ("cuda,cpu", "cuda,cpu");
        }
        stats.settings.rows_per_band = all().map(|stats| stats.settings.rows_per_band).max().unwrap_or(0);
        all().skip(1).for_each(|other| stats.add(other));
        stats.counts.pixels = u64::from(width) * u64::from(finished_rows.unwrap_or(height));
        Some(stats)
    }
}
