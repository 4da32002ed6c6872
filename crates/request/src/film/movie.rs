//! Movies: frames go through a pipe to ffmpeg, which encodes them.
//!
//! 1. Before anything is rendered, the program is asked for its encoders.
//! 2. Frames go to its standard input without headers, 8 bits per channel, or 16 with `--bit-depth 16`. Encoders share colours between
//!    neighbours and so need even sides: the last column and row of others are repeated.
//! 3. It writes a temporary file beside the movie, which is renamed when all frames are in it. A movie is there as a whole or not at all.

use std::env;
use std::ffi::{OsStr, OsString};
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};

use lightmesh_files::{Output, WriteError};
use lightmesh_image::{BitDepth, Display, Frame};
use lightmesh_render::RenderError;

use super::Container;
use crate::error::{Error, FFMPEG, MovieError, OutputError};
use crate::files::publish;
use crate::host::Host;
use crate::order::Order;

/// The program, unless another is named.
const PROGRAM: &str = "ffmpeg";
/// The last bytes of what it says, which are quoted if it fails.
const QUOTED: usize = 500;
/// Converts codes to the matrix and the range of [`COLOURS`], and marks each frame with these, which recent versions prefer to options.
const FILTER: &str = "scale=out_color_matrix=bt709:out_range=tv,\
                      setparams=colorspace=bt709:color_primaries=bt709:color_trc=bt709:range=tv";
/// Colours are those of high-definition television, with its matrix: what players assume, and what the codes are converted by.
const COLOURS: [&str; 10] =
    ["-vf", FILTER, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"];

/// Checks that a movie can be encoded on this machine.
pub fn check_encoder(order: &Order, container: Container) -> Result<(), MovieError> {
    let (path, program) = (order.files.picture().to_owned(), program());
    let listing = Command::new(&program).args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    let name = || name(&program);
    let listing = listing.map_err(|reason| MovieError::NoProgram { path: path.clone(), program: name(), reason })?;
    if !listing.status.success() {
        // It has not said what it lacks.
        return Err(MovieError::Unasked {
            path,
            program: name(),
            status: listing.status,
            said: quoted(&listing.stderr),
        });
    }
    let encoder = container.encoder();
    let listed = String::from_utf8_lossy(&listing.stdout).split_whitespace().any(|word| word == encoder);
    if listed { Ok(()) } else { Err(MovieError::NoEncoder { path, program: name(), encoder }) }
}

fn program() -> OsString {
    env::var_os(FFMPEG).filter(|name| !name.is_empty()).unwrap_or_else(|| PROGRAM.into())
}

fn name(program: &OsStr) -> String {
    program.to_string_lossy().into_owned()
}

/// A movie that is being encoded. If dropped before it is finished, it has never been.
pub(crate) struct Movie {
    child: Child,
    pipe: Option<ChildStdin>,
    /// Collects what it says.
    messages: Option<JoinHandle<String>>,
    program: String,
    display: Display,
    output: Option<Output>,
    path: PathBuf,
}

impl Movie {
    /// Starts the encoder for frames of a size.
    pub(crate) fn begin(
        order: &Order,
        container: Container,
        display: Display,
        host: &dyn Host,
    ) -> Result<Movie, MovieError> {
        let (path, program) = (order.files.picture().to_owned(), program());
        let output = Output::to(&path)?;
        let Some(file) = output.temporary_path() else { return Err(MovieError::NoFile { path }) };
        let [width, height] = order.request.crop.map_or(order.request.size.0, |crop| crop.size);
        let even = [width, height].map(|side| side.next_multiple_of(2));
        if even != [width, height] {
            let [wide, high] = even;
            host.note(&format!("a movie needs even sides: {wide}x{high} pixels, by repeating the last row or column"));
        }
        let mut command = Command::new(&program);
        command.args(input(display.bit_depth, even, order)).args(COLOURS).args(encoding(container)).arg(file);
        own_group(&mut command);
        let started = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let program = name(&program);
        let mut child =
            started.map_err(|reason| MovieError::NoProgram { path: path.clone(), program: program.clone(), reason })?;
        let messages = child.stderr.take().map(|said| thread::spawn(move || end_of(said)));
        let pipe = child.stdin.take();
        Ok(Movie { child, pipe, messages, program, display, output: Some(output), path })
    }

    /// Adds a frame.
    pub(crate) fn push(&mut self, frame: &Frame, stops: f32, host: &dyn Host) -> Result<(), Error> {
        let codes = self.display.with_exposure(stops).encode(frame);
        let row = codes.len() / frame.height() as usize;
        let codes = even(codes, row, row / frame.width() as usize);
        let sent = self.pipe.as_mut().map_or(Ok(()), |pipe| pipe.write_all(&codes));
        sent.map_err(|reason| self.failed(reason, host))
    }

    /// Ends the movie, which is there then.
    pub(crate) fn finish(mut self) -> Result<(), Error> {
        drop(self.pipe.take());
        let status = self.child.wait().map_err(|reason| self.lost(reason))?;
        if !status.success() {
            return Err(self.ended(status).into());
        }
        if let Some(output) = self.output.take() {
            let path = self.path.clone();
            let ready = output.ready().map_err(|reason| OutputError::Write(WriteError::Data { path, reason }))?;
            publish(vec![ready])?;
        }
        Ok(())
    }

    /// The encoder takes no more.
    fn failed(&mut self, reason: io::Error, host: &dyn Host) -> Error {
        drop(self.pipe.take());
        if host.cancelled() {
            return RenderError::Cancelled.into();
        }
        match self.child.wait() {
            // It has left early, but is content.
            Ok(status) if status.success() => self.lost(reason).into(),
            Ok(status) => self.ended(status).into(),
            Err(reason) => self.lost(reason).into(),
        }
    }

    fn lost(&self, reason: io::Error) -> MovieError {
        MovieError::Lost { path: self.path.clone(), program: self.program.clone(), reason }
    }

    fn ended(&mut self, status: ExitStatus) -> MovieError {
        let said = self.messages.take().and_then(|messages| messages.join().ok());
        let said = said.unwrap_or_else(|| quoted(&[]));
        MovieError::Failed { path: self.path.clone(), program: self.program.clone(), status, said }
    }
}

impl Drop for Movie {
    fn drop(&mut self) {
        // If it has ended, there is nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// How frames come.
fn input(depth: BitDepth, [width, height]: [u32; 2], order: &Order) -> Vec<String> {
    let pixels = if depth == BitDepth::Sixteen { "rgb48be" } else { "rgb24" };
    let (size, rate) = (format!("{width}x{height}"), order.request.fps.unwrap_or_default().to_string());
    let said = ["-hide_banner", "-loglevel", "error", "-nostdin", "-y"];
    let frames = ["-f", "rawvideo", "-pixel_format", pixels, "-video_size", &size, "-framerate", &rate, "-i", "pipe:0"];
    said.into_iter().chain(frames).map(str::to_owned).collect()
}

/// How they are encoded: hardly to be told from the original.
fn encoding(container: Container) -> Vec<&'static str> {
    let mut words = vec!["-an", "-c:v", container.encoder(), "-pix_fmt", "yuv420p"];
    match container {
        Container::WebM => words.extend(["-crf", "24", "-b:v", "0", "-row-mt", "1"]),
        _ => words.extend(["-preset", "medium", "-crf", "18"]),
    }
    if matches!(container, Container::Mp4 | Container::Mov) {
        // Players can begin before they have all of it.
        words.extend(["-movflags", "+faststart"]);
    }
    words.extend(["-f", container.muxer()]);
    words
}

/// Rows of codes with an even number of pixels and rows.
fn even(codes: Vec<u8>, row: usize, pixel: usize) -> Vec<u8> {
    let (width, height) = (row / pixel, codes.len() / row);
    let mut codes = if width % 2 == 0 {
        codes
    } else {
        codes.chunks_exact(row).flat_map(|row| row.iter().chain(&row[row.len() - pixel..])).copied().collect()
    };
    if height % 2 == 1 {
        let row = codes.len() / height;
        codes.extend_from_within(codes.len() - row..);
    }
    codes
}

/// Reads everything; returns the last lines as one.
fn end_of(mut said: impl Read) -> String {
    let (mut kept, mut piece) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = said.read(&mut piece) {
        kept.extend_from_slice(&piece[..count]);
        kept.drain(..kept.len().saturating_sub(QUOTED));
    }
    quoted(&kept)
}

/// The end of what it says, as one line.
fn quoted(said: &[u8]) -> String {
    let text = String::from_utf8_lossy(&said[said.len().saturating_sub(QUOTED)..]);
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.is_empty() { "it says nothing".to_owned() } else { line }
}

/// Ctrl-C reaches this program alone, which says how its outputs end.
#[cfg(unix)]
fn own_group(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

#[cfg(not(unix))]
fn own_group(_: &mut Command) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_become_even_by_the_last_pixels() {
        let grey =
            |width: u8, height: u8| (0..height).flat_map(|y| (0..width).map(move |x| 10 * y + x)).collect::<Vec<_>>();
        assert_eq!(even(grey(2, 2), 2, 1), [0, 1, 10, 11]);
        assert_eq!(even(grey(3, 1), 3, 1), [0, 1, 2, 2, 0, 1, 2, 2]);
        assert_eq!(even(vec![1, 2, 3, 4, 5, 6], 3, 3), [1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6]);
    }

    #[test]
    fn the_end_of_messages_is_one_line() {
        assert_eq!(end_of(&b"no such\n encoder\n"[..]), "no such encoder");
        assert_eq!(end_of(&[b'a'; 9000][..]).len(), QUOTED);
        assert_eq!((end_of(&b""[..]), quoted(&[b'a'; 9000]).len()), ("it says nothing".to_owned(), QUOTED));
    }
}
