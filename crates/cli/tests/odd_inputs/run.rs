//! Opening an odd input with the program, and checking the outcome.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use libtest_mimic::{Failed, Trial};

use crate::input::{As, Expected, Input};

/// Address space of the program, in kibibytes.
const MEMORY: u32 = 1 << 20;
const TIME: Duration = Duration::from_secs(10);
/// How often to poll for its end.
const LOOK: Duration = Duration::from_millis(2);

const BAD_INPUT: i32 = 2;

/// How a run ended.
struct Done {
    status: ExitStatus,
    stdout: String,
    stderr: String,
}

/// The input as a test.
pub(crate) fn trial(input: Input) -> Trial {
    let (name, ignored) = (input.name.clone(), input.ignored);
    Trial::test(name, move || try_out(&input).map_err(Failed::from)).with_ignored_flag(ignored)
}

fn try_out(input: &Input) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    (input.make)(folder.path());
    let render = |scene: &str, more: &[&str]| {
        let flags = ["-o", "odd.png", "--size", "16x16", "--threads", "1", "--quiet"];
        run(folder.path(), &[&["render", scene], &flags[..], more].concat())
    };
    match input.opened_as {
        As::Grid => check(input, &render("room.toml", &["--grid-file", &input.opened])?).map(|_| ()),
        As::Scene => {
            let info = run(folder.path(), &["info", &input.opened, "--json"])?;
            if check(input, &info)? {
                serde_json::from_str::<serde_json::Value>(&info.stdout).map_err(|error| error.to_string())?;
                check(input, &render(&input.opened, &[])?)?;
            }
            Ok(())
        }
    }
}

/// Whether it was opened; an error if that is not the expected outcome.
fn check(input: &Input, Done { status, stderr, .. }: &Done) -> Result<bool, String> {
    match (status.code(), input.expected) {
        (Some(0), Expected::Opens | Expected::Either) => Ok(true),
        (Some(BAD_INPUT), Expected::Refused | Expected::Either) => {
            let paragraph = stderr.strip_suffix('\n').unwrap_or(stderr);
            // If a setting in the file does not suit the image, the message names the flag that overrides it.
            let named = [input.culprit.as_str(), "--step", "--radius"].iter().any(|name| paragraph.contains(*name));
            let good = paragraph.starts_with("error: ") && named && !paragraph.contains(char::is_control);
            if good { Ok(false) } else { Err(format!("no paragraph about {}: {stderr:?}", input.culprit)) }
        }
        (_, expected) => Err(format!("{expected:?} was expected, but {status}: {stderr}")),
    }
}

/// Runs the program in `folder`, with limits.
fn run(folder: &Path, args: &[&str]) -> Result<Done, String> {
    let said = tempfile::tempdir().map_err(|error| error.to_string())?;
    let [stdout, stderr] = ["stdout", "stderr"].map(|name| said.path().join(name));
    // Into files: it would block on a pipe that nobody reads.
    let file = |path: &Path| File::create(path).map_err(|error| error.to_string());
    let mut child = limited(args)
        .current_dir(folder)
        .env("CUDA_VISIBLE_DEVICES", "-1")
        .stdin(Stdio::null())
        .stdout(file(&stdout)?)
        .stderr(file(&stderr)?)
        .spawn()
        .map_err(|error| error.to_string())?;
    let start = Instant::now();
    let status = loop {
        match child.try_wait().map_err(|error| error.to_string())? {
            Some(status) => break status,
            None if start.elapsed() > TIME => {
                // It may just have ended.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("{args:?} has not ended after {TIME:?}"));
            }
            None => sleep(LOOK),
        }
    };
    let text = |path: &Path| fs::read_to_string(path).map_err(|error| error.to_string());
    Ok(Done { status, stdout: text(&stdout)?, stderr: text(&stderr)? })
}

/// The program with limited memory, if the system supports limits.
fn limited(args: &[&str]) -> Command {
    let program = env!("CARGO_BIN_EXE_lightmesh");
    if cfg!(target_os = "linux") {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\""), program]).args(args);
        shell
    } else {
        let mut command = Command::new(program);
        command.args(args);
        command
    }
}
