//! What stays from order to order in a program that serves many of them: the renderer with its device, and the scene that was read last with the
//! structure over it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use std::{env, fs};

use lightmesh_render::{Choice, Device, RenderError, Renderer};
use lightmesh_scene::{LoadOptions, Scene};

use crate::error::Error;
use crate::host::Host;
use crate::plan::Plan;
use crate::session::Session;
use crate::staged::Staged;

/// A file that changed so shortly before it was read may change again without another time: some file systems count in two seconds.
const UNSETTLED: Duration = Duration::from_secs(2);

/// What stays warm; nothing at first. What an order needs otherwise is made anew and replaces it: another device, another scene, a scene of which a
/// file has changed. By default, for one order alone, no scene stays: its memory is left to the encoders.
#[derive(Default)]
pub struct Warm {
    keeps_scenes: bool,
    devices: Option<WarmDevices>,
    scene: Option<WarmScene>,
}

/// The devices that were asked for, and a renderer on them.
#[derive(Clone)]
pub struct WarmDevices {
    asked: (Device, Option<usize>),
    /// The renderer.
    pub renderer: Arc<Renderer>,
    /// [`Choice::reason`].
    pub reason: String,
    /// [`Choice::no_cuda`].
    pub no_cuda: Option<String>,
    /// [`Choice::misses_cuda`].
    pub misses_cuda: bool,
}

/// A scene that was read.
struct WarmScene {
    read: Reading,
    files: Vec<Stamp>,
    scene: Scene,
    staged: Option<Staged>,
}

/// What a scene was read from, and how. Names of files count from the current folder.
#[derive(PartialEq)]
struct Reading {
    path: PathBuf,
    folder: Option<PathBuf>,
    options: LoadOptions,
}

/// A file of the scene, and what changes with it; `None` if it is not there.
#[derive(PartialEq)]
struct Stamp(PathBuf, Option<Status>);

/// What of a file changes when it is written or replaced.
#[derive(PartialEq)]
struct Status {
    modified: SystemTime,
    bytes: u64,
    /// Device, number, and when it was last changed in any way, in nanoseconds: copies and archives may set the other time.
    #[cfg(unix)]
    place: (u64, u64, i128),
}

impl Warm {
    /// For many orders, between which the scene stays.
    pub fn for_many() -> Warm {
        Warm { keeps_scenes: true, ..Warm::default() }
    }

    /// A renderer on the devices of a plan.
    ///
    /// # Errors
    /// Those of [`Choice::of`] and [`Renderer::on`].
    pub fn devices(&mut self, plan: &Plan) -> Result<WarmDevices, RenderError> {
        let asked = (plan.order.request.device, plan.threads.map(usize::from));
        if let Some(known) = self.devices.as_ref().filter(|known| known.asked == asked) {
            return Ok(known.clone());
        }
        // What is on the other device goes first.
        self.devices = None;
        self.scene.iter_mut().for_each(|scene| scene.staged = None);
        let choice = Choice::of(asked.0)?;
        let (reason, no_cuda, misses_cuda) = (choice.reason.clone(), choice.no_cuda.clone(), choice.misses_cuda);
        let renderer = Arc::new(Renderer::on(choice, asked.1)?);
        Ok(self.devices.insert(WarmDevices { asked, renderer, reason, no_cuda, misses_cuda }).clone())
    }

    /// The scene of a plan, which is read by `read` unless it is known, and all of its files are as they were.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn scene<E>(&mut self, plan: &Plan, read: impl FnOnce() -> Result<Scene, E>) -> Result<Scene, E> {
        let reading =
            Reading { path: plan.order.scene.clone(), folder: env::current_dir().ok(), options: plan.load_options() };
        if let Some(known) = self.scene.as_ref().filter(|known| known.read == reading && known.is_unchanged()) {
            return Ok(known.scene.clone());
        }
        // Two scenes may be more than there is room for.
        self.scene = None;
        let begin = SystemTime::now();
        let scene = read()?;
        if !self.keeps_scenes {
            return Ok(scene);
        }
        let files: Vec<Stamp> = scene.files.iter().map(|file| Stamp::of(file)).collect();
        if !plan.order.is_from_stdin() && files.iter().all(|file| file.is_settled(begin)) {
            self.scene = Some(WarmScene { read: reading, files, scene: scene.clone(), staged: None });
        }
        Ok(scene)
    }

    /// Stages and prepares a [scene](Warm::scene), as [`Session::begin`] does.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn session(
        &mut self,
        renderer: &Renderer,
        plan: Plan,
        scene: Scene,
        load: f64,
        host: &dyn Host,
    ) -> Result<Session, Error> {
        let staged = self.scene.as_mut().map(|known| &mut known.staged);
        Session::begin_with(staged, renderer, plan, scene, load, host)
    }
}

impl WarmScene {
    fn is_unchanged(&self) -> bool {
        self.files.iter().all(|file| *file == Stamp::of(&file.0))
    }
}

impl Stamp {
    fn of(path: &Path) -> Stamp {
        let status = fs::metadata(path).ok().filter(fs::Metadata::is_file);
        Stamp(path.to_owned(), status.and_then(|status| Status::of(&status)))
    }

    /// Whether a change since would be seen. What is there and is no file, such as a pipe, can be read once only.
    fn is_settled(&self, begin: SystemTime) -> bool {
        match &self.1 {
            Some(status) => begin.duration_since(status.modified).is_ok_and(|age| age > UNSETTLED),
            None => !self.0.exists(),
        }
    }
}

impl Status {
    fn of(status: &fs::Metadata) -> Option<Status> {
        #[cfg(unix)]
        use std::os::unix::fs::MetadataExt;
        Some(Status {
            modified: status.modified().ok()?,
            bytes: status.len(),
            #[cfg(unix)]
            place: (
                status.dev(),
                status.ino(),
                i128::from(status.ctime()) * 1_000_000_000 + i128::from(status.ctime_nsec()),
            ),
        })
    }
}
