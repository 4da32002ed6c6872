//! A worker: a scene that is prepared on a device, and the frames and rows that are rendered of it as they are asked for.

use std::time::Instant;

use lightmesh_files::directory;
use lightmesh_render::{Choice, Renderer};
use lightmesh_scene::glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{Band, Chosen, FileRecord, Input, Pass};
use crate::error::{ClusterError, Error, RequestError};
use crate::film::{FrameRange, FrameRenderer};
use crate::host::{Host, RENDERING};
use crate::manifest;
use crate::order::Order;
use crate::plan::Plan;
use crate::save::save;
use crate::session::Session;

/// A scene that is prepared on a device.
pub struct Worker {
    renderer: Renderer,
    session: Session,
    inputs: Vec<Input>,
    /// What goes from frame to frame, if it is a film.
    frames: Option<FrameRenderer>,
}

/// A frame that a worker has written.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FrameWritten {
    /// Its files, for the log.
    pub files: Vec<FileRecord>,
    /// Seconds that the image took.
    pub render: f64,
    /// Seconds that its files took.
    pub write: f64,
}

impl Worker {
    /// Reads, stages and prepares the scene of an order [for workers](super::for_workers).
    ///
    /// # Errors
    /// [`Error`].
    pub fn open(order: Order, threads: Option<usize>, host: &dyn Host) -> Result<Worker, Error> {
        let plan = Plan::new(order)?;
        let renderer = Renderer::on(Choice::of(plan.order.request.device)?, plan.threads.map(usize::from).or(threads))?;
        let start = Instant::now();
        let scene = plan.open(host)?;
        let inputs = Input::all_of(&plan.order, &scene)?;
        let session = Session::begin(&renderer, plan, scene, start.elapsed().as_secs_f64(), host)?;
        Ok(Worker { renderer, session, inputs, frames: None })
    }

    /// The files that the scene was read from.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The CPU threads that it renders and encodes with.
    pub fn threads(&self) -> usize {
        self.renderer.threads()
    }

    /// Exposure and step for a whole film.
    ///
    /// # Errors
    /// [`Error`].
    pub fn choose(&self, host: &dyn Host) -> Result<Chosen, Error> {
        let frames =
            FrameRenderer::new(self.session.prepared(), &self.range()?, self.session.context(&self.renderer, host))?;
        frames.chosen_across(self.session.context(&self.renderer, host))
    }

    /// Renders a frame with what was chosen for the film, and publishes its files.
    ///
    /// # Errors
    /// [`Error`]; then the files are not there, or as they were.
    pub fn frame(&mut self, number: u32, chosen: Chosen, host: &dyn Host) -> Result<FrameWritten, Error> {
        let context = self.session.context(&self.renderer, host);
        if self.frames.is_none() {
            self.frames = Some(FrameRenderer::new(self.session.prepared(), &self.range()?, context)?);
        }
        let frames = self.frames.as_mut().ok_or(RequestError::NoFilm)?;
        frames.keep(chosen);
        let plan = context.plan;
        let files = plan.film.as_ref().ok_or(RequestError::NoFilm)?.files(&plan.order, number)?;
        let mut rendered = frames.render(number, context)?;
        save(&mut rendered.frame, rendered.stops, &files, &rendered.scene, frames.metering(), context)?;
        let seconds = &rendered.frame.stats.seconds;
        let records = manifest::records_of(&files, directory(plan.order.files.picture()))?;
        Ok(FrameWritten { files: records, render: seconds.render, write: seconds.write })
    }

    /// Renders rows of a pass, from row `first` of the image on.
    ///
    /// # Errors
    /// [`Error`]; [`ClusterError::Rows`] for rows that the pass does not have.
    pub fn band(&self, pass: &Pass, first: i64, rows: u32, host: &dyn Host) -> Result<Band, Error> {
        let crop = pass.crop_of(first, rows).ok_or(ClusterError::Rows { first, rows })?;
        let prepared = &self.session.prepared().scene;
        let settings = &self.session.plan().settings;
        let mut settings = settings.clone().with_crop(crop);
        settings.transparent = pass.transparent;
        let lit = pass.background.map(|background| {
            prepared.with_lights(prepared.scene.lights.clone().with_background(Vec3::from_array(background)))
        });
        let render = || self.renderer.render_prepared(lit.as_ref().unwrap_or(prepared), &settings, host);
        let frame = host.during(RENDERING, || host.cancellable(render))?;
        Ok(Band::new(first, frame))
    }

    fn range(&self) -> Result<FrameRange, Error> {
        Ok(self.session.plan().range(self.session.scene())?.ok_or(RequestError::NoFilm)?)
    }
}
