//! `lightmesh bench compare`.

use lightmesh_bench::{BenchError, Results, RunComparison};

use crate::args::BenchCompareArgs;
use crate::failure::Failure;
use crate::output;

pub(super) fn run(args: &BenchCompareArgs) -> Result<(), Failure> {
    let comparison = RunComparison::new(&Results::load(&args.old)?, &Results::load(&args.new)?);
    if comparison.stages.is_empty() {
        return Err(BenchError::NothingInCommon { old: args.old.clone(), new: args.new.clone() }.into());
    }
    if args.json { output::print_json(&comparison) } else { output::print(&comparison.to_string()) }?;
    match comparison.regressions {
        0 => Ok(()),
        1 => Err(Failure::Exceeded("1 row is significantly slower".to_owned())),
        count => Err(Failure::Exceeded(format!("{count} rows are significantly slower"))),
    }
}
