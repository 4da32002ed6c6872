//! The way of one image: it is admitted, rendered, developed and cropped.
//!
//! 1. *Admit*: settings are checked and resolved, and there is enough memory.
//! 2. *Render*: the passes fill the picture, with what is kept from earlier images.
//! 3. *Develop*: what the passes left becomes what was asked for: rows without content, transparency, mattes.
//! 4. *Crop*: the part that was asked for, of all that it depends on.

use std::sync::Arc;
use std::time::Instant;

use glam::Vec3;
use lightmesh_memory::Budget;

use super::frame::Frame;
use super::report::{self, DeviceFacts};
use super::resolve::Resolved;
use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, Cpu};
use crate::cache::Cache;
use crate::data::picture::Picture;
use crate::error::RenderError;
use crate::observer::{Observer, Unobserved};
use crate::passes::Passes;
use crate::plan::Plan;
use crate::prepared::PreparedScene;
use crate::render_context::RenderContext;
use crate::settings::{Crop, Settings};
use crate::shading::ids::catchers;
use crate::shadow::rows::KnownRows;
use crate::stages::irradiance_cache::Sources;
use crate::stats::Stats;

/// Renders one image, with the `cache` of this backend, and the rows of samples that images share.
pub(super) fn picture_on<B: Backend>(
    backend: &B,
    cache: Option<&mut Cache<B::Table>>,
    rows: &Arc<KnownRows>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    crop(picture_around(backend, cache, rows, scene, settings, observer)?, settings.crop)
}

/// The same with the pixels around on which those that were asked for depend: they are not exact.
pub(super) fn picture_around<B: Backend>(
    backend: &B,
    mut cache: Option<&mut Cache<B::Table>>,
    rows: &Arc<KnownRows>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    let start = Instant::now();
    let open = without_background(scene, settings);
    let scene = open.as_ref().unwrap_or(scene);

    let resolved = admit(backend, cache.as_deref_mut(), scene, settings, observer)?;
    let context = resolved.context(observer).with_rows(rows);
    let rendered = render(backend, cache, &context, &resolved);
    let (picture, rows_at_once) = rendered.map_err(|error| resolved.advise(error))?;
    if picture.finished == resolved.plan.size[1] {
        context.work.finish(observer);
    }
    let seconds = start.elapsed().as_secs_f64();
    let stats = report::stats(&context, &resolved, DeviceFacts::of(backend), rows_at_once, seconds);
    Ok(develop(picture, &resolved, stats))
}

/// An image of which nothing is finished.
pub(super) fn unfinished(scene: &PreparedScene, settings: &Settings) -> Result<lightmesh_image::Frame, RenderError> {
    let open = without_background(scene, settings);
    let scene = open.as_ref().unwrap_or(scene);
    let resolved = Resolved::new(scene, settings, &Unobserved)?;
    let rows = 0..resolved.plan.size[1];
    let picture = Picture::planned(&resolved.plan, [rows.clone(), rows]);
    let context = resolved.context(&Unobserved);
    let stats = report::stats(&context, &resolved, DeviceFacts::of(&Cpu), 0, 0.0);
    let image = develop(picture, &resolved, stats).image;
    let crop = settings.crop.unwrap_or(Crop::new([0, 0], settings.size));
    Ok(image.cropped(crop.first, crop.size).expect("the window has all pixels of the crop"))
}

/// The scene for a transparent image. Where the camera sees nothing, that has nothing; mirrors still reflect the environment.
fn without_background(scene: &PreparedScene, settings: &Settings) -> Option<PreparedScene> {
    let hidden = settings.transparent && scene.scene.lights.environment.is_some();
    hidden.then(|| scene.with_lights(scene.scene.lights.clone().with_background(Vec3::ZERO)))
}

/// 1. Resolves the settings, and rejects what cannot be rendered before any of it is.
fn admit<'a, B: Backend>(
    backend: &B,
    cache: Option<&mut Cache<B::Table>>,
    scene: &'a PreparedScene,
    settings: &'a Settings,
    observer: &dyn Observer,
) -> Result<Resolved<'a>, RenderError> {
    backend.check_structure(scene.geometry.acceleration())?;
    let mut resolved = Resolved::new(scene, settings, observer)?;
    resolved.plan.kept = cache.as_ref().map_or(0, |cache| cache.memory());
    if let Err(short) = backend.check_host_memory(&resolved.plan) {
        // What is kept gives way to what is needed.
        match cache {
            Some(cache) if !cache.is_empty() => cache.clear(),
            _ => return Err(resolved.advise(short)),
        }
        resolved.plan.left = Budget::new(resolved.plan.memory_limit).left();
        backend.check_host_memory(&resolved.plan).map_err(|short| resolved.advise(short))?;
    }
    Ok(resolved)
}

/// 2. What the passes make of the scene, and how many rows were rendered at once. Of an image that was stopped, the rows that are finished if
///    these are asked for.
fn render<B: Backend>(
    backend: &B,
    cache: Option<&mut Cache<B::Table>>,
    context: &RenderContext,
    resolved: &Resolved,
) -> Result<(Picture, u32), RenderError> {
    let Resolved { scene, settings, technique, view, plan, .. } = resolved;
    let rows = 0..plan.size[1];
    let mut picture = Picture::planned(plan, [rows.clone(), rows]);
    let runner = StageRunner::new(backend, context, cache);
    let on_device = runner.or_evict(|backend| backend.scene(context, scene, plan.memory_limit))?;
    let plan = &Plan { reserved: reserved(&runner, &on_device, settings, plan), ..plan.clone() };
    let sources = plan.gathering.as_ref().map(|how| Sources::new(scene, settings.seed, how));
    if let Some(sources) = &sources {
        runner.lookup_gathered(scene, sources);
    }
    let transmission_parts = backend.transmission_parts(&on_device);
    let passes = Passes { runner, scene: &on_device, transmission_parts, technique, view, plan };
    let rendered = passes.render(&mut picture);
    // What a cancelled image gathered is not complete.
    if let (Ok(_), Some(sources)) = (&rendered, sources) {
        passes.runner.insert_gathered(scene, sources);
    }
    let rows = match rendered {
        Err(RenderError::Cancelled) if settings.partial && picture.finished > 0 => plan.most_rows.unwrap_or_default(),
        rows => rows?,
    };
    Ok((picture, rows))
}

/// Bytes by which what is kept of light points may grow.
fn reserved<B: Backend>(runner: &StageRunner<B>, scene: &B::Scene, settings: &Settings, plan: &Plan) -> u64 {
    if !settings.has_light_points() {
        return 0;
    }
    let reserved = runner.reserve(runner.backend.left(plan));
    if runner.backend.rows_at_once(scene, &Plan { reserved, ..plan.clone() }).is_ok() {
        return reserved;
    }
    // All of it is needed for the image.
    runner.reserve(Some(0));
    0
}

/// 3. The frame of a picture, with its own statistics.
fn develop(mut picture: Picture, resolved: &Resolved, mut stats: Stats) -> Frame {
    let Resolved { scene, settings, view, plan, .. } = resolved;
    stats.finished_rows = (picture.finished < plan.size[1]).then_some(picture.finished);
    stats.counts.pixels = u64::from(plan.size[0]) * u64::from(picture.finished);
    stats.counts.non_finite_pixels = picture.non_finite();
    if plan.compositing {
        let objects = scene.scene.geometry.mesh.objects.names().map(str::to_owned).collect();
        picture.complete_mattes([objects, scene.geometry.materials.names.clone()], plan.antialiasing.is_none());
    }
    let background = scene.scene.lights.background.unwrap_or_default();
    picture.fill_unfinished(background);
    if settings.transparent {
        if !plan.coverage {
            picture.find_coverage();
        }
        picture.uncover_caught(if plan.caught { catchers(scene) } else { Default::default() });
        picture.take_out(background);
    }
    if !settings.layers {
        picture.layers = None;
    }
    let window = view.window();
    Frame { image: picture.into_frame().with_window(window.first, window.whole), stats }
}

/// 4. The part of a frame that was asked for.
fn crop(frame: Frame, crop: Option<Crop>) -> Result<Frame, RenderError> {
    let Some(crop) = crop else { return Ok(frame) };
    let part = frame.cropped(crop).expect("the window has all pixels of the crop");
    if part.finished_rows() == 0 { Err(RenderError::Cancelled) } else { Ok(part) }
}
