//! Errors against what they cost: for each scene and place a curve for each method, on logarithmic axes.

use super::generic::{self, split_keys};
use super::{key_text, whole};
use crate::report::assets::slug;
use crate::report::document::{Block, Finding};
use crate::report::findings::Spread;
use crate::report::numbers;
use crate::report::plot::{Axis, Curve, Plot};
use crate::report::runs::{Measured, Runs, distinct};

/// Errors that are plotted, with their names.
const ERRORS: [(&str, &str); 2] = [("visibility_rmse", "RMSE of visibility"), ("mean_flip", "mean FLIP")];
/// Keys that move along a curve; all others tell curves apart.
const ALONG: [&str; 3] = ["samples", "step", "h"];
/// Keys that tell plots apart.
const SUBJECT: [&str; 3] = ["scene", "lights", "size"];

/// Whether rows have errors and times to be plotted.
pub(super) fn fits(rows: &[Measured]) -> bool {
    rows.iter().any(|row| whole(row).is_some() && ERRORS.iter().any(|(error, _)| row.value(error).is_some()))
}

/// Plots of each error, then all rows.
pub(super) fn errors(experiment: &str, rows: &[Measured]) -> Vec<Block> {
    let subjects = distinct(rows.iter().map(subject));
    let plots = subjects.iter().flat_map(|wanted| {
        let rows: Vec<Measured> = rows.iter().filter(|row| subject(row) == *wanted).copied().collect();
        ERRORS.iter().filter_map(move |error| plot(experiment, *error, wanted, &rows).map(Block::Plot))
    });
    plots.chain(generic::blocks(experiment, rows)).collect()
}

/// Scene and place.
fn subject(row: &Measured) -> String {
    let keys = SUBJECT.iter().filter_map(|name| row.key(name)).map(key_text);
    keys.chain([row.place()]).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

fn plot(experiment: &str, (error, title): (&str, &str), subject: &str, rows: &[Measured]) -> Option<Plot> {
    let rows: Vec<Measured> =
        rows.iter().filter(|row| row.value(error).is_some_and(|error| error > 0.0)).copied().collect();
    let curves = curves(&rows, |row| Some((1e3 * whole(row)?, row.value(error)?)));
    (!curves.is_empty()).then(|| Plot {
        name: slug(&format!("{experiment} {subject} {error}")),
        caption: format!("{subject}: {title} against milliseconds of a picture. Lower and further left is better."),
        x: Axis { title: "ms".to_owned(), log: true },
        y: Axis { title: title.to_owned(), log: true },
        curves,
        marks: Vec::new(),
    })
}

/// Points by method, each in order of time.
fn curves(rows: &[Measured], point: impl Fn(&Measured) -> Option<(f64, f64)>) -> Vec<Curve> {
    let names = distinct(rows.iter().map(|row| method(row, rows)));
    let curves = names.into_iter().map(|name| {
        let of_method = rows.iter().filter(|row| method(row, rows) == name);
        let mut points: Vec<(f64, f64)> = of_method.filter_map(&point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve { name, points, scattered: false }
    });
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// What a row's method is called: its key `method`, or its mode with the keys in which rows of that mode differ.
fn method(row: &Measured, rows: &[Measured]) -> String {
    if row.key("method").is_some() {
        return row.text("method");
    }
    let mode = row.text("mode");
    let same_mode: Vec<Measured> = rows.iter().filter(|other| other.text("mode") == mode).copied().collect();
    let (keys, _) = split_keys(&same_mode);
    let place = ["device", "threads"];
    let keys = keys.iter().filter(|key| !ALONG.contains(&key.as_str()) && !SUBJECT.contains(&key.as_str()));
    let keys = keys.filter(|key| !place.contains(&key.as_str()));
    let words = keys.map(|key| if key == "radius" { format!("R {}", row.text(key)) } else { row.text(key) });
    std::iter::once(mode).chain(words).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ")
}

/// What equal errors cost, for each error, scene and place: the method's time over that of shadow rays.
pub(crate) fn findings(runs: &Runs) -> Vec<Finding> {
    let mut findings = Vec::new();
    for experiment in runs.experiments() {
        let rows: Vec<Measured> = runs.rows(experiment).into_iter().filter(|row| whole(row).is_some()).collect();
        for wanted in distinct(rows.iter().map(subject)) {
            let rows: Vec<Measured> = rows.iter().filter(|row| subject(row) == wanted).copied().collect();
            findings.extend(ERRORS.iter().filter_map(|error| equal_error(&wanted, *error, &rows)));
        }
    }
    findings
}

fn equal_error(subject: &str, (error, title): (&str, &str), rows: &[Measured]) -> Option<Finding> {
    let points = |mode: &str| {
        let rows = rows.iter().filter(|row| row.is("mode", mode));
        let mut points: Vec<(f64, f64)> =
            rows.filter_map(|row| Some((row.value(error).filter(|error| *error > 0.0)?, whole(row)?))).collect();
        points.sort_by(|a, b| b.0.total_cmp(&a.0));
        points
    };
    let shadow_rays = points("area");
    let mesh = points("light-mesh");
    let ratios = mesh.iter().filter_map(|&(error, seconds)| Some(seconds / seconds_for(error, &shadow_rays)?));
    let range = Spread::of(ratios)?;
    let (least, most) = (mesh.last()?.0, mesh.first()?.0);
    let errors = Spread { least, most }.text(|error| numbers::significant(error, 2));
    let text = format!(
        "{subject}: at equal error ({title}, {errors}) the light mesh takes {} the time of shadow rays for each pixel.",
        range.text(numbers::ratio)
    );
    Some(Finding::new(range.verdict(), text))
}

/// Seconds of shadow rays for an error: between measurements by straight lines over logarithms; the fewest rays where even those do
/// better; `None` where the most do worse. Points come with the largest error first.
fn seconds_for(error: f64, points: &[(f64, f64)]) -> Option<f64> {
    let better = points.iter().position(|point| point.0 <= error)?;
    let (low, after) = points[better];
    let Some(&(high, before)) = better.checked_sub(1).map(|index| &points[index]) else { return Some(after) };
    let share = (high / error).ln() / (high / low).ln();
    Some((before.ln() + share * (after / before).ln()).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_of_an_error_lie_between_measurements() {
        let points = [(0.4, 1.0), (0.1, 16.0)];
        assert_eq!(seconds_for(0.5, &points), Some(1.0));
        assert!((seconds_for(0.2, &points).unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(seconds_for(0.1, &points), Some(16.0));
        assert_eq!(seconds_for(0.05, &points), None);
    }
}
