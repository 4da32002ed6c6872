//! Running the program in a separate folder.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A ball over a floor, seen by two cameras; no light.
const ROOM: &str = r#"
[[camera]]
name = "front"
position = [0, 2, 6]
target = [0, 1, 0]
vfov = 45

[[camera]]
name = "top"
position = [0, 9, 0]
target = [0, 0, 0]
up = [0, 0, -1]
vfov = 45

[[material]]
name = "white"
kd = [0.8, 0.8, 0.8]

[[sphere]]
center = [0, 1, 0]
radius = 1
segments = 12
material = "white"

[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
size = [12, 12]
material = "white"
"#;

/// A light for the room, above and to the right.
pub(crate) const LAMP: &str = "3,5,2;0.9";

/// A folder with `room.toml` in it.
pub(crate) struct Place(TempDir);

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Done {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Place {
    pub(crate) fn new() -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        place.write("room.toml", ROOM);
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let names = std::fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Not yet started. No CUDA device is visible, so that results, such as the bytes of images, are the same on every machine.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = self.command_with_devices(args);
        command.env("CUDA_VISIBLE_DEVICES", "-1");
        command
    }

    /// Not yet started. The devices of this process are visible.
    pub(crate) fn command_with_devices(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lightmesh"));
        command.current_dir(self.0.path()).args(args).stdin(Stdio::null());
        command
    }

    /// As [`Place::command`], from a shell in which `"$0" "$@"` is the program with its arguments.
    #[cfg(unix)]
    pub(crate) fn shell(&self, script: &str, args: &[&str]) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script, env!("CARGO_BIN_EXE_lightmesh")]).args(args);
        command.current_dir(self.0.path()).env("CUDA_VISIBLE_DEVICES", "-1").stdin(Stdio::null());
        command
    }

    /// Runs a command on a terminal: standard input, output and error are one. Returns its exit code and all that it
    /// shows.
    #[cfg(target_os = "linux")]
    pub(crate) fn on_terminal(&self, mut command: Command) -> (Option<i32>, String) {
        use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
        use std::io::Read;
        let screen = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&screen).and_then(|()| unlockpt(&screen)).unwrap();
        let name = ptsname(&screen, Vec::new()).unwrap().into_string().unwrap();
        let terminal = || std::fs::OpenOptions::new().read(true).write(true).open(&name).unwrap();
        let mut child = command.stdin(terminal()).stdout(terminal()).stderr(terminal()).spawn().unwrap();
        // Closes the other ends here, so that the last one closes with the child.
        drop(command);
        let mut shown = Vec::new();
        // The end of a terminal is an error.
        let _ = std::fs::File::from(screen).read_to_end(&mut shown);
        (child.wait().unwrap().code(), String::from_utf8(shown).unwrap())
    }

    pub(crate) fn run(&self, args: &[&str]) -> Done {
        self.command(args).output().unwrap().into()
    }

    /// Runs a command that must succeed.
    pub(crate) fn good(&self, args: &[&str]) -> Done {
        let done = self.run(args);
        assert_eq!(done.code, Some(0), "{args:?}: {done:?}");
        done
    }

    /// Runs a command that must be rejected with exit code 2 and leave no file; returns the first line of the message.
    pub(crate) fn refused(&self, args: &[&str]) -> String {
        let before = self.files();
        let done = self.run(args);
        assert_eq!(done.code, Some(2), "{args:?}: {done:?}");
        assert_eq!(self.files(), before, "{args:?}");
        assert_eq!(done.stdout, "", "{args:?}");
        let line = done.stderr.lines().find(|line| line.starts_with("error: "));
        line.unwrap_or_else(|| panic!("no error in {done:?}")).to_owned()
    }

    /// Renders a small image of the room, quietly, as an exr; returns its bytes.
    pub(crate) fn room(&self, flags: &[&str]) -> Vec<u8> {
        let base = ["render", "room.toml", "-o", "room.exr", "--size", "48x32", "--quiet", "--light", LAMP];
        let done = self.good(&[&base, flags].concat());
        assert_eq!(done.stderr, "", "{flags:?}");
        self.read("room.exr")
    }

    /// As [`Place::room`]; returns the statistics.
    pub(crate) fn room_stats(&self, flags: &[&str]) -> Value {
        self.room(&[&["--stats", "room.json"], flags].concat());
        self.json("room.json")
    }
}

impl From<Output> for Done {
    fn from(output: Output) -> Done {
        Done {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// A path as text.
pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
