//! One image on several devices: bands of rows from a queue.
//!
//! A band is a crop of the image, and crops have the bytes of the image: so it does not matter who renders which, nor how they are cut. Each device
//! takes half of what it could do of the rest, by its speed so far, so that all end together; one that would take longer for a band than the others
//! for all that is left takes none. What it knows of light points and gathered light it keeps from band to band. The rows of a device that fails go
//! to the others.

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
    let rows = Rows { all: whole.size[1], next: 0, returned: Vec::new(), bands: Vec::new() };
    let crew = Crew::new(rows, known.iter().map(|speed| speed.map(|speed| speed / width)), observer);
    let ids: Vec<Option<u64>> = workers.iter().map(|worker| worker.id()).collect();
    let job = Job { scene, settings, whole };
    let work = |number, worker: &dyn Worker, cache| job.work(&crew, (number, worker), cache);
    let (caches, ()) = crew.run(workers, cache.parted(&ids), work, || ());
    cache.unite(caches);
    let (rows, team, error) = crew.into_result();
    *locked(&speeds.0) = team.speeds().map(|speed| speed.map(|speed| speed * width)).collect();
    let mut frame = job.joined(rows.bands, error)?;
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
    /// What is rendered.
    bands: Vec<Band>,
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
            let settings = self.settings.clone().with_crop(self.crop(&rows));
            match worker.render(&mut cache, self.scene, &settings, &observer) {
                Ok(frame) => {
                    let done = (f64::from(frame.finished_rows()), start.elapsed().as_secs_f64());
                    crew.finish(number, done, |all| all.bands.push(Band { first: rows.start, frame }));
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

    /// The frame of all bands. Of an image that was stopped, the finished rows from the top if these are asked for.
    fn joined(&self, mut bands: Vec<Band>, error: Option<RenderError>) -> Result<Frame, RenderError> {
        let height = self.whole.size[1];
        bands.sort_by_key(|band| band.first);
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
