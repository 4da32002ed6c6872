//! The work on a plan: a scene that is opened, staged and prepared, and then rendered as a picture, a film or a sun study.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use lightmesh_render::{Frame, PreparedScene, Renderer, Settings};
use lightmesh_scene::Scene;

use crate::cluster::staged;
use crate::context::{Context, Prepared};
use crate::error::{Error, RequestError};
use crate::film::{self, Finished, FrameRange, FrameRenderer, FrameWriter, InFrame, RenderedFrame};
use crate::host::{BUILDING, Host, Parts};
use crate::mesh_file::Mesh;
use crate::plan::Plan;
use crate::save::save;
use crate::staged::Staged;
use crate::sun::{self, SunHours};
use crate::words::Words;

/// A scene that is staged and prepared as planned.
pub struct Session {
    prepared: Prepared,
    load: f64,
}

impl Plan {
    /// Reads the scene's file, which outputs must not overwrite, and tells its warnings.
    ///
    /// # Errors
    /// [`Error`].
    pub fn open(&self, host: &dyn Host) -> Result<Scene, Error> {
        let path = &self.order.scene;
        let scene =
            host.during(&format!("reading {}", path.display()), || Scene::open_with(path, &self.load_options()))?;
        self.files.outputs.keep_scene(&scene)?;
        scene.warnings.iter().for_each(|warning| host.warning_of_scene(warning));
        Ok(scene)
    }

    /// The frames to render, if it is a film: checks that it has those that are wanted, and that nothing is replaced unasked.
    ///
    /// # Errors
    /// [`RequestError`].
    pub fn range(&self, scene: &Scene) -> Result<Option<FrameRange>, RequestError> {
        self.film.as_ref().map(|film| film.work(&self.order, scene)).transpose()
    }
}

/// What to say if fewer threads are started than were `asked` for.
pub fn fewer_threads(asked: usize, renderer: &Renderer, words: Words) -> Option<String> {
    let started = renderer.threads();
    (started < asked).then(|| {
        format!(
            "{}: using {started}, since more are no faster on this machine; the image is the same",
            words.with("threads", asked)
        )
    })
}

impl Session {
    /// Stages and prepares a scene, which it took `load` seconds to read.
    ///
    /// # Errors
    /// [`Error`].
    pub fn begin(renderer: &Renderer, plan: Plan, scene: Scene, load: f64, host: &dyn Host) -> Result<Session, Error> {
        Session::begin_with(None, renderer, plan, scene, load, host)
    }

    /// The same with what an earlier session has `kept` of the scene, if it may be kept, and for the next one.
    pub(crate) fn begin_with(
        mut kept: Option<&mut Option<Staged>>,
        renderer: &Renderer,
        plan: Plan,
        mut scene: Scene,
        load: f64,
        host: &dyn Host,
    ) -> Result<Session, Error> {
        if let Some(asked) = plan.threads
            && let Some(text) = fewer_threads(asked.into(), renderer, host.words())
        {
            host.note(&text);
        }
        if let Some(text) = plan.files.misnamed(host.words()) {
            host.warning(&text);
        }
        let metering = staged(&plan, &mut scene, host)?;
        // What is of no use makes room.
        let _known = kept.as_mut().and_then(|kept| kept.take().filter(|kept| kept.is_shared_with(&mut scene)));
        let prepared = host.during(BUILDING, || renderer.prepare(&scene, &plan.settings, host))?;
        if let Some(kept) = kept {
            *kept = Staged::of(&scene, &prepared, &plan.settings);
        }
        film::explain(&scene, plan.film.is_some(), host);
        Ok(Session { prepared: Prepared { plan: Arc::new(plan), scene: prepared, metering }, load })
    }

    pub(crate) fn context<'a>(&'a self, renderer: &'a Renderer, host: &'a dyn Host) -> Context<'a> {
        Context { renderer, plan: &self.prepared.plan, load: self.load, host }
    }

    /// The scene as it is prepared.
    pub(crate) fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.prepared.plan
    }

    /// The scene as it is rendered.
    pub fn scene(&self) -> &Scene {
        &self.prepared.scene.scene
    }

    /// Writes the hours of direct sun, if they are asked for; returns what was done.
    ///
    /// # Errors
    /// [`Error`].
    pub fn write_sun_hours(&self, renderer: &Renderer, host: &dyn Host) -> Result<Option<String>, Error> {
        match &self.prepared.plan.sun {
            Some(study) => sun::write_hours(study, &self.prepared.scene, self.context(renderer, host)),
            None => Ok(None),
        }
    }

    /// Renders the picture; also returns its exposure in stops.
    ///
    /// # Errors
    /// [`Error`].
    pub fn picture(&self, renderer: &Renderer, host: &dyn Host) -> Result<(Frame, f32), Error> {
        let render = |prepared: &PreparedScene, settings: &Settings, host: &dyn Host| {
            renderer.render_prepared(prepared, settings, host)
        };
        self.context(renderer, host).picture(
            &self.prepared.scene,
            &self.prepared.plan.settings,
            &self.prepared.metering,
            render,
        )
    }

    /// Renders the picture and writes its files.
    ///
    /// # Errors
    /// [`Error`].
    pub fn write_picture(self, renderer: &Renderer, host: &dyn Host) -> Result<Frame, Error> {
        let Session { prepared: Prepared { plan, scene: prepared, metering }, load } = self;
        let context = Context { renderer, plan: &plan, load, host };
        let mut mesh = Mesh::open(&plan, (renderer, &prepared), false, host)?;
        let has_file = mesh.has_file();
        let render = |prepared: &PreparedScene, settings: &Settings, host: &dyn Host| match has_file {
            true => renderer.render_with(&mut mesh.cache, prepared, settings, host),
            false => renderer.render_prepared(prepared, settings, host),
        };
        let (mut frame, stops) = context.picture(&prepared, &plan.settings, &metering, render)?;
        mesh.check(host);
        let scene = prepared.scene.clone();
        // What no file needs leaves its memory to the encoders.
        let kept = has_file.then_some((prepared, mesh));
        save(&mut frame, stops, &plan.files, &scene, &metering, context)?;
        if let Some((prepared, mesh)) = kept.filter(|_| !host.cancelled()) {
            mesh.save(&prepared, host);
        }
        Ok(frame)
    }

    /// Renders the frames of a film in `range`, and writes their files; returns what was done.
    ///
    /// # Errors
    /// [`Error`]; frames that are finished stay.
    pub fn write_film(&self, range: FrameRange, renderer: &Renderer, host: &dyn Host) -> Result<String, Error> {
        film::write(&self.prepared, range, self.context(renderer, host))
    }

    /// The frames of a film, which are rendered one by one, and written if the plan has files. Exposure and step are chosen for the whole film first.
    ///
    /// # Errors
    /// [`Error`]; [`RequestError::NoFilm`] if nothing moves, [`RequestError::Requires`] if it is said what becomes of files of which there are none.
    pub fn frames(&self, renderer: &Renderer, host: &dyn Host) -> Result<Frames, Error> {
        let order = &self.plan().order;
        if let (None, Some(setting)) = (&order.files.output, order.request.of_existing_frames()) {
            return Err(RequestError::Requires { setting, needed: "output" }.into());
        }
        let mut range = self.plan().range(self.scene())?.ok_or(RequestError::NoFilm)?;
        let context = self.context(renderer, host);
        let (frames, writer) = if self.prepared.plan.order.files.output.is_some() {
            let (frames, writer) = film::begin(&self.prepared, &mut range, context)?;
            (frames, Some(writer))
        } else {
            let mut frames = FrameRenderer::new(&self.prepared, &range, context)?;
            if !range.numbers.is_empty() {
                frames.keep(host.cancellable(|| frames.chosen_across(context))?);
            }
            (frames, None)
        };
        Ok(Frames {
            plan: Arc::clone(&self.prepared.plan),
            frames,
            writer,
            load: self.load,
            parts: Parts::new(range.numbers.len()),
            left: range.numbers.into_iter(),
            ahead: VecDeque::new(),
        })
    }

    /// The hours of direct sun on what the picture shows.
    ///
    /// # Errors
    /// [`Error`]; [`RequestError::Missing`] if no sun study is asked for, [`RequestError::OfFilm`] if frames are.
    pub fn sun_hours(&self, renderer: &Renderer, host: &dyn Host) -> Result<SunHours, Error> {
        let study = self.plan().sun.as_ref().ok_or(RequestError::Missing { setting: "sun" })?;
        if let Some(setting) = self.plan().order.request.of_frames().next() {
            return Err(RequestError::OfFilm { setting, has_hours: true }.into());
        }
        SunHours::of_study(study, &self.prepared.scene, true, self.context(renderer, host))
    }
}

/// The frames of a film, one by one.
pub struct Frames {
    plan: Arc<Plan>,
    frames: FrameRenderer,
    /// `None` if frames are not written, or all are.
    writer: Option<FrameWriter>,
    load: f64,
    parts: Parts,
    left: std::vec::IntoIter<u32>,
    /// What several devices have rendered at the same time, in its order, and at last why there is no more.
    ahead: VecDeque<Result<Finished, InFrame>>,
}

impl Frames {
    /// Renders the next frame, and writes it; `None` after the last one. After an error there is none. Several devices render as many frames, of which
    /// later calls return the others.
    pub fn next(&mut self, renderer: &Renderer, host: &dyn Host) -> Option<Result<RenderedFrame, Error>> {
        if self.ahead.is_empty() {
            self.render_ahead(renderer, host);
        }
        let next = match self.ahead.pop_front() {
            Some(finished) => {
                let context = Context { renderer, plan: &self.plan, load: self.load, host };
                finished.and_then(|finished| finished.written(self.writer.as_mut(), context))
            }
            None => match self.left.next() {
                Some(number) => self.render(number, renderer, host),
                None => {
                    let closed = self.writer.take()?.close();
                    self.frames.save_mesh(host);
                    return closed.err().map(Err);
                }
            },
        };
        Some(next.map_err(|InFrame { number, cause }| {
            (self.left, self.ahead) = (Vec::new().into_iter(), VecDeque::new());
            match self.writer.take() {
                Some(writer) => writer.fail(number, *cause),
                None => *cause,
            }
        }))
    }

    /// Renders a frame, and writes it.
    fn render(&mut self, number: u32, renderer: &Renderer, host: &dyn Host) -> Result<RenderedFrame, InFrame> {
        let (start, part) = (Instant::now(), self.parts.next(host));
        let context = Context { renderer, plan: &self.plan, load: self.load, host: &part };
        let rendered = host.cancellable(|| match &mut self.writer {
            Some(writer) => writer.next(number, &mut self.frames, context),
            None => self.frames.render(number, context),
        });
        self.parts.took(start.elapsed().as_secs_f64());
        rendered.map_err(|cause| InFrame::new(number, cause))
    }

    /// Renders a frame on each of several devices, if there are as many.
    fn render_ahead(&mut self, renderer: &Renderer, host: &dyn Host) {
        let devices = film::devices(renderer);
        if devices.len().min(self.left.len()) < 2 {
            return;
        }
        let numbers: Vec<u32> = self.left.by_ref().take(devices.len()).collect();
        let (start, part) = (Instant::now(), self.parts.several(numbers.len(), host));
        let context = Context { renderer, plan: &self.plan, load: self.load, host: &part };
        let (finished, all) = host.cancellable(|| film::render_ahead(&mut self.frames, &numbers, &devices, context));
        self.ahead = finished.into_iter().map(Ok).chain(all.err().map(Err)).collect();
        self.parts.several_took(numbers.len(), start.elapsed().as_secs_f64());
    }

    /// How many frames are left.
    pub fn left(&self) -> usize {
        self.left.len() + self.ahead.iter().filter(|finished| finished.is_ok()).count()
    }

    /// What is planned.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }
}

/// What is finished stays known when nobody asks for the rest.
impl Drop for Frames {
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            // Nobody is there to hear of it; at worst, frames are rendered again.
            let _ = writer.stop();
        }
    }
}
