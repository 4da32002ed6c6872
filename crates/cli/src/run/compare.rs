//! `lightmesh compare`.

use lightmesh::image::{Comparison, Frame, check_writable, compare};

use crate::args::CompareArgs;
use crate::failure::Failure;
use crate::memory;
use crate::output::{self, Outputs};

pub(super) fn run(args: &CompareArgs) -> Result<(), Failure> {
    if let Some(diff) = &args.diff {
        check_writable(diff)?;
        let outputs = Outputs::new([("--diff", Some(&**diff))])?;
        outputs.keep("A", [&*args.reference])?;
        outputs.keep("B", [&*args.test])?;
    }
    let compared = || Ok::<_, Failure>(compare(&Frame::load(&args.reference)?, &Frame::load(&args.test)?)?);
    let comparison = memory::during("comparing", compared)?;
    if let Some(diff) = &args.diff {
        comparison.difference.save(diff)?;
    }
    if args.json { output::print_json(&comparison) } else { output::print(&table(&comparison)) }?;
    check(args, &comparison)
}

fn table(comparison: &Comparison) -> String {
    let Comparison { rmse, psnr, max_difference, mean_flip, .. } = comparison;
    format!(
        "RMSE            {rmse:.6}\nPSNR            {psnr:.2} dB\nmax difference  {max_difference:.6}\nmean FLIP       {mean_flip:.6}\n"
    )
}

fn check(args: &CompareArgs, comparison: &Comparison) -> Result<(), Failure> {
    let bounds = [
        ("mean FLIP", comparison.mean_flip, "--max-flip", args.max_flip),
        ("RMSE", comparison.rmse, "--max-rmse", args.max_rmse),
    ];
    let exceeded = bounds.into_iter().filter_map(|(name, value, flag, bound)| {
        let bound = bound?.0;
        // Written so that NaN exceeds every threshold.
        let within = value <= bound;
        (!within).then(|| format!("{name} {value:.6} exceeds {flag} {bound}"))
    });
    let exceeded: Vec<String> = exceeded.collect();
    if exceeded.is_empty() { Ok(()) } else { Err(Failure::Exceeded(exceeded.join(", "))) }
}
