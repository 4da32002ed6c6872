//! The frames of a film: one scene in the memory of a device, and what is the same in two frames is kept from one to the next.

use std::sync::Arc;
use std::time::Duration;

use lightmesh_render::{Crop, Frame, PreparedScene, Settings, Step, Worker};
use lightmesh_scene::{Animation, Camera, Scene};

use super::{FrameRange, Motion};
use crate::context::{Context, Prepared};
use crate::error::{Error, RequestError};
use crate::expose::Metering;
use crate::host::{BUILDING, Host, Quiet};
use crate::manifest::Chosen;
use crate::mesh_file::Mesh;
use crate::plan::Plan;
use crate::sun;

/// Frames across a film from which its exposure and step are chosen.
const SAMPLES: u32 = 5;
/// The longer side of the images that are made for the exposure, at most.
const SAMPLE_SIDE: u32 = 256;

/// A rendered frame of a film.
pub struct RenderedFrame {
    /// Its number.
    pub number: u32,
    /// What it is called besides its number: the time of day in a sun study.
    pub when: String,
    /// The scene at this frame.
    pub scene: Scene,
    /// The image.
    pub frame: Frame,
    /// Its exposure in stops.
    pub stops: f32,
}

/// Renders the frames of a film in any order. What two frames in a row have in common is kept between them.
pub struct FrameRenderer {
    reel: Reel,
    /// By device; of one at least.
    kept: Vec<Kept>,
}

/// What is the same for all frames of a film.
pub(super) struct Reel {
    plan: Arc<Plan>,
    motion: Motion,
    /// The film's last frame.
    last: u32,
    /// The scene at rest.
    base: PreparedScene,
    settings: Settings,
    metering: Metering,
}

/// What a device keeps from frame to frame.
pub(super) struct Kept {
    /// The scene at the last frame that it has rendered.
    before: PreparedScene,
    mesh: Mesh,
}

impl FrameRenderer {
    /// For the film that is planned.
    pub(crate) fn new(prepared: &Prepared, range: &FrameRange, context: Context) -> Result<FrameRenderer, Error> {
        let plan = Arc::clone(&prepared.plan);
        let motion = plan.film.as_ref().ok_or(RequestError::NoFilm)?.motion;
        let base = prepared.scene.clone();
        let moves = matches!(motion, Motion::Scene(_)) && base.scene.animation().is_some_and(Animation::moves_surfaces);
        let mesh = Mesh::open(&plan, (context.renderer, &base), moves, context.host)?;
        let (settings, metering) = (plan.settings.clone(), prepared.metering.clone());
        let kept = vec![Kept { before: base.clone(), mesh }];
        Ok(FrameRenderer { reel: Reel { plan, motion, last: range.last, base, settings, metering }, kept })
    }

    /// Whether the film has a shadow catcher, and how its frames are exposed.
    pub(crate) fn metering(&self) -> &Metering {
        &self.reel.metering
    }

    /// Writes what is known of light points and gathered light, if there is a file for it.
    pub(crate) fn save_mesh(&mut self, host: &dyn Host) {
        let before = self.kept[0].before.clone();
        let mesh = Mesh::united(self.kept.drain(..).map(|kept| kept.mesh));
        mesh.save(&before, host);
        self.kept.push(Kept { before, mesh });
    }

    /// Renders a frame on all devices of the renderer.
    ///
    /// # Errors
    /// Those of the renderer, and those of surroundings.
    pub(crate) fn render(&mut self, number: u32, context: Context) -> Result<RenderedFrame, Error> {
        self.reel.render(number, &mut self.kept[0], context.renderer, context)
    }

    /// For devices that render frames by themselves: what is the same for all, and what each of them keeps.
    pub(super) fn on(&mut self, devices: &[&dyn Worker]) -> (&Reel, Vec<&mut Kept>) {
        if let [first] = &mut self.kept[..] {
            let ids: Vec<Option<u64>> = devices.iter().map(|device| device.id()).collect();
            self.kept = first.parted(&ids);
        }
        (&self.reel, self.kept.iter_mut().collect())
    }

    /// Exposure and step for the whole film, from frames across it: whichever of them are rendered, and by however many runs.
    pub(crate) fn chosen_across(&self, context: Context) -> Result<Chosen, Error> {
        self.reel.chosen_across(context)
    }

    /// From now on, what was chosen for the film holds.
    pub(crate) fn keep(&mut self, Chosen { exposure, step }: Chosen) {
        let Reel { settings, metering, .. } = &mut self.reel;
        if let Some(step) = step {
            *settings = settings.clone().with_step(Step::Fixed(step));
        }
        if let Some(exposure) = exposure {
            *metering = metering.clone().fixed(exposure);
        }
    }
}

impl Kept {
    /// The same for each of several devices.
    fn parted(&mut self, ids: &[Option<u64>]) -> Vec<Kept> {
        let parts = self.mesh.parted(ids).into_iter();
        parts.map(|mesh| Kept { before: self.before.clone(), mesh }).collect()
    }
}

impl Reel {
    /// Renders a frame on a device.
    ///
    /// # Errors
    /// Those of the renderer, and those of surroundings.
    pub(super) fn render(
        &self,
        number: u32,
        kept: &mut Kept,
        device: &dyn Worker,
        context: Context,
    ) -> Result<RenderedFrame, Error> {
        let (prepared, when) = self.at(number, &kept.before, context)?;
        let cache = &mut kept.mesh.cache;
        let render = |prepared: &PreparedScene, settings: &Settings, host: &dyn Host| {
            device.render(cache, prepared, settings, host)
        };
        let (frame, stops) = context.picture(&prepared, &self.settings, &self.metering, render)?;
        kept.mesh.check(context.host);
        let scene = prepared.scene.clone();
        // What the cache keeps of the frame before goes on to this one.
        kept.before = prepared;
        Ok(RenderedFrame { number, when, scene, frame, stops })
    }

    /// The scene at a frame, after the frame `before`, and what the frame is called besides its number.
    fn at(
        &self,
        number: u32,
        before: &PreparedScene,
        Context { renderer, host, .. }: Context,
    ) -> Result<(PreparedScene, String), Error> {
        match self.motion {
            Motion::Turntable(last) => {
                Ok((self.base.with_cameras(vec![turned(&self.base, number, last)]), String::new()))
            }
            Motion::Sun(_) => sun::frame(&self.plan, &self.base, number),
            Motion::Scene(rate) => {
                let scene = self.base.scene.at(rate.time(number));
                let prepare = || renderer.prepare_moved(before, &scene, &self.plan.settings, host);
                Ok((host.during(BUILDING, prepare)?, String::new()))
            }
        }
    }

    /// Exposure and step for the whole film, from frames across it: whichever of them are rendered, and by however many runs.
    fn chosen_across(&self, context: Context) -> Result<Chosen, Error> {
        let Context { renderer, host, .. } = context;
        let settings = &self.plan.settings;
        let asks_step = settings.has_light_points() && matches!(settings.step, None | Some(Step::Auto));
        if !(self.metering.is_automatic() || asks_step) {
            return Ok(Chosen::default());
        }
        let (mut exposures, mut steps) = (Vec::new(), Vec::new());
        let quiet = Quiet(host);
        let quietly = Context { host: &quiet, ..context };
        let mut numbers: Vec<u32> = (0..SAMPLES)
            .map(|sample| 1 + (u64::from(self.last - 1) * u64::from(sample) / u64::from(SAMPLES - 1)) as u32)
            .collect();
        numbers.dedup();
        for &number in &numbers {
            let (prepared, _) = self.at(number, &self.base, context)?;
            let render = |prepared: &PreparedScene, settings: &Settings, _: &dyn Host| {
                renderer.render_prepared(prepared, settings, &quiet)
            };
            if self.metering.is_automatic() {
                let (_, stops) = quietly.picture(&prepared, &reduced(settings), &self.metering, render)?;
                exposures.push(stops);
            }
            if asks_step {
                // The step depends on the whole image, of which one pixel is rendered.
                let pixel = settings.clone().with_crop(Crop::new([0, 0], [1, 1]));
                steps.extend(render(&prepared, &pixel, &quiet)?.stats.settings.step);
            }
        }
        let chosen = Chosen { exposure: median(exposures), step: median(steps) };
        let count = numbers.len();
        if let Some(stops) = chosen.exposure {
            host.note(&format!("exposure auto: using {stops} stops, from {count} frames across the film"));
        }
        if let Some(step) = chosen.step {
            host.note(&format!("step auto: using {step}, from {count} frames across the film"));
        }
        Ok(chosen)
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
pub(crate) fn explain(scene: &Scene, is_film: bool, host: &dyn Host) {
    let Some(animation) = scene.animation() else { return };
    let (seconds, words) = (animation.duration(), host.words());
    if !is_film {
        host.note(&format!(
            "the scene moves for {seconds:.2} s; this image shows it at rest ({} renders the film, {} a part of it)",
            words.with("fps", 24),
            words.of("frames")
        ));
    } else if !animation.others().is_empty() {
        let quoted = |names: &[String]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let (names, others) = (quoted(animation.names()), quoted(animation.others()));
        host.note(&format!(
            "animation {names}: {seconds:.2} s; the scene also has {others} ({} plays another)",
            words.of("animation")
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

/// What was done.
pub(crate) fn summary(range: &FrameRange, elapsed: Duration, name: &str, load: f64) -> String {
    let (count, seconds) = (range.numbers.len(), elapsed.as_secs_f64());
    let skipped = match range.skipped {
        0 => String::new(),
        skipped => format!(", {skipped} kept"),
    };
    if count == 0 {
        return format!("no frame is missing: {} kept", range.skipped);
    }
    let frames = if count == 1 { "frame" } else { "frames" };
    format!(
        "{name}: {count} {frames}{skipped}: {seconds:.3} s, {:.2} per second (load {load:.3} s)",
        count as f64 / seconds
    )
}
