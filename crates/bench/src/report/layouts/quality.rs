//! Errors against what they cost: for each scene and place a curve or points for each method, on logarithmic axes. What equal errors cost
//! was worked out by the suite.

use super::generic;
use super::{key_text, whole};
use crate::report::assets::slug;
use crate::report::document::{Block, Finding, Verdict};
use crate::report::findings::Spread;
use crate::report::numbers;
use crate::report::plot::{Axis, Curve, Plot};
use crate::report::runs::{Measured, Runs, distinct};

/// Errors that are plotted, with their names.
const ERRORS: [(&str, &str); 3] =
    [("visibility_rmse", "RMSE of visibility"), ("mean_flip", "mean FLIP"), ("rmse", "RMSE of the picture")];
/// What a method is called by, the first that is there.
const METHOD: [&str; 2] = ["program", "mode"];
/// What the suite found of the cost of equal errors.
const EQUAL_ERROR: &str = "equal error";
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

/// Points by method, each in order of time. Shadow rays differ in their number alone, which makes a line; light meshes differ in all sorts
/// of settings.
fn curves(rows: &[Measured], point: impl Fn(&Measured) -> Option<(f64, f64)>) -> Vec<Curve> {
    let names = distinct(rows.iter().map(method));
    let curves = names.into_iter().map(|name| {
        let of_method: Vec<&Measured> = rows.iter().filter(|row| method(row) == name).collect();
        let mut points: Vec<(f64, f64)> = of_method.iter().copied().filter_map(&point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let scattered = of_method.iter().any(|row| row.is("mode", "light-mesh"));
        Curve { name, points, scattered }
    });
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// What a row's method is called.
fn method(row: &Measured) -> String {
    let name = METHOD.into_iter().map(|key| row.text(key)).find(|name| !name.is_empty()).unwrap_or_default();
    let name = match name.as_str() {
        "light-mesh" => "light mesh".to_owned(),
        "area" => "shadow rays".to_owned(),
        "ray-trace" => "hard shadows".to_owned(),
        _ => name,
    };
    if row.is("emitter", "point") { name + ", point lights" } else { name }
}

/// What equal errors cost, for each measure, scene and place: the method's time over that of shadow rays.
pub(crate) fn findings(runs: &Runs) -> Vec<Finding> {
    let rows = runs.rows(EQUAL_ERROR);
    let name = |row: &Measured| (subject(row), row.text("measure"));
    distinct(rows.iter().map(name))
        .into_iter()
        .filter_map(|wanted| {
            let rows: Vec<&Measured> = rows.iter().filter(|row| name(row) == wanted).collect();
            equal_error(&wanted.0, &wanted.1, &rows)
        })
        .collect()
}

fn equal_error(subject: &str, measure: &str, rows: &[&Measured]) -> Option<Finding> {
    let range = Spread::of(rows.iter().filter_map(|row| Some(row.value("seconds")? / row.value("area_seconds")?)))?;
    let errors = Spread::of(rows.iter().filter_map(|row| row.value("error")))?;
    let title = ERRORS.iter().find(|(name, _)| *name == measure).map_or(measure, |(_, title)| title);
    let with = |name| rows.iter().filter(|row| row.value(name).is_some()).count();
    let (bounds, never, all) = (with("upper_bound"), with("not_reached"), rows.len());
    let mut text = format!(
        "{subject}: at equal error ({title}, {}) the light mesh takes {} the time of shadow rays for each pixel.",
        errors.text(|error| numbers::significant(error, 2)),
        range.text(numbers::ratio)
    );
    if bounds > 0 {
        text += &format!(" In {bounds} of {all} settings a single shadow ray has a smaller error already.");
    }
    if never > 0 {
        text += &format!(" In {never} of {all} no number of shadow rays that was measured has so small an error.");
    }
    Some(Finding::new(if never > 0 { range.verdict().max(Verdict::Open) } else { range.verdict() }, text))
}

/// The suite's table of equal errors, the best ratio first in each scene.
pub(super) fn equal_errors(rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("error", "error"),
        ("seconds", "light mesh, s"),
        ("area_seconds", "shadow rays, s"),
        ("faster_than_area", "times faster"),
        ("rays", "rays"),
        ("short_tests", "short tests"),
        ("area_samples", "shadow rays a pixel and light"),
        ("area_rays", "shadow rays"),
    ];
    let caption = "What a light mesh costs, and what shadow rays cost that have the same error. Times faster: below 1 the light mesh is \
                   slower. Without figures of shadow rays: no number of them that was measured has so small an error.";
    vec![generic::chosen(EQUAL_ERROR, caption, rows, &[], &values)]
}

/// What shadow rays reach in the time of the light mesh.
pub(super) fn equal_time(rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("seconds", "s"),
        ("samples", "shadow rays a pixel and light"),
        ("visibility_rmse", "RMSE of visibility, light mesh"),
        ("area_visibility_rmse", "shadow rays"),
        ("mean_flip", "mean FLIP, light mesh"),
        ("area_mean_flip", "shadow rays"),
    ];
    vec![generic::chosen("equal time", "As many shadow rays as take the time of the light mesh.", rows, &[], &values)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_errors_that_cost_more_are_lost() {
        let results = crate::report::tests::results("quality", |rows| {
            for (factor, radius) in [(2.0, 2.1), (3.0, 3.1)] {
                let keys = [("scene", "garden".into()), ("measure", "mean_flip".into()), ("radius", radius.into())];
                let mut row = crate::Row::new(EQUAL_ERROR, keys);
                let values = [("error", 0.1), ("seconds", 0.4), ("area_seconds", 0.4 / factor)];
                row.values.extend(values.map(|(name, value)| (name.to_owned(), value)));
                rows.push(row);
            }
            rows[1].values.insert("upper_bound".to_owned(), 1.0);
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let findings = findings(&runs);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].verdict, Verdict::Loses);
        assert_eq!(
            findings[0].text,
            "garden: at equal error (mean FLIP, 0.10) the light mesh takes 2.0× to 3.0× the time of shadow rays for each pixel. In 1 of 2 \
             settings a single shadow ray has a smaller error already."
        );
    }
}
