//! The command line's names for what the library's messages mention.
//!
//! The library's messages name settings in words; the program adds the flag of each in brackets.

use lightmesh::image::CompareError;
use lightmesh::render::Setting;
use lightmesh::render::accel::GridError;
use lightmesh::request::{Error, RequestError, Words};
use lightmesh::{LoadError, RenderError, SaveError};
#[cfg(feature = "bench")]
use lightmesh_bench::{BenchError, report::ReportError};

use crate::failure::Failure;

/// The flag of a setting of the renderer: it has the same name, except for the structure.
pub(crate) fn of(setting: Setting) -> String {
    match setting {
        Setting::Acceleration => "--accel".to_owned(),
        other => Words::Flags.of(other.name()),
    }
}

/// The flags and commands that may solve the problem.
pub(crate) fn that_mend(failure: &Failure) -> Vec<String> {
    #[cfg(feature = "bench")]
    const RESULTS: &str = "lightmesh bench SUITE --json FILE";
    let fixed: &[&str] = match failure {
        Failure::Request(error) => return that_mend_request(error),
        Failure::Grid(GridError::Memory { .. }) => &["--grid", "--memory-limit"],
        Failure::Grid(_) => &["--grid"],
        Failure::Compare(CompareError::Part { .. }) => &["lightmesh render --crop X,Y,W,H"],
        #[cfg(feature = "bench")]
        Failure::Bench(error) => match **error {
            BenchError::OwnScenes(_) => &["--scene", "--size"],
            BenchError::Malformed { .. } | BenchError::Version { .. } => &[RESULTS],
            BenchError::NothingInCommon { .. } => &["--quick"],
            _ => &[],
        },
        #[cfg(feature = "bench")]
        Failure::Report(error) => match &**error {
            ReportError::Twice { .. } => &[RESULTS],
            ReportError::Results(error)
                if matches!(**error, BenchError::Malformed { .. } | BenchError::Version { .. }) =>
            {
                &[RESULTS]
            }
            _ => &[],
        },
        _ => &[],
    };
    owned(fixed)
}

fn that_mend_request(error: &Error) -> Vec<String> {
    owned(match error {
        Error::Frame { cause, .. } => return that_mend_request(cause),
        Error::Render(RenderError::Grid(GridError::Memory { .. })) => &["--grid", "--memory-limit"],
        Error::Render(RenderError::Grid(_)) => &["--grid"],
        Error::Render(RenderError::GridFile(_)) => &["lightmesh grid SCENE -o FILE"],
        Error::Render(RenderError::Device { .. }) => &["--device", "lightmesh info --devices"],
        Error::Render(error) => return error.settings().into_iter().map(of).collect(),
        Error::Request(RequestError::Save(SaveError::UnknownExtension { .. })) => &["--format"],
        Error::Load(error) => match error.root() {
            LoadError::Memory { .. } => &["--memory-limit"],
            LoadError::SmoothMemory { .. } => &["--memory-limit", "--smooth off"],
            LoadError::Outside { .. } => &["--allow-outside"],
            LoadError::Warnings { .. } => &["--strict"],
            _ => &[],
        },
        _ => &[],
    })
}

fn owned(flags: &[&str]) -> Vec<String> {
    flags.iter().map(|&flag| flag.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use lightmesh_memory::OverBudget;

    use super::*;
    use crate::args;

    #[test]
    fn every_setting_of_the_renderer_has_a_flag() {
        let cli = args::command();
        let render = cli.find_subcommand("render").unwrap();
        let known: Vec<String> =
            render.get_arguments().filter_map(|flag| flag.get_long()).map(|long| format!("--{long}")).collect();
        for &setting in Setting::ALL {
            assert!(known.contains(&of(setting)), "{setting}: {known:?}");
        }
    }

    #[test]
    fn a_failure_names_the_flags_that_mend_it() {
        let short = OverBudget { needed: 2, left: 1, limit: None };
        let memory = RenderError::Memory {
            buffer: "masks",
            short,
            helps: [Setting::Size, Setting::AmbientLight].into_iter().collect(),
        };
        assert_eq!(that_mend(&memory.into()), ["--memory-limit", "--size", "--ambient-light"]);
        let strict = LoadError::Warnings { path: "a.obj".into(), warnings: vec!["odd".into()] };
        assert_eq!(that_mend(&strict.into()), ["--strict"]);
        assert!(that_mend(&RenderError::Cancelled.into()).is_empty());
    }
}
