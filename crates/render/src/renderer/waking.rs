//! Devices that are made while others work already: a driver takes a tenth of a second and more for each, and makes one after the other.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};

use lightmesh_kernels::new_id;

use super::frame::Frame;
use super::worker::Worker;
use crate::cache::MeshCache;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::prepared::PreparedScene;
use crate::settings::Settings;
use crate::sync::locked;

/// Makes a device.
pub type Make = Box<dyn FnOnce() -> Result<Box<dyn Worker>, RenderError> + Send>;

/// Devices with their names, which are made one after the other on a thread of their own. When they are dropped, the rest is not made.
///
/// # Errors
/// [`RenderError::Threads`] if the thread cannot be started.
pub fn waking(makes: Vec<(String, Make)>) -> Result<Vec<Box<dyn Worker>>, RenderError> {
    if makes.is_empty() {
        return Ok(Vec::new());
    }
    let names: Vec<String> = makes.iter().map(|(name, _)| name.clone()).collect();
    let maker = Arc::new(Maker::begin(makes)?);
    let waking = |(number, name)| Waking { name, id: new_id(), maker: Arc::clone(&maker), number };
    Ok(names.into_iter().enumerate().map(waking).map(|waking| Box::new(waking) as Box<dyn Worker>).collect())
}

/// A device that may not be there yet.
struct Waking {
    name: String,
    /// Until it is there.
    id: u64,
    maker: Arc<Maker>,
    number: usize,
}

/// Where devices are made.
struct Maker {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    places: Vec<Place>,
    is_dropped: AtomicBool,
}

/// Where a device is put.
#[derive(Default)]
struct Place {
    worker: OnceLock<Box<dyn Worker>>,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
enum State {
    #[default]
    Making,
    Made,
    /// It cannot be made, and why, unless that was told.
    Failed(Option<RenderError>),
}

impl Maker {
    fn begin(makes: Vec<(String, Make)>) -> Result<Maker, RenderError> {
        let places = makes.iter().map(|_| Place::default()).collect();
        let shared = Arc::new(Shared { places, is_dropped: AtomicBool::new(false) });
        let own = Arc::clone(&shared);
        let thread = thread::Builder::new().name("devices".to_owned()).spawn(move || own.make(makes));
        let thread = thread.map_err(|error| RenderError::Threads { threads: 1, reason: error.to_string() })?;
        Ok(Maker { shared, thread: Some(thread) })
    }
}

impl Drop for Maker {
    fn drop(&mut self) {
        self.shared.is_dropped.store(true, Ordering::Relaxed);
        // A driver must not end while it makes a device.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

impl Shared {
    fn make(&self, makes: Vec<(String, Make)>) {
        for (place, (name, make)) in self.places.iter().zip(makes) {
            if self.is_dropped.load(Ordering::Relaxed) {
                return;
            }
            // Others would wait for it.
            let panicked =
                |_| Err(RenderError::DeviceFault { device: name, reason: "it panicked on the way".to_owned() });
            place.put(catch_unwind(AssertUnwindSafe(make)).unwrap_or_else(panicked));
        }
    }
}

impl Place {
    fn put(&self, made: Result<Box<dyn Worker>, RenderError>) {
        let state = match made {
            Ok(worker) => {
                let _ = self.worker.set(worker);
                State::Made
            }
            Err(error) => State::Failed(Some(error)),
        };
        *locked(&self.state) = state;
        self.changed.notify_all();
    }
}

impl Waking {
    fn place(&self) -> &Place {
        &self.maker.shared.places[self.number]
    }

    fn worker(&self) -> Option<&dyn Worker> {
        self.place().worker.get().map(|worker| &**worker)
    }

    fn awake(&self) -> Result<&dyn Worker, RenderError> {
        let asleep = || RenderError::Device { device: self.name.clone(), reason: "it is not there yet".to_owned() };
        self.worker().ok_or_else(asleep)
    }
}

impl Worker for Waking {
    fn name(&self) -> String {
        self.worker().map_or_else(|| self.name.clone(), Worker::name)
    }

    fn id(&self) -> Option<u64> {
        self.worker().map_or(Some(self.id), Worker::id)
    }

    fn wake(&self, is_over: &dyn Fn() -> bool) -> Result<bool, RenderError> {
        let mut state = locked(&self.place().state);
        loop {
            match &mut *state {
                State::Made => return Ok(true),
                State::Failed(reason) => return reason.take().map_or(Ok(false), Err),
                State::Making if is_over() => return Ok(false),
                State::Making => {}
            }
            state = self.place().changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn nudge(&self) {
        // Who is about to wait holds the lock.
        drop(locked(&self.place().state));
        self.place().changed.notify_all();
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.awake()?.render(cache, scene, settings, observer)
    }

    fn render_around(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.awake()?.render_around(cache, scene, settings, observer)
    }
}
