//! Films on several devices, for which renderers on the CPU stand: each renders whole frames, and the files are those of one device.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use lightmesh::render::{Make, MeshCache, PreparedScene, Progress, Unobserved, Worker, waking};
use lightmesh::request::files::Files;
use lightmesh::request::{Error, FrameDone, Host, Order, Plan, Request, Session};
use lightmesh::{Device, Frame, Observer, RenderError, Renderer, Settings};
use lightmesh_memory::OverBudget;

/// How long a test waits for what must happen.
const PATIENCE: Duration = Duration::from_secs(60);

/// What has happened, for those who wait for it.
#[derive(Default)]
struct Log {
    events: Mutex<Events>,
    changed: Condvar,
}

#[derive(Default)]
struct Events {
    begun: usize,
    written: Vec<u32>,
    /// The most frames that were begun and not written.
    most: usize,
    /// Images that were not the whole.
    parts: usize,
    /// Whether a device has no memory.
    is_short: bool,
    told: Vec<Progress>,
    notes: Vec<String>,
}

impl Log {
    fn change(&self, change: impl FnOnce(&mut Events)) {
        change(&mut self.events.lock().unwrap());
        self.changed.notify_all();
    }

    /// Waits; fails if it does not happen.
    fn wait_until(&self, is_so: impl Fn(&Events) -> bool) {
        let events = self.events.lock().unwrap();
        let (events, late) = self.changed.wait_timeout_while(events, PATIENCE, |events| !is_so(events)).unwrap();
        drop(events);
        assert!(!late.timed_out(), "it does not happen");
    }
}

/// What a device does before it renders its image of a number, from 0 on.
type Before = fn(usize, &Log) -> Result<(), RenderError>;

/// A renderer that stands for a device.
struct Standin {
    number: usize,
    renderer: Arc<Renderer>,
    rendered: Mutex<usize>,
    before: Before,
    log: Arc<Log>,
}

impl Worker for Standin {
    fn name(&self) -> String {
        format!("device {}", self.number)
    }

    fn id(&self) -> Option<u64> {
        Some(self.number as u64)
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        let rendered = {
            let mut rendered = self.rendered.lock().unwrap();
            *rendered += 1;
            *rendered - 1
        };
        self.log.change(|events| {
            events.begun += 1;
            events.most = events.most.max(events.begun - events.written.len());
            events.parts += usize::from(settings.crop.is_some());
        });
        (self.before)(rendered, &self.log)?;
        self.renderer.render_with(cache, scene, settings, observer)
    }
}

/// Hears of a film.
struct Listener {
    log: Arc<Log>,
    /// What it does when a frame is written.
    written: fn(&Log),
    is_cancelled: fn(&Events) -> bool,
}

impl Observer for Listener {
    fn progress(&self, progress: Progress) {
        self.log.change(|events| events.told.push(progress));
    }

    fn note(&self, text: &str) {
        self.log.change(|events| events.notes.push(text.to_owned()));
    }

    fn cancelled(&self) -> bool {
        (self.is_cancelled)(&self.log.events.lock().unwrap())
    }
}

impl Host for Listener {
    fn frame(&self, frame: &FrameDone) {
        self.log.change(|events| events.written.push(frame.number));
        (self.written)(&self.log);
    }
}

fn cpu() -> Arc<Renderer> {
    Renderer::with_threads(Device::Cpu, Some(1)).unwrap().into()
}

/// A device on which nothing happens.
fn sound(_: usize, _: &Log) -> Result<(), RenderError> {
    Ok(())
}

/// A device that fails at once.
fn lost(_: usize, _: &Log) -> Result<(), RenderError> {
    Err(RenderError::Device { device: "cuda:7".to_owned(), reason: "it fell off the bus".to_owned() })
}

/// A device that fails at its second image.
fn frail(number: usize, log: &Log) -> Result<(), RenderError> {
    if number > 0 { lost(number, log) } else { Ok(()) }
}

/// A renderer by several devices, and what happens on them.
fn several(devices: &[Before]) -> (Renderer, Listener) {
    let (log, first) = (Arc::<Log>::default(), cpu());
    let standin = |(number, before): (usize, &Before)| {
        let renderer = if number == 0 { Arc::clone(&first) } else { cpu() };
        let (log, rendered, before) = (Arc::clone(&log), Mutex::default(), *before);
        Box::new(Standin { number, renderer, rendered, before, log }) as Box<dyn Worker>
    };
    let workers = devices.iter().enumerate().map(standin).collect();
    let renderer = Renderer::together(first, workers, Some(2)).unwrap();
    (renderer, Listener { log, written: |_| (), is_cancelled: |_| false })
}

fn order(scene: &Path, folder: &Path, settings: &[(&str, &str)]) -> Order {
    let mut request = Request::default();
    for &(setting, value) in [("size", "32x24"), ("quality", "draft")].iter().chain(settings) {
        request.set(setting, value).unwrap();
    }
    let files = Files { output: Some(folder.join("f.##.png")), ..Files::default() };
    Order { scene: scene.to_owned(), request, files }
}

/// Renders the film that is ordered, and writes its files.
fn write(order: &Order, renderer: &Renderer, host: &dyn Host) -> Result<(), Error> {
    let session = session(order, renderer);
    let range = session.plan().range(session.scene()).unwrap().unwrap();
    session.write_film(range, renderer, host).map(drop)
}

fn session(order: &Order, renderer: &Renderer) -> Session {
    let plan = Plan::new(order.clone()).unwrap();
    let scene = plan.open(&Unobserved).unwrap();
    Session::begin(renderer, plan, scene, 0.0, &Unobserved).unwrap()
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())).collect()
}

const GAZEBO: &str = "builtin:gazebo";

/// A ball goes up behind a box that turns, and a light goes around.
const MOVING: &str = "\
[camera]
position = [0, 1, 9]
target = [0, 0, 0]
vfov = 40
[ambient]
intensity = 0.3
[[light]]
kind = \"sphere\"
position = [4, 6, 4]
radius = 0.5
motion = { key = [{ time = 0, position = [4, 6, 4] }, { time = 1, position = [-4, 6, 4] }] }
[[sphere]]
center = [1.5, 0, -2]
radius = 1
motion = { key = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [0, 2, 0] }] }
[[box]]
center = [-1.5, 0, 0]
size = [1.5, 2, 1.5]
motion = { interpolation = \"linear\", key = [{ time = 0, rotate = [0, 0, 0] }, { time = 1, rotate = [0, 90, 0] }] }
[[plane]]
point = [0, -1, 0]
normal = [0, 1, 0]
size = [12, 12]
";

#[test]
fn the_files_and_the_manifest_are_those_of_one_device() {
    let place = tempfile::tempdir().unwrap();
    let moving = place.path().join("moving.toml");
    fs::write(&moving, MOVING).unwrap();
    let day = "52,13,2026-06-21+02:00,08:00-16:00/2h";
    let cases: [(&Path, &[(&str, &str)]); 5] = [
        (GAZEBO.as_ref(), &[("turntable", "6"), ("exposure", "auto")]),
        (GAZEBO.as_ref(), &[("turntable", "6"), ("lookup", "half-ball")]),
        (GAZEBO.as_ref(), &[("sun", day)]),
        (&moving, &[("fps", "6")]),
        (&moving, &[("fps", "6"), ("lookup", "half-ball"), ("step", "0.3")]),
    ];
    for (scene, settings) in cases {
        let folders = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let [one, all] = folders.each_ref().map(|folder| order(scene, folder.path(), settings));
        write(&one, &cpu(), &Unobserved).unwrap();
        let (renderer, host) = several(&[sound, sound, sound]);
        write(&all, &renderer, &host).unwrap();
        let [one, all] = folders.map(|folder| contents(folder.path()));
        assert!(one.len() > 5 && one == all, "{settings:?}: {:?} {:?}", one.keys(), all.keys());
        let Events { written, told, .. } = &*host.log.events.lock().unwrap();
        assert_eq!(written.len(), one.len() - 1, "a frame is told of once");
        assert!(told.windows(2).all(|pair| pair[0].done <= pair[1].done), "{told:?}");
        assert_eq!(told.last().unwrap().done, 1.0);
    }
}

#[test]
fn each_device_renders_frames_of_its_own_while_others_do() {
    /// Waits for another device to be at work.
    fn meet(_: usize, log: &Log) -> Result<(), RenderError> {
        log.wait_until(|events| events.begun >= 3);
        Ok(())
    }
    let folder = tempfile::tempdir().unwrap();
    let (renderer, host) = several(&[meet, meet, meet]);
    write(&order(GAZEBO.as_ref(), folder.path(), &[("turntable", "7")]), &renderer, &host).unwrap();
    let events = host.log.events.lock().unwrap();
    assert_eq!((events.begun, events.parts, events.written.len()), (7, 0, 7));
}

#[test]
fn a_slow_device_holds_up_no_files_and_a_slow_disk_holds_up_devices() {
    /// Renders nothing until others have written frames.
    fn slow(number: usize, log: &Log) -> Result<(), RenderError> {
        if number == 0 {
            log.wait_until(|events| events.written.len() >= 10);
        }
        Ok(())
    }
    let folder = tempfile::tempdir().unwrap();
    let film = order(GAZEBO.as_ref(), folder.path(), &[("turntable", "16")]);
    let (renderer, host) = several(&[slow, sound]);
    write(&film, &renderer, &host).unwrap();
    let written = host.log.events.lock().unwrap().written.clone();
    assert!(written.len() == 16 && !written.is_sorted(), "{written:?}");

    let (renderer, host) = several(&[sound, sound]);
    let host = Listener { written: |_| std::thread::sleep(Duration::from_millis(50)), ..host };
    let folder = tempfile::tempdir().unwrap();
    write(&order(GAZEBO.as_ref(), folder.path(), &[("turntable", "16")]), &renderer, &host).unwrap();
    let most = host.log.events.lock().unwrap().most;
    assert!((3..=5).contains(&most), "{most} frames in memory");
}

#[test]
fn the_frame_of_a_device_that_fails_goes_to_the_others() {
    let folders = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let [one, all] = folders.each_ref().map(|folder| order(GAZEBO.as_ref(), folder.path(), &[("turntable", "5")]));
    write(&one, &cpu(), &Unobserved).unwrap();
    let (renderer, host) = several(&[lost, sound, lost]);
    write(&all, &renderer, &host).unwrap();
    assert_eq!(contents(folders[0].path()), contents(folders[1].path()));
    let notes = host.log.events.lock().unwrap().notes.join("; ");
    for device in ["device 0", "device 2"] {
        assert!(notes.contains(&format!("{device} has failed; other devices take its frame ")), "{notes}");
    }
}

#[test]
fn a_device_whose_memory_is_short_waits_until_frames_are_written() {
    /// Has no memory for its second image while its first one is written.
    fn hungry(number: usize, log: &Log) -> Result<(), RenderError> {
        if number != 1 {
            return Ok(());
        }
        log.wait_until(|events| !events.written.is_empty());
        log.change(|events| events.is_short = true);
        Err(RenderError::BuildMemory { triangles: 1, short: OverBudget { needed: 2, left: 1, limit: None } })
    }
    let folder = tempfile::tempdir().unwrap();
    let (renderer, host) = several(&[hungry, lost]);
    let written = |log: &Log| {
        log.wait_until(|events| events.is_short);
        std::thread::sleep(Duration::from_millis(300));
    };
    let host = Listener { written, ..host };
    write(&order(GAZEBO.as_ref(), folder.path(), &[("turntable", "3")]), &renderer, &host).unwrap();
    let events = host.log.events.lock().unwrap();
    assert!(events.written.len() == 3 && events.begun == 5, "one frame was begun twice, and one by who is lost");
    assert!(events.notes.iter().all(|note| !note.starts_with("device 0 has failed")), "{:?}", events.notes);
}

#[test]
fn a_film_does_not_wait_for_a_device_that_wakes_and_is_joined_by_it() {
    /// Goes on after some images when another device has begun one.
    fn asks_for_help(number: usize, log: &Log) -> Result<(), RenderError> {
        if number >= 4 {
            log.wait_until(|events| events.begun > number + 1);
        }
        Ok(())
    }
    let folders = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let [one, all] = folders.each_ref().map(|folder| order(GAZEBO.as_ref(), folder.path(), &[("turntable", "12")]));
    write(&one, &cpu(), &Unobserved).unwrap();
    let host = several(&[]).1;
    let standin = |number, before: Before, log: &Arc<Log>| {
        Box::new(Standin { number, renderer: cpu(), rendered: Mutex::default(), before, log: Arc::clone(log) })
    };
    let log = Arc::clone(&host.log);
    let late = move || {
        log.wait_until(|events| events.written.len() >= 2);
        Ok(standin(1, sound, &log) as Box<dyn Worker>)
    };
    let never = || Err(RenderError::Device { device: "cuda:2".to_owned(), reason: "its memory is used up".to_owned() });
    let makes: Vec<(String, Make)> =
        vec![("cuda:1".to_owned(), Box::new(late)), ("cuda:2".to_owned(), Box::new(never))];
    let mut workers: Vec<Box<dyn Worker>> = vec![standin(0, asks_for_help, &host.log)];
    workers.extend(waking(makes).unwrap());
    let renderer = Renderer::together(cpu(), workers, Some(2)).unwrap();
    write(&all, &renderer, &host).unwrap();
    assert_eq!(contents(folders[0].path()), contents(folders[1].path()));
    let notes = &host.log.events.lock().unwrap().notes;
    assert_eq!(notes.iter().filter(|note| note.starts_with("device cuda:2 cannot be used: ")).count(), 1, "{notes:?}");
}

#[test]
fn what_is_finished_stays_when_no_device_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let mut film = order(GAZEBO.as_ref(), folder.path(), &[("turntable", "5")]);
    let (renderer, host) = several(&[lost, lost]);
    let Err(Error::Frame { finished: 0, cause, .. }) = write(&film, &renderer, &host) else { panic!() };
    assert!(matches!(*cause, Error::Render(RenderError::Device { .. })), "{cause:?}");
    assert_eq!(contents(folder.path()).len(), 1);

    film.request.resume = true;
    let (renderer, host) = several(&[frail, frail]);
    let Err(Error::Frame { finished: 2, .. }) = write(&film, &renderer, &host) else { panic!() };
    let (renderer, host) = several(&[sound, sound]);
    write(&film, &renderer, &host).unwrap();
    let events = host.log.events.lock().unwrap();
    assert_eq!((events.begun, events.written.len()), (3, 3), "two are kept");
    assert_eq!(contents(folder.path()).len(), 6);
}

#[test]
fn a_film_that_is_cancelled_goes_on_where_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let mut film = order(GAZEBO.as_ref(), folder.path(), &[("turntable", "12")]);
    let (renderer, host) = several(&[sound, sound]);
    let host = Listener { is_cancelled: |events| events.written.len() >= 2, ..host };
    assert!(matches!(write(&film, &renderer, &host), Err(Error::Render(RenderError::Cancelled))));
    let files = contents(folder.path()).len() - 1;
    assert!((2..=7).contains(&files), "{files}");
    film.request.resume = true;
    let (renderer, host) = several(&[sound, sound]);
    write(&film, &renderer, &host).unwrap();
    assert_eq!(host.log.events.lock().unwrap().written.len(), 12 - files);
}

#[test]
fn what_devices_know_of_light_points_goes_to_the_mesh_file_and_comes_from_it() {
    let place = tempfile::tempdir().unwrap();
    let settings = [("turntable", "4"), ("lookup", "half-ball"), ("step", "0.2")];
    // One device renders all frames: which frames another takes depends on the time.
    for (folder, is_first, devices) in [("first", true, [sound as Before, lost]), ("second", false, [lost, sound])] {
        let folder = place.path().join(folder);
        fs::create_dir(&folder).unwrap();
        let mut film = order(GAZEBO.as_ref(), &folder, &settings);
        film.files.mesh_file = Some(place.path().join("points.mesh"));
        film.files.stats = Some(folder.join("f.##.json"));
        let (renderer, host) = several(&devices);
        write(&film, &renderer, &host).unwrap();
        let tests = |number: usize| {
            let stats = fs::read_to_string(folder.join(format!("f.{number:02}.json"))).unwrap();
            let after = stats.split("\"long_tests\": ").nth(1).unwrap();
            after.split(',').next().unwrap().trim().parse::<u64>().unwrap()
        };
        let made: u64 = (1..=4).map(tests).sum();
        assert_eq!(made > 0, is_first, "{made}");
    }
}

#[test]
fn frames_one_by_one_come_in_their_order_with_what_is_said_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut film = order(GAZEBO.as_ref(), folder.path(), &[("turntable", "5"), ("lookup", "half-ball")]);
    let begin = |film: &Order, renderer: &Renderer| session(film, renderer).frames(renderer, &Unobserved).unwrap();
    film.files = Files::default();
    let ((renderer, _), alone) = (several(&[sound, sound]), cpu());
    let mut frames = [begin(&film, &alone), begin(&film, &renderer)];
    for number in 1..=5 {
        assert_eq!(frames[1].left(), 6 - number as usize);
        let [one, all] = [&*alone, &renderer].map(|renderer| (several(&[]).1, renderer));
        let rendered = [one, all].into_iter().zip(&mut frames).map(|((host, renderer), frames)| {
            let rendered = frames.next(renderer, &host).unwrap().unwrap();
            assert_eq!(rendered.number, number);
            (rendered.frame.image, rendered.stops, host.log.events.lock().unwrap().notes.clone())
        });
        let [one, all] = rendered.collect::<Vec<_>>().try_into().ok().unwrap();
        assert!(one == all, "{number}: {:?} {:?}", one.2, all.2);
    }
    assert!(frames.iter_mut().all(|frames| frames.next(&renderer, &Unobserved).is_none()));

    let film = order(GAZEBO.as_ref(), folder.path(), &[("turntable", "5")]);
    let (renderer, host) = several(&[frail, frail]);
    let mut frames = begin(&film, &renderer);
    let mut next = || frames.next(&renderer, &host);
    assert_eq!([next(), next()].map(|frame| frame.unwrap().unwrap().number), [1, 2]);
    assert!(matches!(next(), Some(Err(Error::Frame { number: 3 | 4, finished: 2, .. }))));
    assert!(next().is_none() && contents(folder.path()).len() == 3);
}
