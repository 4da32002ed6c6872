//! Requests to end, in every phase and with every signal: exit code, message, and what is on the disk.

use std::fmt::Write;
use std::io::{BufRead, BufReader, Lines};
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Once};
use std::thread::sleep;
use std::time::{Duration, Instant};

use lightmesh::image::Frame;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_default;

use crate::run::Place;

/// Each signal with its exit code.
const SIGNALS: [(&str, i32); 3] = [("INT", 130), ("TERM", 143), ("HUP", 129)];
/// Their numbers.
const CAUGHT: [i32; 3] = [SIGINT, SIGTERM, SIGHUP];
/// Only a guard: how soon the program ends is measured elsewhere.
const LIMIT: Duration = Duration::from_secs(30);
const LOOK: Duration = Duration::from_millis(2);
const NOTHING: &str = "interrupted: nothing was written";

/// The program at work.
struct Running {
    child: Child,
    lines: Lines<BufReader<ChildStderr>>,
}

impl Running {
    fn new(place: &Place, args: &[&str]) -> Running {
        Running::of(place.command(args))
    }

    fn of(mut command: Command) -> Running {
        obey_signals();
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        Running { child, lines }
    }

    /// Waits for a line of progress, such as the begin of a stage.
    fn await_event(&mut self, event: &str, stage: &str) {
        let wanted = format!(r#"{{"event":"{event}","stage":"{stage}""#);
        assert!(self.lines.by_ref().map(Result::unwrap).any(|line| line.starts_with(&wanted)), "{wanted}");
    }

    /// Sends a signal; returns the exit code and the last line.
    fn end_by(mut self, signal: &str) -> (Option<i32>, String) {
        send(&self.child, signal);
        let status = wait(&mut self.child);
        (status.code(), self.lines.map(Result::unwrap).last().unwrap_or_default())
    }
}

/// Children ignore what this process ignores, as it does if it runs in the background or by `nohup`; not what it handles, be it as usual.
fn obey_signals() {
    static DONE: Once = Once::new();
    DONE.call_once(|| {
        for signal in CAUGHT {
            register_conditional_default(signal, Arc::new(AtomicBool::new(true))).unwrap();
        }
    });
}

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn wait(child: &mut Child) -> ExitStatus {
    until(|| child.try_wait().unwrap())
}

/// Asks until there is an answer.
fn until<T>(mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(start.elapsed() < LIMIT);
        sleep(LOOK);
    }
}

/// Waits until the program catches all of the signals, one after the other.
fn await_start(child: &Child) {
    if cfg!(target_os = "linux") {
        let path = format!("/proc/{}/status", child.id());
        until(|| {
            let status = std::fs::read_to_string(&path).unwrap();
            let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
            let caught = u64::from_str_radix(mask.trim(), 16).unwrap();
            CAUGHT.iter().all(|signal| caught >> (signal - 1) & 1 == 1).then_some(())
        });
    } else {
        sleep(Duration::from_millis(200));
    }
}

/// A file in the folder that is being written.
fn await_temporary(place: &Place) -> String {
    until(|| place.files().into_iter().find(|name| name.starts_with(".lightmesh-")))
}

/// A sheet with this number of vertices along a side.
fn sheet(place: &Place, side: usize) {
    let mut text = String::new();
    for (x, y) in (0..side * side).map(|index| (index % side, index / side)) {
        writeln!(text, "v {x} {y} {}", (x * y) % 7).unwrap();
    }
    for index in (0..side * (side - 1)).filter(|index| (index + 1) % side != 0) {
        let (a, b) = (index + 1, index + 1 + side);
        writeln!(text, "f {a} {} {b}\nf {} {b} {}", a + 1, a + 1, b + 1).unwrap();
    }
    place.write("large.obj", &text);
}

#[test]
fn loading_ends() {
    let place = Place::new();
    // To read so much takes seconds.
    sheet(&place, 900);
    let json = ["--progress", "json", "--size", "16x16", "--stats", "a.json"];
    let render = [&["render", "large.obj", "-o", "a.png"], &json[..]].concat();
    for args in [&render[..], &["info", "large.obj"], &["export", "large.obj", "-o", "a.glb"]] {
        for (signal, code) in SIGNALS {
            let running = Running::new(&place, args);
            await_start(&running.child);
            assert_eq!(running.end_by(signal), (Some(code), NOTHING.to_owned()), "{args:?}");
            assert_eq!(place.files(), ["large.obj", "room.toml"]);
        }
    }
}

#[test]
fn building_ends() {
    let place = Place::new();
    sheet(&place, 300);
    for (signal, code) in SIGNALS {
        let flags = ["-o", "a.png", "--size", "2000x2000", "--mode", "area", "--progress", "json"];
        let mut running = Running::new(&place, &[&["render", "large.obj"], &flags[..]].concat());
        running.await_event("begin", "build");
        assert_eq!(running.end_by(signal), (Some(code), NOTHING.to_owned()));
        assert_eq!(place.files(), ["large.obj", "room.toml"]);
    }
}

#[test]
fn rendering_ends() {
    let place = Place::new();
    place.write("a.png", "the earlier image");
    let flags = ["--mode", "area", "--size", "3000x3000", "--progress", "json", "--light", "3,5,2;1;0.5"];
    for (signal, code) in SIGNALS {
        let mut running = Running::new(&place, &[&["render", "room.toml", "-o", "a.png"], &flags[..]].concat());
        running.await_event("begin", "area_shadows");
        assert_eq!(running.end_by(signal), (Some(code), NOTHING.to_owned()));
        assert_eq!(place.files(), ["a.png", "room.toml"]);
        assert_eq!(place.read("a.png"), b"the earlier image");
    }
}

/// Nothing is in sight, so that there is more to encode than to render.
#[test]
fn encoding_ends_and_the_image_is_whole_or_absent() {
    let place = Place::new();
    let away = ["--camera", "0,2,6;0,2,9;45", "--mode", "ray-trace", "--size", "2500x2000", "--progress", "json"];
    for (signal, code) in SIGNALS {
        let args = [&["render", "room.toml", "-o", "a.png", "--layers", "a.exr"], &away[..]].concat();
        let mut running = Running::new(&place, &args);
        running.await_event("end", "shade");
        await_temporary(&place);
        let (ended, message) = running.end_by(signal);
        assert_eq!(ended, Some(code));
        let there = place.path("a.png").exists();
        assert_eq!(message, if there { "interrupted: written: a.exr, a.png" } else { NOTHING });
        assert_eq!(place.path("a.exr").exists(), there);
        assert_eq!(place.files().len(), if there { 3 } else { 1 }, "{:?}", place.files());
        if there {
            assert_eq!(Frame::load(place.path("a.png")).unwrap().width(), 2500);
            ["a.png", "a.exr"].iter().for_each(|name| std::fs::remove_file(place.path(name)).unwrap());
        }
    }
}

/// A render whose image is complete, and which waits for a reader of its statistics.
fn waiting(place: &Place) -> Running {
    if !place.path("pipe").exists() {
        assert!(Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    }
    let flags = ["-o", "a.png", "--size", "16x16", "--stats", "pipe", "--progress", "json"];
    let mut running = Running::new(place, &[&["render", "room.toml"], &flags[..]].concat());
    running.await_event("end", "shade");
    await_temporary(place);
    running
}

#[test]
fn publishing_ends() {
    let place = Place::new();
    for (signal, code) in SIGNALS {
        assert_eq!(waiting(&place).end_by(signal), (Some(code), NOTHING.to_owned()));
        assert_eq!(place.files(), ["pipe", "room.toml"]);
    }
}

#[test]
fn what_a_killed_run_left_is_removed_by_the_next_and_what_a_living_one_writes_is_not() {
    let place = Place::new();
    let mut killed = waiting(&place);
    let left = await_temporary(&place);
    let render = |name| place.good(&["render", "room.toml", "-o", name, "--size", "8x8", "-q"]);
    render("b.png");
    assert!(place.files().contains(&left), "removed from a living run");
    send(&killed.child, "KILL");
    wait(&mut killed.child);
    assert!(place.files().contains(&left));
    render("c.png");
    assert_eq!(place.files(), ["b.png", "c.png", "pipe", "room.toml"]);
}

/// A picture that takes a second or so, in files of several kinds.
struct Kept {
    place: Place,
    /// Arguments without the outputs.
    args: Vec<&'static str>,
    outputs: Vec<[&'static str; 2]>,
    whole: Vec<Frame>,
}

const KEPT: [u32; 2] = [300, 256];

impl Kept {
    fn new(mode: &'static str, flags: &[&'static str], outputs: &[[&'static str; 2]]) -> Kept {
        let place = Place::new();
        let base = ["render", "room.toml", "--size", "300x256", "--light", "3,5,2;1;0.5", "--mode", mode];
        let (args, outputs) = ([&base, flags].concat(), outputs.to_vec());
        place.good(&[&args[..], outputs.as_flattened()].concat());
        let whole = outputs.iter().map(|[_, name]| Frame::load(place.path(name)).unwrap()).collect();
        let kept = Kept { place, args: [&args[..], &["--partial", "--progress", "json"]].concat(), outputs, whole };
        kept.clear();
        kept
    }

    fn clear(&self) {
        self.outputs.iter().for_each(|[_, name]| drop(std::fs::remove_file(self.place.path(name))));
    }

    fn start(&self) -> Running {
        Running::new(&self.place, &[&self.args[..], self.outputs.as_flattened()].concat())
    }

    /// Checks what a run has left, and removes it. Returns the number of finished rows.
    fn check(&self, message: &str) -> u32 {
        if message == NOTHING {
            assert_eq!(self.place.files(), ["room.toml"]);
            return 0;
        }
        let rows = message.strip_suffix(" 256 rows are finished").unwrap_or_else(|| panic!("{message}"));
        let rows = rows.rsplit_once("; ").unwrap().1;
        let rows = if rows == "all" { KEPT[1] } else { rows.strip_suffix(" of").unwrap().parse().unwrap() };
        for ([_, name], whole) in self.outputs.iter().zip(&self.whole) {
            assert!(message.contains(name), "{message}");
            let frame = Frame::load(self.place.path(name)).unwrap();
            let places = (rows * KEPT[0]) as usize;
            assert_eq!([frame.width(), frame.height()], KEPT);
            assert!(frame.color()[..places] == whole.color()[..places], "{name}: {rows} rows");
            assert!(frame.color()[places..].iter().all(|color| *color == [0.0; 3]), "{name}: below {rows} rows");
            assert_eq!(frame.alpha().is_some(), whole.alpha().is_some());
            if let Some((alpha, all)) = frame.alpha().zip(whole.alpha()) {
                assert!(alpha[..places] == all[..places] && alpha[places..].iter().all(|alpha| *alpha == 0.0));
            }
        }
        assert_eq!(self.place.files().len(), 1 + self.outputs.len());
        self.clear();
        rows
    }
}

#[test]
fn partial_keeps_the_finished_rows_of_all_outputs() {
    for (mode, flags, outputs) in [
        ("area", &[][..], &[["-o", "a.png"], ["--layers", "b.exr"]][..]),
        ("area", &["--background", "transparent"], &[["-o", "a.exr"]]),
        ("light-mesh", &["--background", "transparent"], &[["-o", "a.png"], ["--layers", "b.exr"]]),
    ] {
        let kept = Kept::new(mode, flags, outputs);
        for (signal, code) in SIGNALS {
            let mut running = kept.start();
            // The first band is finished when the third begins.
            (0..3).for_each(|_| running.await_event("begin", "camera_rays"));
            let (ended, message) = running.end_by(signal);
            assert_eq!(ended, Some(code));
            assert!(kept.check(&message) >= 8, "{message}");
        }
    }
}

#[test]
fn partial_leaves_a_valid_picture_or_none_at_any_moment() {
    let kept = Kept::new("area", &[], &[["-o", "a.bmp"], ["--layers", "b.exr"]]);
    let start = Instant::now();
    let mut running = kept.start();
    assert!(wait(&mut running.child).success());
    let whole = start.elapsed();
    kept.clear();
    let mut random = 0x9e37_79b9_u32;
    for turn in 0..9 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let (signal, code) = SIGNALS[turn % 3];
        let mut running = kept.start();
        await_start(&running.child);
        sleep(whole.mul_f32((random >> 8) as f32 / (1 << 24) as f32));
        if let Some(status) = running.child.try_wait().unwrap() {
            assert!(status.success(), "{status}");
            kept.clear();
            continue;
        }
        match running.end_by(signal) {
            // It was about to exit.
            (Some(0), _) => kept.clear(),
            (ended, message) => {
                assert_eq!(ended, Some(code), "{message}");
                kept.check(&message);
            }
        }
    }
}

#[test]
fn partial_statistics_are_those_of_the_finished_rows() {
    let kept = Kept::new("area", &["--stats", "a.json"], &[["-o", "a.png"]]);
    let mut running = kept.start();
    (0..3).for_each(|_| running.await_event("begin", "camera_rays"));
    running.end_by("INT");
    let stats = kept.place.json("a.json");
    let rows = stats["finished_rows"].as_u64().unwrap();
    assert!((8..256).contains(&rows), "{rows}");
    assert_eq!(stats["counts"]["pixels"], rows * 300);
    let compared = kept.place.run(&["compare", "a.png", "a.png"]);
    assert_eq!(compared.code, Some(0), "{compared:?}");
}

/// What is kept waits for a reader of the statistics, who never comes.
#[test]
fn a_second_signal_ends_what_is_kept() {
    let place = Place::new();
    assert!(Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    let flags = ["-o", "a.png", "--size", "16x16", "--stats", "pipe", "--progress", "json", "--partial"];
    let mut running = Running::new(&place, &[&["render", "room.toml"], &flags[..]].concat());
    running.await_event("end", "shade");
    await_temporary(&place);
    send(&running.child, "TERM");
    sleep(Duration::from_millis(300));
    assert!(running.child.try_wait().unwrap().is_none(), "the first one keeps what there is");
    assert_eq!(running.end_by("INT"), (Some(143), NOTHING.to_owned()));
    assert_eq!(place.files(), ["pipe", "room.toml"]);
}

#[test]
fn a_suite_keeps_the_rows_it_has() {
    let place = Place::new();
    // Nothing of the second scene is done for a long time.
    let scenes = ["--scene", "room.toml", "--scene", "builtin:garden", "--size", "16", "--repeat", "1"];
    let flags = ["--quick", "--device", "cpu", "--json", "a.json", "--progress", "json"];
    for (signal, code) in SIGNALS {
        let mut running = Running::new(&place, &[&["bench", "stages"], &scenes[..], &flags].concat());
        assert!(running.lines.by_ref().map(Result::unwrap).any(|line| line.contains(r#""text":"scene 2 of 2"#)));
        assert_eq!(running.end_by(signal), (Some(code), "interrupted: written: a.json".to_owned()));
        let results = place.json("a.json");
        assert_eq!(results["notes"].as_array().unwrap().last().unwrap(), "Stopped early; later rows are missing.");
        let rows = results["rows"].as_array().unwrap();
        assert!(rows.len() == 10 && rows.iter().all(|row| row["keys"]["scene"] == "room"), "{results}");
        assert_eq!(place.files(), ["a.json", "room.toml"]);
        std::fs::remove_file(place.path("a.json")).unwrap();
    }
}

#[test]
fn a_signal_that_the_parent_ignores_stays_ignored() {
    let place = Place::new();
    let args = ["render", "room.toml", "-o", "a.png", "--size", "3000x3000", "--mode", "area", "--progress", "json"];
    let mut running = Running::of(place.shell("trap '' HUP; exec \"$0\" \"$@\"", &args));
    if cfg!(target_os = "linux") {
        running.await_event("begin", "primary_rays");
        send(&running.child, "HUP");
        sleep(Duration::from_millis(500));
        assert!(running.child.try_wait().unwrap().is_none());
    }
    assert_eq!(running.end_by("TERM").0, Some(143));
}

/// Standard error is a pipe that is full, and nobody reads it.
#[cfg(target_os = "linux")]
#[test]
fn a_message_that_nobody_reads_does_not_hold_up_the_end() {
    let place = Place::new();
    let args = ["render", "room.toml", "-o", "a.png", "--size", "3000x3000", "--mode", "area", "--progress", "json"];
    let full = "head -c 65536 /dev/zero >&2; exec \"$0\" \"$@\"";
    let mut running = Running::of(place.shell(full, &args));
    let path = format!("/proc/{}/comm", running.child.id());
    until(|| (std::fs::read_to_string(&path).unwrap().trim() == "lightmesh").then_some(()));
    await_start(&running.child);
    send(&running.child, "TERM");
    assert_eq!(wait(&mut running.child).code(), Some(143));
}
