//! The frames of a film: one scene in the memory of one device, and what is the same in two frames is kept from one to the next.

use std::sync::mpsc::{self, SyncSender};
use std::thread;
use std::time::{Duration, Instant};

use lightmesh::render::{Crop, PreparedScene};
use lightmesh::scene::{Animation, Camera};
use lightmesh::{Frame, Observer, RenderError, Scene, Settings, Step};

use super::BUILDING;
use super::exposure::Metering;
use super::mesh_file::Mesh;
use super::movie::Movie;
use super::render::{Studio, save};
use super::sun;
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::manifest::{Chosen, Ledger};
use crate::plan::{Film, Motion, PictureFiles, Work, has_light_points};
use crate::progress::{FrameDone, Watcher};
use crate::{interrupt, memory};

/// Frames across a film from which its exposure and step are chosen.
const SAMPLES: u32 = 5;
/// The longer side of the images that are made for the exposure, at most.
const SAMPLE_SIDE: u32 = 256;

/// Frames that are rendered and wait to be written, besides the one that is.
const WAITING: usize = 1;

/// Renders the frames that are left, and writes the files of each as soon as it is finished, while the next one is rendered.
pub(super) fn run(
    args: &RenderArgs,
    film: &Film,
    mut work: Work,
    studio: &Studio,
    metering: Metering,
) -> Result<(), Failure> {
    let mut ledger = Ledger::begin(args, film, studio.scene, &mut work, studio.watcher)?;
    let (display, watcher) = (studio.plan.files.options.display, studio.watcher);
    let movie = studio.plan.files.movie.map(|container| Movie::begin(args, container, display, watcher)).transpose()?;
    let (begin, settings) = (Instant::now(), studio.plan.settings.clone());
    let moves =
        matches!(film.motion, Motion::Scene(_)) && studio.scene.animation().is_some_and(Animation::moves_surfaces);
    let (prepared, mesh) =
        (studio.prepared.clone(), Mesh::open(studio.plan, (studio.renderer, studio.prepared), moves, studio.watcher)?);
    let mut reel = Reel { args, film, studio, prepared, settings, metering, work: &work, mesh };
    // A request to end leaves time to record what is finished.
    interrupt::watched(|| {
        if ledger.chosen().is_none() && !work.numbers.is_empty() {
            ledger.choose(reel.chosen_across()?);
        }
        reel.keep(ledger.chosen().unwrap_or_default());
        let shelf =
            Shelf { film, studio, metering: reel.metering.clone(), work: &work, ledger, movie, begin, finished: 0 };
        both(&mut reel, shelf)?;
        if work.numbers.is_empty() { Ok(()) } else { reel.mesh.save(&reel.prepared, watcher) }
    })?;
    watcher.summary(&summary(&work, begin.elapsed(), studio));
    Ok(())
}

/// Renders frames on this thread, and writes them on another one.
fn both(reel: &mut Reel, mut shelf: Shelf) -> Result<(), Failure> {
    let last = reel.work.last;
    let (queue, waiting) = mpsc::sync_channel(WAITING);
    let (rendered, written, shelf) = thread::scope(|scope| {
        let writer = scope.spawn(move || {
            let written = waiting.into_iter().try_for_each(|frame| shelf.write(frame));
            (written, shelf)
        });
        let rendered = reel.render(&queue);
        drop(queue);
        let (written, shelf) = writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        (rendered, written, shelf)
    });
    // What is written was rendered before.
    shelf.close(written.and(rendered).map_err(|error| *error), last)
}

/// A failure in a frame.
type InFrame = Box<(u32, Failure)>;

/// A frame that is rendered.
struct Rendered {
    index: usize,
    number: u32,
    /// What it is called besides its number.
    when: String,
    files: PictureFiles,
    scene: Scene,
    frame: Frame,
    stops: f32,
}

/// A film while it is rendered.
struct Reel<'a> {
    args: &'a RenderArgs,
    film: &'a Film,
    studio: &'a Studio<'a>,
    /// The scene at the last frame.
    prepared: PreparedScene,
    settings: Settings,
    metering: Metering,
    work: &'a Work,
    mesh: Mesh<'a>,
}

impl Reel<'_> {
    /// Renders all frames, until nobody takes them.
    fn render(&mut self, queue: &SyncSender<Rendered>) -> Result<(), InFrame> {
        for (index, &number) in self.work.numbers.iter().enumerate() {
            let frame = self.frame(index, number).map_err(|cause| Box::new((number, cause)))?;
            if queue.send(frame).is_err() {
                break;
            }
            if interrupt::requested() {
                return Err(Box::new((number, RenderError::Cancelled.into())));
            }
        }
        Ok(())
    }

    /// Renders a frame.
    fn frame(&mut self, index: usize, number: u32) -> Result<Rendered, Failure> {
        let Studio { renderer, watcher, .. } = *self.studio;
        let files = self.film.files(self.args, number)?;
        let (prepared, when) = self.at(number)?;
        let cache = &mut self.mesh.cache;
        let render =
            |prepared: &PreparedScene, settings: &Settings| renderer.render_with(cache, prepared, settings, watcher);
        let studio = Studio { prepared: &prepared, scene: &prepared.scene, ..*self.studio };
        let (frame, stops) = studio.picture(&self.settings, &self.metering, render)?;
        self.mesh.check(watcher);
        let scene = prepared.scene.clone();
        // What the cache keeps of the frame before goes on to this one.
        self.prepared = prepared;
        Ok(Rendered { index, number, when, files, scene, frame, stops })
    }

    /// The scene at a frame, and what the frame is called besides its number.
    fn at(&self, number: u32) -> Result<(PreparedScene, String), Failure> {
        let Studio { renderer, prepared, plan, watcher, .. } = *self.studio;
        match self.film.motion {
            Motion::Turntable(last) => Ok((prepared.with_cameras(vec![turned(prepared, number, last)]), String::new())),
            Motion::Sun(_) => sun::frame(self.studio, number),
            Motion::Scene(rate) => {
                let scene = prepared.scene.at(rate.time(number));
                let prepare = || renderer.prepare_moved(&self.prepared, &scene, &plan.settings, watcher);
                Ok((memory::during(BUILDING, prepare)?, String::new()))
            }
        }
    }

    /// Exposure and step for the whole film, from frames across it: whichever of them are rendered, and by however many runs.
    fn chosen_across(&self) -> Result<Chosen, Failure> {
        let Studio { renderer, plan, watcher, .. } = *self.studio;
        let asks_step = has_light_points(&plan.settings) && matches!(plan.settings.step, None | Some(Step::Auto));
        if !(self.metering.is_automatic() || asks_step) {
            return Ok(Chosen::default());
        }
        let (mut exposures, mut steps) = (Vec::new(), Vec::new());
        let quiet = Watcher::plain(true);
        let last = self.work.last;
        let mut numbers: Vec<u32> = (0..SAMPLES)
            .map(|sample| 1 + (u64::from(last - 1) * u64::from(sample) / u64::from(SAMPLES - 1)) as u32)
            .collect();
        numbers.dedup();
        for &number in &numbers {
            let (prepared, _) = self.at(number)?;
            let studio = Studio { prepared: &prepared, scene: &prepared.scene, watcher: &quiet, ..*self.studio };
            let render =
                |prepared: &PreparedScene, settings: &Settings| renderer.render_prepared(prepared, settings, &quiet);
            if self.metering.is_automatic() {
                let (_, stops) = studio.picture(&reduced(&plan.settings), &self.metering, render)?;
                exposures.push(stops);
            }
            if asks_step {
                // The step depends on the whole image, of which one pixel is rendered.
                let pixel = plan.settings.clone().with_crop(Crop::new([0, 0], [1, 1]));
                steps.extend(render(&prepared, &pixel)?.stats.settings.step);
            }
        }
        let chosen = Chosen { exposure: median(exposures), step: median(steps) };
        let count = numbers.len();
        if let Some(stops) = chosen.exposure {
            watcher.note(&format!("exposure auto: using {stops} stops, from {count} frames across the film"));
        }
        if let Some(step) = chosen.step {
            watcher.note(&format!("step auto: using {step}, from {count} frames across the film"));
        }
        Ok(chosen)
    }

    /// From now on, what was chosen for the film holds.
    fn keep(&mut self, Chosen { exposure, step }: Chosen) {
        if let Some(step) = step {
            self.settings = self.settings.clone().with_step(Step::Fixed(step));
        }
        if let Some(exposure) = exposure {
            self.metering = self.metering.clone().fixed(exposure);
        }
    }
}

/// Where finished frames go.
struct Shelf<'a> {
    film: &'a Film,
    studio: &'a Studio<'a>,
    metering: Metering,
    work: &'a Work,
    ledger: Ledger,
    movie: Option<Movie>,
    begin: Instant,
    /// Frames that are written.
    finished: usize,
}

impl Shelf<'_> {
    /// Writes the files of a frame, and records that they are there.
    fn write(&mut self, rendered: Rendered) -> Result<(), InFrame> {
        let number = rendered.number;
        self.put(rendered).map_err(|cause| Box::new((number, cause)))
    }

    fn put(&mut self, rendered: Rendered) -> Result<(), Failure> {
        let Rendered { index, number, when, files, scene, frame, stops } = rendered;
        let Studio { renderer, plan, watcher, .. } = *self.studio;
        let picture = (renderer, &scene, plan);
        let frame = save(frame, stops, &files, picture, scene.cameras.first(), &self.metering, watcher)?;
        if let Some(movie) = &mut self.movie {
            movie.push(&frame.image, stops)?;
        }
        self.ledger.finished(number, &files)?;
        self.finished += 1;
        self.tell(index, number, &when, &frame, &files);
        Ok(())
    }

    /// Records which frames are finished, whatever ended the film.
    fn close(mut self, ended: Result<(), (u32, Failure)>, last: u32) -> Result<(), Failure> {
        let closed = self.ledger.close();
        if let Err((number, cause)) = ended {
            // A movie is there as a whole or not at all.
            let finished = if self.film.is_movie() { 0 } else { self.finished + self.work.skipped };
            return Err(cause.in_frame(number, last, finished, self.flag_that_goes_on()));
        }
        closed?;
        self.movie.take().map_or(Ok(()), Movie::finish)
    }

    fn flag_that_goes_on(&self) -> &'static str {
        if self.ledger.is_kept() { "--resume" } else { "--skip-existing" }
    }

    fn tell(&self, index: usize, number: u32, when: &str, frame: &Frame, files: &PictureFiles) {
        let (count, kept, index) = (self.work.numbers.len(), self.work.skipped, index + 1);
        if !self.film.is_movie() {
            let (finished, all, flag) = (index + kept, count + kept, self.flag_that_goes_on());
            interrupt::remark(format!("{finished} of {all} frames are finished ({flag} goes on)"));
        }
        self.studio.watcher.frame(&FrameDone {
            number,
            last: self.work.last,
            when: when.to_owned(),
            index,
            count,
            kept,
            seconds: frame.stats.seconds.render,
            left: self.begin.elapsed().mul_f64((count - index) as f64 / index as f64),
            files: files.paths().map(|path| path.display().to_string()).collect(),
            picture: files.picture.to_string(),
        });
    }
}

/// Settings for a small image of the whole.
fn reduced(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    settings.crop = None;
    let [width, height] = settings.size;
    let longer = width.max(height).max(SAMPLE_SIDE);
    let side = |side: u32| (u64::from(side) * u64::from(SAMPLE_SIDE) / u64::from(longer)).max(1) as u32;
    settings.with_size([side(width), side(height)])
}

/// The middle one of some values, the lower of two.
fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}

/// Says which animations are played, or that there are some.
pub(super) fn explain(scene: &Scene, is_film: bool, watcher: &Watcher) {
    let Some(animation) = scene.animation() else { return };
    let seconds = animation.duration();
    if !is_film {
        watcher.note(&format!(
            "the scene moves for {seconds:.2} s; this image shows it at rest (--fps 24 renders the film, --frames a part of it)"
        ));
    } else if !animation.others().is_empty() {
        let quoted = |names: &[String]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let (names, others) = (quoted(animation.names()), quoted(animation.others()));
        watcher.note(&format!(
            "animation {names}: {seconds:.2} s; the scene also has {others} (--animation plays another)"
        ));
    }
}

/// The camera of frame `number` of a turntable: that of the scene, turned about the vertical through the middle of the scene. All `last` frames
/// make one turn.
fn turned(prepared: &PreparedScene, number: u32, last: u32) -> Camera {
    let camera = prepared.scene.cameras[0].clone();
    if number == 1 {
        return camera;
    }
    let share = f64::from(number - 1) / f64::from(last);
    camera.turned_about(prepared.geometry.bounds.center(), (std::f64::consts::TAU * share) as f32)
}

fn summary(work: &Work, elapsed: Duration, studio: &Studio) -> String {
    let (count, seconds) = (work.numbers.len(), elapsed.as_secs_f64());
    let skipped = match work.skipped {
        0 => String::new(),
        skipped => format!(", {skipped} kept"),
    };
    if count == 0 {
        return format!("no frame is missing: {} kept", work.skipped);
    }
    let frames = if count == 1 { "frame" } else { "frames" };
    format!(
        "{}: {count} {frames}{skipped}: {seconds:.3} s, {:.2} per second (load {:.3} s)",
        studio.scene.name,
        count as f64 / seconds,
        studio.load
    )
}
