//! Devices that wake while others work, for which renderers on the CPU stand.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use lightmesh_render::{
    Device, Frame, Make, MeshCache, Observer, PreparedScene, RenderError, Renderer, Settings, Unobserved, Worker,
    waking,
};
use lightmesh_scene::Scene;

/// How long a test waits for what must happen.
const PATIENCE: Duration = Duration::from_secs(60);

fn cpu() -> Arc<Renderer> {
    Renderer::with_threads(Device::Cpu, Some(1)).unwrap().into()
}

fn settings() -> Settings {
    Settings::default().with_size([40, 300])
}

fn refused() -> RenderError {
    RenderError::Device { device: "cuda:1".to_owned(), reason: "its memory is used up".to_owned() }
}

fn lost() -> RenderError {
    RenderError::Device { device: "cuda:0".to_owned(), reason: "it fell off the bus".to_owned() }
}

/// A device that does something before its first image, and counts them.
struct Standin {
    renderer: Arc<Renderer>,
    first: Mutex<Option<Before>>,
    rendered: Arc<AtomicUsize>,
}

type Before = Box<dyn FnOnce() -> Result<(), RenderError> + Send>;

impl Standin {
    fn new(rendered: &Arc<AtomicUsize>, first: impl FnOnce() -> Result<(), RenderError> + Send + 'static) -> Standin {
        let (rendered, first) = (Arc::clone(rendered), Mutex::new(Some(Box::new(first) as Before)));
        Standin { renderer: cpu(), first, rendered }
    }
}

impl Worker for Standin {
    fn name(&self) -> String {
        "a device".to_owned()
    }

    fn id(&self) -> Option<u64> {
        None
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        if let Some(first) = self.first.lock().unwrap().take() {
            first()?;
        }
        let frame = self.renderer.render_with(cache, scene, settings, observer)?;
        self.rendered.fetch_add(1, Ordering::SeqCst);
        Ok(frame)
    }
}

/// Keeps what is noted.
#[derive(Default)]
struct Notes(Mutex<Vec<String>>);

impl Observer for Notes {
    fn note(&self, text: &str) {
        self.0.lock().unwrap().push(text.to_owned());
    }
}

fn named(make: impl FnOnce() -> Result<Box<dyn Worker>, RenderError> + Send + 'static) -> (String, Make) {
    ("cuda:1".to_owned(), Box::new(make))
}

/// A renderer by a device that is ready and others that are made.
fn renderer(first: impl Worker + 'static, makes: Vec<(String, Make)>) -> Renderer {
    let mut workers: Vec<Box<dyn Worker>> = vec![Box::new(first)];
    workers.extend(waking(makes).unwrap());
    Renderer::together(cpu(), workers, Some(2)).unwrap()
}

/// An image, and what it has to be.
struct Image {
    scene: PreparedScene,
    image: lightmesh_image::Frame,
}

fn park() -> Image {
    let renderer = cpu();
    let scene = renderer.prepare(&Scene::open("builtin:childpark").unwrap(), &settings(), &Unobserved).unwrap();
    let image = renderer.render_prepared(&scene, &settings(), &Unobserved).unwrap().image;
    Image { scene, image }
}

impl Image {
    fn is_rendered_by(&self, renderer: &Renderer, observer: &dyn Observer) -> bool {
        renderer.render_prepared(&self.scene, &settings(), observer).unwrap().image == self.image
    }
}

/// Waits for word that comes from a test.
fn wait_for(word: &Receiver<()>) {
    word.recv_timeout(PATIENCE).expect("it does not happen");
}

fn channel() -> (Sender<()>, Receiver<()>) {
    mpsc::channel()
}

#[test]
fn an_image_does_not_wait_for_a_device_that_wakes() {
    let (park, rendered) = (park(), Arc::default());
    let (go_on, word) = channel();
    let make = named(move || {
        wait_for(&word);
        Ok(Box::new(cpu()))
    });
    let renderer = renderer(Standin::new(&rendered, || Ok(())), vec![make]);
    // Nobody lets the other one go on before that.
    assert!(park.is_rendered_by(&renderer, &Unobserved) && rendered.load(Ordering::SeqCst) > 0);
    assert!(park.is_rendered_by(&renderer, &Unobserved));
    go_on.send(()).unwrap();
}

#[test]
fn a_device_that_wakes_joins_an_image_in_progress() {
    let (park, rendered) = (park(), Arc::<AtomicUsize>::default());
    let (begun, has_begun) = channel();
    let (joined, has_joined) = channel();
    let first = Standin::new(&Arc::default(), move || {
        begun.send(()).unwrap();
        wait_for(&has_joined);
        Ok(())
    });
    let counted = Arc::clone(&rendered);
    let make = named(move || {
        wait_for(&has_begun);
        let joins = move || {
            joined.send(()).unwrap();
            Ok(())
        };
        Ok(Box::new(Standin::new(&counted, joins)))
    });
    let renderer = renderer(first, vec![make]);
    assert!(park.is_rendered_by(&renderer, &Unobserved) && rendered.load(Ordering::SeqCst) > 0);
}

#[test]
fn that_a_device_cannot_be_made_is_said_once() {
    let park = park();
    let renderer = renderer(
        cpu(),
        vec![named(|| Err(refused())), named(|| panic!("a driver's fault")), named(|| Ok(Box::new(cpu())))],
    );
    let notes = Notes::default();
    // At some time it is known.
    let start = Instant::now();
    let count = |notes: &Notes, what: &str| notes.0.lock().unwrap().iter().filter(|note| note.contains(what)).count();
    while count(&notes, "it panicked") == 0 {
        assert!(park.is_rendered_by(&renderer, &notes) && start.elapsed() < PATIENCE);
    }
    assert!(park.is_rendered_by(&renderer, &notes));
    let refusals = count(&notes, "cuda:1 cannot be used: its memory is used up; other devices render its part");
    assert_eq!((refusals, count(&notes, "it panicked")), (1, 1));
}

#[test]
fn a_device_that_wakes_takes_the_rows_of_one_that_has_failed() {
    let park = park();
    for is_sound in [true, false] {
        let (failed, has_failed) = channel();
        let first = Standin::new(&Arc::default(), move || {
            failed.send(()).unwrap();
            Err(lost())
        });
        let make = named(move || {
            wait_for(&has_failed);
            if is_sound { Ok(Box::new(cpu())) } else { Err(refused()) }
        });
        let renderer = renderer(first, vec![make]);
        if is_sound {
            assert!(park.is_rendered_by(&renderer, &Unobserved));
        } else {
            let failed = renderer.render_prepared(&park.scene, &settings(), &Unobserved);
            assert!(failed.is_err_and(|error| error.to_string() == lost().to_string()));
        }
    }
}

#[test]
fn what_is_dropped_is_not_made() {
    let is_made = Arc::new(AtomicBool::new(false));
    let (begun, has_begun) = channel();
    let slow = named(move || {
        begun.send(()).unwrap();
        std::thread::sleep(Duration::from_millis(100));
        Ok(Box::new(cpu()))
    });
    let made = Arc::clone(&is_made);
    let never = named(move || {
        made.store(true, Ordering::SeqCst);
        Err(refused())
    });
    let renderer = renderer(cpu(), vec![slow, never]);
    wait_for(&has_begun);
    drop(renderer);
    std::thread::sleep(Duration::from_millis(100));
    assert!(!is_made.load(Ordering::SeqCst));
}
