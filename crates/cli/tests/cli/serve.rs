//! `lightmesh serve`, and `render --server`: the same files and words as without, a scene that stays, and all ends.

use std::fs::File;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixListener;
use std::process::{Child, Stdio};
use std::time::{Duration, SystemTime};

use crate::run::{Done, LAMP, Place, text};

/// A server, which ends with this.
struct Server<'a> {
    place: &'a Place,
    name: &'static str,
}

impl<'a> Server<'a> {
    fn begin(place: &'a Place) -> Server<'a> {
        Server::at(place, "s.sock")
    }

    fn at(place: &'a Place, name: &'static str) -> Server<'a> {
        // A scene that has just been written may change without another time.
        let past = SystemTime::now() - Duration::from_secs(60);
        File::options().write(true).open(place.path("room.toml")).unwrap().set_modified(past).unwrap();
        place.good(&["serve", "--socket", name, "--background", "--log", "log", "--idle", "5m"]);
        Server { place, name }
    }

    fn command(&self, args: &[&str]) -> std::process::Command {
        self.place.command(&[&["render", "room.toml", "--light", LAMP], args, &["--server", self.name]].concat())
    }

    fn run(&self, args: &[&str]) -> Done {
        self.command(args).output().unwrap().into()
    }

    fn good(&self, args: &[&str]) -> Done {
        let done = self.run(args);
        assert_eq!(done.code, Some(0), "{args:?}: {done:?}, {}", self.log());
        done
    }

    /// Seconds that an image took to read and build.
    fn made(&self, flags: &[&str]) -> [f64; 2] {
        self.good(&[&["-o", "a.exr", "--size", "32x24", "-q", "--stats", "a.json"], flags].concat());
        let stats = self.place.json("a.json");
        ["load", "build"].map(|stage| stats["seconds"][stage].as_f64().unwrap())
    }

    fn log(&self) -> String {
        String::from_utf8(self.place.read("log")).unwrap()
    }
}

impl Drop for Server<'_> {
    fn drop(&mut self) {
        self.place.run(&["serve", "--socket", self.name, "--stop"]);
    }
}

#[test]
fn a_server_renders_as_the_program_does() {
    let place = Place::new();
    let server = Server::begin(&place);
    let (image, film) = (["-o", "a.png", "--size", "40x30"], ["-o", "f.##.png", "--turntable", "3", "--size", "16x12"]);
    let here = |flags: &[&str]| place.good(&[&["render", "room.toml", "--light", LAMP], flags].concat());
    for flags in [&image[..], &film] {
        let (alone, count) = (here(flags), place.files().len());
        let name = if flags == image { "a.png" } else { "f.03.png" };
        let bytes = place.read(name);
        let again = [flags, &["--overwrite"][..if flags == image { 0 } else { 1 }]].concat();
        let done = server.good(&again);
        assert!(place.read(name) == bytes && place.files().len() == count);
        // But for the times.
        let words = |done: &Done| {
            done.stderr.lines().map(|line| line.split(": ").next().unwrap().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(words(&alone), words(&done));
    }
    let mut command = server.command(&["-o", "-", "--format", "png", "--size", "40x30", "-q"]);
    assert!(command.output().unwrap().stdout == place.read("a.png"));
    let done = server.run(&["-o", "none/a.png"]);
    assert!(done.code == Some(2) && done.stderr.starts_with("error: ") && done.stderr.contains("none"), "{done:?}");
    assert!(server.log().contains("room.toml: exit code 0 after"), "{}", server.log());
}

#[test]
fn a_scene_stays_until_a_file_of_it_changes() {
    let place = Place::new();
    let server = Server::begin(&place);
    assert!(server.made(&[]).iter().all(|&seconds| seconds > 0.0));
    let first = place.read("a.exr");
    // Neither is built again where only the camera differs, nor where the same ground is added.
    let [load, build] = server.made(&["--camera-name", "top"]);
    assert!(load < 0.01 && build == 0.0, "{load} {build}");
    server.made(&["--ground"]);
    assert_eq!(server.made(&["--ground"])[1], 0.0);
    let lower = String::from_utf8(place.read("room.toml")).unwrap().replace("center = [0, 1, 0]", "center = [0, 0, 0]");
    place.write("room.toml", &lower);
    assert!(server.made(&[])[1] > 0.0);
    assert!(place.read("a.exr") != first);
    // What was written just now is read again.
    assert!(server.made(&[])[1] > 0.0);
}

#[test]
fn a_file_that_is_replaced_is_read_again_whatever_its_time() {
    let place = Place::new();
    let server = Server::begin(&place);
    server.made(&[]);
    let first = place.read("a.exr");
    // As copies and archives leave it: as long, and with the time of the other one.
    let time = place.path("room.toml").metadata().unwrap().modified().unwrap();
    let lower = String::from_utf8(place.read("room.toml")).unwrap().replace("center = [0, 1, 0]", "center = [0, 0, 0]");
    place.write("other.toml", &lower);
    File::options().write(true).open(place.path("other.toml")).unwrap().set_modified(time).unwrap();
    std::fs::rename(place.path("other.toml"), place.path("room.toml")).unwrap();
    server.made(&[]);
    assert!(place.read("a.exr") != first);
}

#[test]
fn a_ground_of_the_same_kind_is_the_same_ground() {
    let place = Place::new();
    let server = Server::begin(&place);
    let made = |flags: &[&str]| server.made(&[&["--ground"], flags].concat())[1];
    let size = |flags: &[&str]| {
        let done = server.run(&[&["-o", "b.png", "-q", "--ground", "--stats", "b.json"], flags].concat());
        assert_eq!(done.code, Some(0), "{done:?}");
        place.json("b.json")["seconds"]["build"].as_f64().unwrap()
    };
    assert!(made(&[]) > 0.0);
    assert_eq!([size(&["--size", "20x20"]), size(&["--seed", "3"]), made(&["--exposure", "1"])], [0.0; 3]);
}

#[test]
fn who_waits_may_leave_and_what_cannot_be_said_together_is_refused_at_once() {
    let place = Place::new();
    let server = Server::begin(&place);
    let mut busy = server.command(&["-o", "a.png", "--size", "4000x4000", "--quality", "final", "--progress", "json"]);
    let mut busy = busy.stderr(Stdio::piped()).spawn().unwrap();
    let mut told = await_progress(&mut busy);
    let waiting = server.command(&["-o", "b.png", "--size", "16x12"]).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(200));
    let signal = |signal: &str, id: u32| std::process::Command::new("kill").args([signal, &id.to_string()]).status();
    assert!(signal("-TERM", waiting.id()).unwrap().success());
    let done: Done = waiting.wait_with_output().unwrap().into();
    assert!(done.code == Some(143) && done.stderr == "interrupted: nothing was written\n", "{done:?}");
    // The other one is still at work.
    assert!(busy.try_wait().unwrap().is_none());
    assert!(signal("-TERM", busy.id()).unwrap().success());
    told.by_ref().for_each(drop);
    assert_eq!(busy.wait().unwrap().code(), Some(143));
    let done = server.run(&["-o", "a.png", "--step", "0.5", "--mode", "area"]);
    assert!(done.code == Some(2) && done.stderr.contains("--step"), "{done:?}");
    let done = server.run(&["-o", "/dev/fd/9"]);
    assert!(done.code == Some(2) && done.stderr.contains("is open in this process alone"), "{done:?}");
    assert!(
        place.refused(&["serve", "--socket", "s.sock", "--background", "--log", "other"]).contains("another server")
    );
    place.good(&["serve", "--socket", "none.sock", "--stop"]);
}

#[test]
fn a_server_that_ends_leaves_the_socket_of_the_next_one() {
    let place = Place::new();
    place.good(&["serve", "--socket", "s.sock", "--background", "--idle", "1s"]);
    std::fs::remove_file(place.path("s.sock")).unwrap();
    let server = Server::begin(&place);
    std::thread::sleep(Duration::from_millis(1500));
    server.good(&["-o", "a.png", "--size", "16x12", "-q"]);
}

#[test]
fn what_is_cancelled_or_too_large_does_not_end_the_server() {
    let place = Place::new();
    let server = Server::begin(&place);
    let large = ["-o", "a.png", "--size", "4000x4000", "--quality", "final", "--progress", "json"];
    for signal in ["TERM", "KILL"] {
        let mut child = server.command(&large).stderr(Stdio::piped()).spawn().unwrap();
        let told = await_progress(&mut child);
        assert!(
            std::process::Command::new("kill")
                .args([&format!("-{signal}"), &child.id().to_string()])
                .status()
                .unwrap()
                .success()
        );
        let code = child.wait().unwrap().code();
        assert_eq!(code, if signal == "TERM" { Some(143) } else { None });
        let last = told.last().map(Result::unwrap).unwrap_or_default();
        assert_eq!(last, "interrupted: nothing was written");
    }
    // What is known to be too large, and what turns out to be.
    for limit in ["20M", "1M"] {
        let done = server.run(&["-o", "a.png", "--size", "3000x3000", "--memory-limit", limit, "-q"]);
        assert!(done.code == Some(3) && done.stderr.contains("there is not enough memory"), "{done:?}");
    }
    server.good(&["-o", "b.png", "--size", "16x12", "-q"]);
    assert_eq!(place.files(), ["b.png", "log", "room.toml", "s.sock"]);
}

/// Waits until an image is being rendered; returns the lines that follow.
fn await_progress(child: &mut Child) -> impl Iterator<Item = std::io::Result<String>> + use<> {
    use std::io::BufRead;
    let mut lines = std::io::BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(lines.by_ref().map(Result::unwrap).any(|line| line.contains(r#""event":"image""#)));
    lines
}

#[test]
fn sockets_are_private_and_end_with_their_server() {
    let place = Place::new();
    let server = Server::begin(&place);
    let mode = place.path("s.sock").metadata().unwrap().permissions().mode();
    assert_eq!(mode & 0o077, 0, "{mode:o}");
    assert!(place.refused(&["serve", "--socket", "s.sock"]).contains("another server answers at"));
    assert!(place.refused(&["serve", "--socket", "room.toml"]).contains("exists and is no socket"));
    drop(server);
    assert!(!place.path("s.sock").exists());
    let done = place.run(&["render", "room.toml", "-o", "a.png", "--server", "s.sock"]);
    assert_eq!(done.code, Some(3));
    assert!(done.stderr.contains("no server answers at s.sock"), "{done:?}");
    assert!(done.stderr.contains("lightmesh serve --socket s.sock"), "{done:?}");
    // One that has died leaves its socket, which the next one replaces.
    drop(UnixListener::bind(place.path("s.sock")).unwrap());
    let server = Server::begin(&place);
    server.good(&["-o", "a.png", "--size", "16x12", "-q"]);
    let done = place.run(&["render", "-", "--scene-format", "toml", "-o", "a.png", "--server", "s.sock"]);
    assert!(done.code == Some(2) && done.stderr.contains("a scene on standard input is read once"), "{done:?}");
}

#[test]
fn sockets_may_have_long_names() {
    let place = Place::new();
    let folder = "a".repeat(120);
    std::fs::create_dir(place.path(&folder)).unwrap();
    let name: &'static str = String::leak(format!("{folder}/s.sock"));
    let server = Server::at(&place, name);
    server.good(&["-o", "a.png", "--size", "16x12", "-q"]);
    assert!(place.path("a.png").exists() && place.path(name).exists());
    drop(server);
    assert!(!place.path(name).exists());
}

#[test]
fn a_server_ends_when_nobody_asks() {
    let place = Place::new();
    let done = place.good(&["serve", "--socket", text(&place.path("s.sock")), "--idle", "0.2s"]);
    assert!(done.stderr.contains("serving at") && done.stderr.contains("(--idle)"), "{done:?}");
    assert_eq!(place.files(), ["room.toml"]);
}
