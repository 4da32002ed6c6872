//! Everything that can end a run, and its exit code.

use lightmesh::render::accel::{GridError, GridSaveError};
use lightmesh::render::{MeshFault, MeshFileError, MeshSaveError};
use lightmesh::request::files::OutputError;
use lightmesh::request::{Error, RequestError, StageError, Told, Words};
use lightmesh::scene::{EnvironmentError, ExportError, SceneFormat};
use lightmesh::{LoadError, RenderError, SaveError, image};
#[cfg(feature = "bench")]
use lightmesh_bench::{BenchError, report::ReportError};

use crate::run::farm::error::FarmError;
use crate::server::ServerError;

/// A comparison exceeded its threshold.
pub(crate) const EXCEEDED: u8 = 1;
/// Bad input or usage.
pub(crate) const BAD_INPUT: u8 = 2;
/// Device unusable or memory insufficient.
pub(crate) const UNABLE: u8 = 3;
/// A film failed after some of its frames.
pub(crate) const PARTIAL: u8 = 4;
/// Interrupted by Ctrl-C. Other signals have other codes: 128 more than their numbers.
pub(crate) const INTERRUPTED: u8 = 130;

/// Why a run ended early. The message is one sentence: what, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The work on a request.
    #[error("{}", .0.told(Words::Flags))]
    Request(Box<Error>),
    #[error(transparent)]
    Grid(#[from] GridError),
    #[error(transparent)]
    GridSave(#[from] GridSaveError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(transparent)]
    Picture(#[from] image::LoadError),
    #[error(transparent)]
    Compare(#[from] image::CompareError),
    #[cfg(feature = "bench")]
    #[error(transparent)]
    Bench(Box<BenchError>),
    #[cfg(feature = "bench")]
    #[error(transparent)]
    Report(Box<ReportError>),
    /// Results or a report could not be written.
    #[cfg(feature = "bench")]
    #[error(transparent)]
    Kept(#[from] lightmesh_bench::OutputError),
    /// A measure of a comparison exceeds its threshold.
    #[error("{0}")]
    Exceeded(String),
    /// A scene on standard input has no extension.
    #[error("a scene on standard input needs its format; add --scene-format {}", scene_formats())]
    NoSceneFormat,
    /// Standard input is a terminal.
    #[error("standard input is a terminal, not a scene; redirect a file or a pipe to it, or name a file")]
    NoScene,
    /// There is no manual page of this name.
    #[error("unknown subcommand `{name}`; available: {}", known.join(", "))]
    UnknownPage {
        /// The requested name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A server cannot be had, or does not do what it is asked for.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// A film that cannot be shared out.
    #[error(transparent)]
    Farm(#[from] FarmError),
    /// The threads that wait for signals and for the end of memory cannot be started.
    #[error("cannot listen for signals ({0}); end other programs or raise the limits of this one")]
    Signals(#[from] std::io::Error),
}

/// The names of all formats of scenes.
fn scene_formats() -> String {
    let names: Vec<&str> = SceneFormat::ALL.iter().map(|format| format.name()).collect();
    names.join(", ")
}

/// What the library reports, as the error of a request.
macro_rules! of_request {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                Failure::Request(Box::new(error.into()))
            }
        })*
    };
}

of_request!(Error, RequestError, LoadError, RenderError, SaveError, OutputError);

#[cfg(feature = "bench")]
impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Failure {
        match error {
            // The exit code of the render that failed.
            BenchError::Render(error) => error.into(),
            BenchError::Scene(error) => error.into(),
            other => Failure::Bench(Box::new(other)),
        }
    }
}

#[cfg(feature = "bench")]
impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Failure {
        Failure::Report(Box::new(error))
    }
}

impl Failure {
    /// The exit code.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Failure::Exceeded(_) => EXCEEDED,
            Failure::Server(error) if error.is_of_usage() => BAD_INPUT,
            Failure::Signals(_) | Failure::Server(_) | Failure::Grid(GridError::Memory { .. }) => UNABLE,
            Failure::Request(error) => exit_code_of(error),
            _ => BAD_INPUT,
        }
    }
}

/// The exit code of work on a request that ended early.
fn exit_code_of(error: &Error) -> u8 {
    match error {
        Error::Frame { finished: 0, cause, .. } => exit_code_of(cause),
        Error::Frame { .. } => PARTIAL,
        Error::Render(RenderError::Cancelled) => INTERRUPTED,
        Error::Render(
            RenderError::Memory { .. }
            | RenderError::BuildMemory { .. }
            | RenderError::TextureMemory { .. }
            | RenderError::Grid(GridError::Memory { .. })
            | RenderError::Threads { .. }
            | RenderError::Device { .. }
            | RenderError::DeviceMemory { .. }
            | RenderError::DeviceFault { .. },
        )
        | Error::Stage(StageError::Environment(EnvironmentError::Memory { .. }))
        | Error::Mesh(MeshFileError { fault: MeshFault::Memory(_), .. })
        | Error::MeshSave(MeshSaveError::Device { .. }) => UNABLE,
        Error::Load(error) if matches!(error.root(), LoadError::Memory { .. } | LoadError::SmoothMemory { .. }) => {
            UNABLE
        }
        _ => BAD_INPUT,
    }
}

#[cfg(test)]
mod tests {
    use lightmesh::render::{Setting, SettingSet};
    use lightmesh_memory::OverBudget;

    use super::*;

    #[test]
    fn what_the_machine_cannot_do_is_told_from_bad_input() {
        let short = OverBudget { needed: 2, left: 1, limit: None };
        let memory = RenderError::Memory { buffer: "masks", short, helps: SettingSet::default() };
        let device = RenderError::Device { device: "cuda".into(), reason: "none".into() };
        let (buffer, helps) = ("masks", SettingSet::default());
        let full = RenderError::DeviceMemory { device: "Fake".into(), buffer, needed: 2, free: Some(1), helps };
        let fault = RenderError::DeviceFault { device: "Fake".into(), reason: "none".into() };
        let setting = RenderError::Setting { setting: Setting::Size, value: "0x0".into(), remedy: "choose another" };
        let errors = [memory, device, full, fault, setting, RenderError::Cancelled];
        let codes = errors.map(|error| Failure::from(error).exit_code());
        assert_eq!(codes, [UNABLE, UNABLE, UNABLE, UNABLE, BAD_INPUT, INTERRUPTED]);
        assert_eq!(Failure::Exceeded("RMSE".into()).exit_code(), EXCEEDED);
        let frame = |finished| {
            let cause = Box::new(Error::from(RenderError::Device { device: "cuda".into(), reason: "none".into() }));
            Failure::from(Error::Frame { number: 3, last: 9, finished, goes_on: "resume", cause })
        };
        assert_eq!([0, 2].map(|finished| frame(finished).exit_code()), [UNABLE, PARTIAL]);
        assert!(frame(2).to_string().ends_with("; 2 frames are finished (--resume goes on)"));
    }
}
