//! Whole frames: what the program renders by default, and what it could render instead.
//!
//! Rows have the keys of `shadows` but samples, and the methods
//!
//! * `lists`: the default, occluder lists;
//! * `half-ball`: the thesis' lookup with all its defaults, an automatic step among them;
//! * `adaptive`: adaptive shadow rays, with the samples of the lists.
//!
//! Times are those of all stages and of the whole frame, in turns. Values besides counts: `visibility_rmse` relative to
//! a converged reference, `samples` of each light, and of lists and adaptive rays the half-ball's time and error by
//! theirs, `faster_than_half_ball` and `nearer_than_half_ball`: above 1 they are ahead.

use std::time::Duration;

use lightmesh::{Lookup, Observer, image};

use super::case::{Case, Method};
use crate::suites::quality::visibility_rmse;
use crate::suites::turns::Turns;
use crate::{BenchError, Findings, Plan, Row, WHOLE, WHOLE_FRAMES};

/// The most important first.
const METHODS: [Method; 3] = [
    Method { name: "lists", choose: |settings| settings.with_lookup(Lookup::Lists) },
    Method { name: "half-ball", choose: |settings| settings.with_lookup(Lookup::HalfBall) },
    Method { name: "adaptive", choose: |settings| settings.with_lookup(Lookup::Adaptive) },
];

/// Measures a case, whose settings leave the samples open.
pub(super) fn measure(
    case: &Case,
    plan: &Plan,
    (share, converged): (Duration, &image::Frame),
    observer: &dyn Observer,
    findings: &mut Findings,
) -> Result<(), BenchError> {
    let variants: Vec<_> = METHODS.iter().map(|method| case.variant(method, false)).collect();
    let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
    let what = format!("whole frames of {} with emitters {:?}", case.subject.name, case.emitter);
    findings.notes.extend(turns.notes(&what, plan.repetitions));
    let mut rows = Vec::new();
    for (method, measured) in METHODS.iter().zip(&turns.measured) {
        let mut row = case.row_of(WHOLE_FRAMES, method.name, []);
        measured.fill(&mut row);
        let error = visibility_rmse(converged, &case.layered(method, observer)?);
        row.values.insert("visibility_rmse".to_owned(), error);
        row.values.insert("samples".to_owned(), f64::from(measured.frame.stats.settings.samples));
        rows.push(row);
    }
    compare(&mut rows);
    findings.add(rows);
    Ok(())
}

/// Adds the ratios to the half-ball's row.
fn compare(rows: &mut [Row]) {
    let figures = |row: &Row| Some((row.median(WHOLE)?, row.values.get("visibility_rmse").copied()?));
    let is_half_ball = |row: &Row| row.keys.get("method") == Some(&"half-ball".into());
    let Some((seconds, error)) = rows.iter().find(|row| is_half_ball(row)).and_then(figures) else { return };
    for row in rows.iter_mut().filter(|row| !is_half_ball(row)) {
        let Some((own_seconds, own_error)) = figures(row) else { continue };
        row.values.insert("faster_than_half_ball".to_owned(), seconds / own_seconds);
        if own_error > 0.0 {
            row.values.insert("nearer_than_half_ball".to_owned(), error / own_error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_above_1_are_ahead() {
        let row = |method: &str, seconds: f64, error: f64| {
            let mut row = Row::new(WHOLE_FRAMES, [("method", method.into())]);
            row.seconds.entry(WHOLE.to_owned()).or_default().push(seconds);
            row.values.insert("visibility_rmse".to_owned(), error);
            row
        };
        let mut rows = [row("lists", 0.5, 0.01), row("half-ball", 1.0, 0.05), row("adaptive", 2.0, 0.1)];
        compare(&mut rows);
        let ratios = |row: &Row| [row.values["faster_than_half_ball"], row.values["nearer_than_half_ball"]];
        assert_eq!((ratios(&rows[0]), ratios(&rows[2])), ([2.0, 5.0], [0.5, 0.5]));
        assert!(!rows[1].values.contains_key("faster_than_half_ball"));
    }
}
