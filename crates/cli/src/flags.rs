//! The command line's names for what the library's messages mention.
//!
//! The library's messages name settings in words; the program adds the flag of each in brackets.

use lightmesh::render::Setting;
use lightmesh::render::accel::GridError;
use lightmesh::{LoadError, RenderError, SaveError};
use lightmesh_bench::BenchError;
use lightmesh_bench::report::ReportError;

use crate::failure::Failure;
use crate::plan::PlanError;

/// The flag of a setting: it has the same name, except for the structure.
pub(crate) fn of(setting: Setting) -> String {
    match setting {
        Setting::Acceleration => "--accel".to_owned(),
        other => format!("--{}", other.name().replace('_', "-")),
    }
}

/// The flags and commands that may solve the problem.
pub(crate) fn that_mend(failure: &Failure) -> Vec<String> {
    const RESULTS: &str = "lightmesh bench SUITE --json FILE";
    let fixed: &[&str] = match failure {
        Failure::Frame { cause, .. } => return that_mend(cause),
        Failure::Render(RenderError::Grid(GridError::Memory { .. })) | Failure::Grid(GridError::Memory { .. }) => {
            &["--grid", "--memory-limit"]
        }
        Failure::Render(RenderError::Grid(_)) | Failure::Grid(_) => &["--grid"],
        Failure::Render(RenderError::GridFile(_)) => &["lightmesh grid SCENE -o FILE"],
        Failure::Render(RenderError::Device { .. }) => &["--device", "lightmesh info --devices"],
        Failure::Render(error) => return error.settings().into_iter().map(of).collect(),
        Failure::Plan(PlanError::Save(SaveError::UnknownExtension { .. })) => &["--format"],
        Failure::Load(error) => match error.root() {
            LoadError::Memory { .. } => &["--memory-limit"],
            LoadError::SmoothMemory { .. } => &["--memory-limit", "--smooth off"],
            LoadError::Outside { .. } => &["--allow-outside"],
            LoadError::Warnings { .. } => &["--strict"],
            _ => &[],
        },
        Failure::Bench(error) => match **error {
            BenchError::OwnScenes(_) => &["--scene", "--size"],
            BenchError::Malformed { .. } | BenchError::Version { .. } => &[RESULTS],
            BenchError::NothingInCommon { .. } => &["--quick"],
            _ => &[],
        },
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
    fixed.iter().map(|&flag| flag.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use lightmesh_memory::Short;

    use super::*;
    use crate::args;

    #[test]
    fn every_setting_has_a_flag() {
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
        let memory = RenderError::Memory { buffer: "masks", short: Short { needed: 2, left: 1, limit: None } };
        assert_eq!(that_mend(&memory.into()), ["--memory-limit", "--size", "--step", "--radius"]);
        let strict = LoadError::Warnings { path: "a.obj".into(), warnings: vec!["odd".into()] };
        assert_eq!(that_mend(&strict.into()), ["--strict"]);
        assert!(that_mend(&RenderError::Cancelled.into()).is_empty());
    }
}
