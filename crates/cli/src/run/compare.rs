//! `lightmesh compare`.

use lightmesh::image::{Comparison, Frame, LinearDifference, Range, check_writable, compare, compare_linear};

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
    let comparison = memory::during("comparing", || compared(args))?;
    if let Some(diff) = &args.diff {
        comparison.difference.save(diff)?;
    }
    if args.json { output::print_json(&comparison) } else { output::print(&table(&comparison)) }?;
    check(args, &comparison)
}

/// Where both files store light, so do its measures.
fn compared(args: &CompareArgs) -> Result<Comparison, Failure> {
    let (reference, range) = Frame::load_with_range(&args.reference)?;
    let (test, other) = Frame::load_with_range(&args.test)?;
    let compare = if (range, other) == (Range::Light, Range::Light) { compare_linear } else { compare };
    Ok(compare(&reference, &test)?)
}

fn table(comparison: &Comparison) -> String {
    let Comparison { rmse, psnr, max_difference, mean_flip, .. } = comparison;
    let display = format!(
        "RMSE            {rmse:.6}\nPSNR            {psnr:.2} dB\nmax difference  {max_difference:.6}\nmean FLIP       {mean_flip:.6}\n"
    );
    let linear = comparison.linear.as_ref().map(|LinearDifference { relative_rmse, max_linear_difference, mean_hdr_flip, .. }| {
        format!(
            "relative RMSE   {relative_rmse:.6} (linear values)\nmax difference  {max_linear_difference:.6} (linear values)\nmean HDR-FLIP   {mean_hdr_flip:.6}\n"
        )
    });
    display + &linear.unwrap_or_default()
}

fn check(args: &CompareArgs, comparison: &Comparison) -> Result<(), Failure> {
    let mut bounds = vec![
        ("mean FLIP", comparison.mean_flip, "--max-flip", args.max_flip),
        ("RMSE", comparison.rmse, "--max-rmse", args.max_rmse),
    ];
    if let Some(linear) = &comparison.linear {
        bounds.push(("mean HDR-FLIP", linear.mean_hdr_flip, "--max-flip", args.max_flip));
        bounds.push(("relative RMSE", linear.relative_rmse, "--max-rmse", args.max_rmse));
    }
    let exceeded = bounds.into_iter().filter_map(|(name, value, flag, bound)| {
        let bound = bound?.0;
        // Written so that NaN exceeds every threshold.
        let within = value <= bound;
        (!within).then(|| format!("{name} {value:.6} exceeds {flag} {bound}"))
    });
    let exceeded: Vec<String> = exceeded.collect();
    if exceeded.is_empty() { Ok(()) } else { Err(Failure::Exceeded(exceeded.join(", "))) }
}
