//! Errors against converged area shadows, and what equal errors cost.

use lightmesh::Observer;

use crate::{BenchError, Findings, Plan, engine};

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    observer.note("nothing is measured yet");
    Ok(())
}
