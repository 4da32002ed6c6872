//! Everything that can end a run, and its exit code.

use lightmesh::render::accel::{GridError, GridSaveError};
use lightmesh::render::{MeshFault, MeshFileError, MeshSaveError};
use lightmesh::scene::{EnvironmentError, ExportError, SceneFormat};
use lightmesh::{LoadError, RenderError, SaveError, image};
use lightmesh_bench::BenchError;
use lightmesh_bench::report::ReportError;

use crate::manifest::ManifestError;
use crate::output::OutputError;
use crate::plan::{ChoiceError, PlanError};
use crate::run::MovieError;

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
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    #[error(transparent)]
    Movie(#[from] MovieError),
    /// A film ended early.
    #[error("frame {number} of {last}: {cause}{}", what_is_there(*finished, flag))]
    Frame {
        /// The frame that failed.
        number: u32,
        /// The film's last one.
        last: u32,
        /// How many frames that were asked for are there.
        finished: usize,
        /// The flag that goes on with them.
        flag: &'static str,
        /// Why.
        cause: Box<Failure>,
    },
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Grid(#[from] GridError),
    #[error(transparent)]
    GridSave(#[from] GridSaveError),
    #[error(transparent)]
    Mesh(#[from] MeshFileError),
    #[error(transparent)]
    MeshSave(#[from] MeshSaveError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(transparent)]
    Picture(#[from] image::LoadError),
    #[error(transparent)]
    Compare(#[from] image::CompareError),
    #[error(transparent)]
    Bench(Box<BenchError>),
    #[error(transparent)]
    Report(Box<ReportError>),
    /// Results or a report could not be written.
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
    /// The threads that wait for signals and for the end of memory cannot be started.
    #[error("cannot listen for signals ({0}); end other programs or raise the limits of this one")]
    Signals(#[from] std::io::Error),
}

/// The names of all formats of scenes.
fn scene_formats() -> String {
    let names: Vec<&str> = SceneFormat::ALL.iter().map(|format| format.name()).collect();
    names.join(", ")
}

/// What is there of a film, and how to go on.
fn what_is_there(count: usize, flag: &str) -> String {
    match count {
        0 => String::new(),
        1 => format!("; 1 frame is finished ({flag} goes on)"),
        count => format!("; {count} frames are finished ({flag} goes on)"),
    }
}

impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Failure {
        match error {
            // The exit code of the render that failed.
            BenchError::Render(error) => Failure::Render(error),
            BenchError::Scene(error) => Failure::Load(error),
            other => Failure::Bench(Box::new(other)),
        }
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Failure {
        Failure::Report(Box::new(error))
    }
}

impl Failure {
    /// What happened to frame `number` of a film up to `last`, of which some are `finished`: `flag` goes on with them.
    pub(crate) fn in_frame(self, number: u32, last: u32, finished: usize, flag: &'static str) -> Failure {
        match self {
            Failure::Render(RenderError::Cancelled) => self,
            cause => Failure::Frame { number, last, finished, flag, cause: Box::new(cause) },
        }
    }

    /// The exit code.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Failure::Exceeded(_) => EXCEEDED,
            Failure::Frame { finished: 0, cause, .. } => cause.exit_code(),
            Failure::Frame { .. } => PARTIAL,
            Failure::Signals(_) => UNABLE,
            Failure::Render(error) => match error {
                RenderError::Cancelled => INTERRUPTED,
                RenderError::Memory { .. }
                | RenderError::BuildMemory { .. }
                | RenderError::TextureMemory { .. }
                | RenderError::Grid(GridError::Memory { .. })
                | RenderError::Threads { .. }
                | RenderError::Device { .. }
                | RenderError::DeviceMemory { .. }
                | RenderError::DeviceFault { .. } => UNABLE,
                _ => BAD_INPUT,
            },
            Failure::Load(error)
                if matches!(error.root(), LoadError::Memory { .. } | LoadError::SmoothMemory { .. }) =>
            {
                UNABLE
            }
            Failure::Choice(ChoiceError::Environment(EnvironmentError::Memory { .. })) => UNABLE,
            Failure::Grid(GridError::Memory { .. })
            | Failure::Mesh(MeshFileError { fault: MeshFault::Memory(_), .. })
            | Failure::MeshSave(MeshSaveError::Device { .. }) => UNABLE,
            _ => BAD_INPUT,
        }
    }
}

#[cfg(test)]
mod tests {
    use lightmesh::render::Setting;
    use lightmesh_memory::Short;

    use super::*;

    #[test]
    fn what_the_machine_cannot_do_is_told_from_bad_input() {
        let memory = RenderError::Memory { buffer: "masks", short: Short { needed: 2, left: 1, limit: None } };
        let device = RenderError::Device { device: "cuda".into(), reason: "none".into() };
        let full = RenderError::DeviceMemory { device: "Fake".into(), buffer: "masks", needed: 2, free: Some(1) };
        let fault = RenderError::DeviceFault { device: "Fake".into(), reason: "none".into() };
        let setting = RenderError::Setting { setting: Setting::Size, value: "0x0".into(), remedy: "choose another" };
        let errors = [memory, device, full, fault, setting, RenderError::Cancelled];
        let codes = errors.map(|error| Failure::from(error).exit_code());
        assert_eq!(codes, [UNABLE, UNABLE, UNABLE, UNABLE, BAD_INPUT, INTERRUPTED]);
        assert_eq!(Failure::Exceeded("RMSE".into()).exit_code(), EXCEEDED);
        let frame = |finished| {
            let cause = Failure::from(RenderError::Device { device: "cuda".into(), reason: "none".into() });
            cause.in_frame(3, 9, finished, "--resume")
        };
        assert_eq!([0, 2].map(|finished| frame(finished).exit_code()), [UNABLE, PARTIAL]);
        assert!(frame(2).to_string().ends_with("; 2 frames are finished (--resume goes on)"));
        let cancelled = Failure::from(RenderError::Cancelled).in_frame(3, 9, 2, "--resume");
        assert_eq!(cancelled.exit_code(), INTERRUPTED);
    }
}
