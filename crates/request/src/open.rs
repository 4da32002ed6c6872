//! From a file to a picture, a film or a sun study of it, in one call.

use std::ops::Deref;
use std::path::Path;
use std::time::Instant;

use lightmesh_image::{SaveError, SaveOptions, publish};
use lightmesh_render::{Choice, Frame, Renderer, Unobserved};
use lightmesh_scene::Scene;

use crate::error::Error;
use crate::files::{Files, save_options};
use crate::film::RenderedFrame;
use crate::host::Host;
use crate::order::Order;
use crate::plan::Plan;
use crate::request::Request;
use crate::save::{describe, stored};
use crate::session::{Frames, Session};
use crate::sun::SunHours;

/// A picture with what its files need to know: exposure, view, how they are compressed. It is a [`Frame`] otherwise.
pub struct Picture {
    frame: Frame,
    stops: f32,
    options: SaveOptions,
}

impl Picture {
    fn new(frame: Frame, stops: f32, scene: &Scene, request: &Request) -> Picture {
        let options = stored(save_options(request), stops, describe(&frame, scene));
        Picture { frame, stops, options }
    }

    /// Writes a bmp, png, exr or jpg file: that of the command line with the same request.
    ///
    /// # Errors
    /// [`SaveError`]; no partial file is left.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        publish([self.frame.image.ready_with(path, &self.options)?]).map_err(SaveError::from)
    }

    /// Stops by which files are brightened.
    pub fn exposure(&self) -> f32 {
        self.stops
    }

    /// The image with its statistics.
    pub fn into_frame(self) -> Frame {
        self.frame
    }
}

impl Deref for Picture {
    type Target = Frame;

    fn deref(&self) -> &Frame {
        &self.frame
    }
}

/// Renders a picture of a file, or of a built-in scene, as `lightmesh render` does: with the camera, the lights and the exposure that it lacks.
///
/// ```no_run
/// use lightmesh_request::{Request, picture};
///
/// picture("model.glb", &Request { ground: true, ..Request::default() })?.save("model.png")?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Background and exposure are those of files that show colours. For an exr file as the command line writes it, set [`Request::format`].
///
/// # Errors
/// [`Error`].
pub fn picture(path: impl AsRef<Path>, request: &Request) -> Result<Picture, Error> {
    let opened = Opened::new(path.as_ref(), request, Files::default(), &Unobserved)?;
    let (frame, stops) = opened.session.picture(&opened.renderer, &Unobserved)?;
    Ok(Picture::new(frame, stops, opened.session.scene(), request))
}

/// The frames of a film of a file, by [`Request::turntable`], [`Request::sun`], [`Request::frames`] and [`Request::fps`]. If `files` has an output,
/// each frame is written before it is returned, or goes into a movie, and [`Request::resume`] leaves out what is there.
///
/// # Errors
/// [`Error`].
pub fn film<'a>(
    path: impl AsRef<Path>,
    request: &Request,
    files: Files,
    host: &'a dyn Host,
) -> Result<FilmFrames<'a>, Error> {
    let opened = Opened::new(path.as_ref(), request, files, host)?;
    let frames = opened.session.frames(&opened.renderer, host)?;
    Ok(FilmFrames { renderer: opened.renderer, frames, host })
}

/// The hours of direct sun on what a picture of a file shows, by [`Request::sun`].
///
/// # Errors
/// [`Error`].
pub fn sun_hours(path: impl AsRef<Path>, request: &Request) -> Result<SunHours, Error> {
    let opened = Opened::new(path.as_ref(), request, Files::default(), &Unobserved)?;
    opened.session.sun_hours(&opened.renderer, &Unobserved)
}

/// A session with its renderer.
struct Opened {
    renderer: Renderer,
    session: Session,
}

impl Opened {
    fn new(path: &Path, request: &Request, files: Files, host: &dyn Host) -> Result<Opened, Error> {
        let plan = Plan::new(Order { scene: path.to_owned(), request: request.clone(), files })?;
        let renderer = Renderer::on(Choice::of(request.device)?, plan.threads.map(usize::from))?;
        let start = Instant::now();
        let scene = plan.open(host)?;
        let session = Session::begin(&renderer, plan, scene, start.elapsed().as_secs_f64(), host)?;
        Ok(Opened { renderer, session })
    }
}

/// The frames of a film, in their order.
pub struct FilmFrames<'a> {
    renderer: Renderer,
    frames: Frames,
    host: &'a dyn Host,
}

impl Iterator for FilmFrames<'_> {
    type Item = Result<RenderedFrame, Error>;

    fn next(&mut self) -> Option<Result<RenderedFrame, Error>> {
        self.frames.next(&self.renderer, self.host)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.frames.left(), Some(self.frames.left() + 1))
    }
}
