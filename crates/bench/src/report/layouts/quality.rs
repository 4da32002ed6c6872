//! Errors against cost: for each scene and device, a curve or points for each method, on logarithmic axes. The cost at equal
//! error is computed by the suite.

use super::generic;
use super::{WHOLE, key_text, title, whole};
use crate::report::assets::slug;
use crate::report::document::{Block, Finding, Verdict};
use crate::report::numbers;
use crate::report::plot::{Axis, Curve, Plot};
use crate::report::runs::{Measured, Runs, distinct};
use crate::report::spread::{Spread, verdict};

/// Errors to plot, with their names.
const ERRORS: [(&str, &str); 3] =
    [("visibility_rmse", "RMSE of visibility"), ("mean_flip", "mean FLIP"), ("rmse", "RMSE of the image")];
/// Values shown for a row besides its time, if present.
const COLUMNS: [(&str, &str); 8] = [
    ("visibility_rmse", "RMSE of visibility"),
    ("mean_flip", "mean FLIP"),
    ("rmse", "RMSE of the image"),
    ("reference_rmse", "RMSE of the reference"),
    ("shadow_rays", "shadow rays"),
    ("long_tests", "long tests"),
    ("short_tests", "short tests"),
    ("light_points_per_pixel", "S_total per pixel"),
];
/// The keys that name a method; the first one present is used.
const METHOD: [&str; 2] = ["program", "mode"];
/// The experiment with the cost at equal error.
const EQUAL_ERROR: &str = "equal error";
/// Keys that identify a plot.
const SUBJECT: [&str; 3] = ["scene", "lights", "size"];

/// Whether rows have errors and times to plot.
pub(super) fn fits(rows: &[Measured]) -> bool {
    rows.iter().any(|row| whole(row).is_some() && ERRORS.iter().any(|(error, _)| row.value(error).is_some()))
}

/// Plots of each error, then a table of all rows.
pub(super) fn errors(experiment: &str, rows: &[Measured]) -> Vec<Block> {
    let subjects = distinct(rows.iter().map(subject));
    let plots = subjects.iter().flat_map(|wanted| {
        let rows: Vec<Measured> = rows.iter().filter(|row| subject(row) == *wanted).copied().collect();
        ERRORS.iter().filter_map(move |error| plot(experiment, *error, wanted, &rows).map(Block::Plot))
    });
    plots.chain([generic::chosen(experiment, "", rows, &[(WHOLE, "whole")], &COLUMNS)]).collect()
}

/// Scene and device.
fn subject(row: &Measured) -> String {
    let text = |(name, key)| if name == "size" { format!("{0} × {0}", key_text(key)) } else { key_text(key) };
    let keys = SUBJECT.iter().filter_map(|&name| Some((name, row.key(name)?))).map(text);
    keys.chain([row.place()]).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

fn plot(experiment: &str, (error, title): (&str, &str), subject: &str, rows: &[Measured]) -> Option<Plot> {
    let rows: Vec<Measured> =
        rows.iter().filter(|row| row.value(error).is_some_and(|error| error > 0.0)).copied().collect();
    let curves = curves(&rows, |row| Some((1e3 * whole(row)?, row.value(error)?)));
    (!curves.is_empty()).then(|| Plot {
        name: slug(&format!("{experiment} {subject} {error}")),
        caption: format!("{subject}: {title} against milliseconds per frame. Lower and further left is better."),
        x: Axis { title: "ms".to_owned(), log: true },
        y: Axis { title: title.to_owned(), log: true },
        curves,
        marks: Vec::new(),
    })
}

/// Points by method, each in order of time. Shadow rays and samples of occluder lists differ only in number, which makes a line; light
/// meshes differ in various settings.
fn curves(rows: &[Measured], point: impl Fn(&Measured) -> Option<(f64, f64)>) -> Vec<Curve> {
    let names = distinct(rows.iter().map(method));
    let curves = names.into_iter().map(|name| {
        let of_method: Vec<&Measured> = rows.iter().filter(|row| method(row) == name).collect();
        let mut points: Vec<(f64, f64)> = of_method.iter().copied().filter_map(&point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let scattered = of_method.iter().any(|row| row.is_half_ball());
        Curve { name, points, scattered }
    });
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// The name of a row's method.
fn method(row: &Measured) -> String {
    let name = METHOD.into_iter().map(|key| row.text(key)).find(|name| !name.is_empty()).unwrap_or_default();
    let name = match name.as_str() {
        "light-mesh" if row.is("lookup", "lists") => "occluder lists".to_owned(),
        "light-mesh" if row.is("lookup", "adaptive") => "adaptive shadow rays".to_owned(),
        "light-mesh" => "light mesh".to_owned(),
        "area" => "shadow rays".to_owned(),
        "ray-trace" => "hard shadows".to_owned(),
        _ => name,
    };
    if row.is("emitter", "point") { name + ", point lights" } else { name }
}

/// Cost at equal error for each measure, scene and device: the method's time over that of shadow rays.
pub(crate) fn findings(runs: &Runs) -> Vec<Finding> {
    let rows = runs.rows(EQUAL_ERROR);
    let name = |row: &Measured| (subject(row), row.text("measure"), contender(row));
    distinct(rows.iter().map(name))
        .into_iter()
        .filter_map(|wanted| {
            let rows: Vec<&Measured> = rows.iter().filter(|row| name(row) == wanted).collect();
            equal_error(&wanted.0, &wanted.1, wanted.2, &rows)
        })
        .collect()
}

/// What is compared with shadow rays, as the subject of a sentence, and whether that is plural.
fn contender(row: &Measured) -> (&'static str, bool) {
    match row.text("lookup").as_str() {
        "lists" => ("occluder lists", true),
        "adaptive" => ("adaptive shadow rays", true),
        _ => ("the light mesh", false),
    }
}

fn equal_error(subject: &str, measure: &str, (contender, plural): (&str, bool), rows: &[&Measured]) -> Option<Finding> {
    let range = Spread::of(rows.iter().filter_map(|row| ratio(row)))?;
    let errors = Spread::of(rows.iter().filter_map(|row| row.value("error")))?;
    let name = ERRORS.iter().find(|(name, _)| *name == measure).map_or(measure, |(_, title)| title);
    let with = |name: &str| -> Vec<&&Measured> { rows.iter().filter(|row| row.value(name).is_some()).collect() };
    let (bounds, never, all) = (with("upper_bound"), with("not_reached").len(), rows.len());
    let mut text = format!(
        "{}: at equal error ({name}, {}) {contender} {} {} the time of shadow rays, over {all} settings.",
        title(subject),
        errors.text(|error| numbers::significant(error, 2)),
        if plural { "take" } else { "takes" },
        range.text(numbers::ratio)
    );
    if !bounds.is_empty() {
        text += &format!(" In {} of them a single shadow ray already has a smaller error", bounds.len());
        let faster =
            bounds.iter().filter_map(|row| ratio(row)).filter(|ratio| verdict(*ratio) != Verdict::Loses).count();
        text += &match faster {
            0 => ".".to_owned(),
            _ => format!("; taking no more time than that, as in {faster} of these, is not a gain at equal error."),
        };
    }
    if never > 0 {
        text += &format!(" In {never} of them no measured number of shadow rays has an error this small.");
    }
    let verdicts = distinct(rows.iter().map(|row| outcome(row)));
    if verdicts.len() > 1 {
        let count = |wanted| rows.iter().filter(|row| outcome(row) == wanted).count();
        let [wins, loses] = if plural { ["They win", "lose"] } else { ["It wins", "loses"] };
        text += &format!(" {wins} in {} and {loses} in {}.", count(Verdict::Wins), count(Verdict::Loses));
    }
    Some(Finding::new(if let [one] = verdicts[..] { one } else { Verdict::Depends }, text))
}

/// The method's time over that of shadow rays with the same error.
fn ratio(row: &Measured) -> Option<f64> {
    Some(row.value("seconds")? / row.value("area_seconds")?)
}

/// The verdict for one setting. It is open if shadow rays are more accurate but not faster, or never reach the error.
fn outcome(row: &Measured) -> Verdict {
    match ratio(row).map(verdict) {
        Some(Verdict::Wins) if row.value("upper_bound").is_some() => Verdict::Open,
        Some(verdict) => verdict,
        None => Verdict::Open,
    }
}

/// The suite's table of costs at equal error, best ratio first in each scene.
pub(super) fn equal_errors(rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("error", "error"),
        ("seconds", "s"),
        ("area_seconds", "shadow rays, s"),
        ("faster_than_area", "speed-up"),
        ("rays", "rays"),
        ("short_tests", "short tests"),
        ("area_samples", "shadow rays per pixel and light"),
        ("area_rays", "shadow rays"),
    ];
    let caption = "The cost of a light mesh, occluder lists or adaptive shadow rays, and of shadow rays with the same error. Speed-up: below 1 the former are slower. Rows \
                   without values for shadow rays: no measured number of them has an error this small.";
    vec![generic::chosen(EQUAL_ERROR, caption, rows, &[], &values)]
}

/// The error of shadow rays in the time of the light mesh.
pub(super) fn equal_time(rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("seconds", "s"),
        ("samples", "shadow rays per pixel and light"),
        ("visibility_rmse", "RMSE of visibility, light mesh"),
        ("area_visibility_rmse", "shadow rays"),
        ("mean_flip", "mean FLIP, light mesh"),
        ("area_mean_flip", "shadow rays"),
    ];
    vec![generic::chosen(
        "equal time",
        "As many shadow rays as fit into the time of the light mesh.",
        rows,
        &[],
        &values,
    )]
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
            "Garden: at equal error (mean FLIP, 0.10) the light mesh takes 2.0× to 3.0× the time of shadow rays, over 2 settings. In 1 \
             of them a single shadow ray already has a smaller error."
        );
    }

    #[test]
    fn lookups_have_findings_of_their_own() {
        let results = crate::report::tests::results("quality", |rows| {
            for (lookup, samples, seconds) in [(None, 4, 0.8), (Some("lists"), 4, 0.1), (Some("lists"), 16, 0.2)] {
                let keys =
                    [("scene", "garden".into()), ("mode", "light-mesh".into()), ("samples", f64::from(samples).into())];
                let keys = keys.into_iter().chain(lookup.map(|lookup| ("lookup", lookup.into())));
                let mut row = crate::Row::new(EQUAL_ERROR, keys);
                let values = [("error", 0.1), ("seconds", seconds), ("area_seconds", 0.4)];
                row.values.extend(values.map(|(name, value)| (name.to_owned(), value)));
                rows.push(row);
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let findings = findings(&runs);
        let verdicts: Vec<Verdict> = findings.iter().map(|finding| finding.verdict).collect();
        assert_eq!(verdicts, [Verdict::Loses, Verdict::Wins]);
        assert!(findings[1].text.contains("occluder lists take 0.25× to 0.50× the time"), "{}", findings[1].text);
        let names: Vec<String> = runs.rows(EQUAL_ERROR).iter().map(method).collect();
        assert_eq!(names, ["light mesh", "occluder lists", "occluder lists"]);
    }

    #[test]
    fn faster_than_a_better_picture_is_not_won() {
        let results = crate::report::tests::results("quality", |rows| {
            for (radius, seconds, bound) in [(2.1, 0.2, true), (3.1, 0.8, false)] {
                let mut row = crate::Row::new(EQUAL_ERROR, [("scene", "garden".into()), ("radius", radius.into())]);
                let values = [("error", 0.1), ("seconds", seconds), ("area_seconds", 0.4)];
                row.values.extend(values.map(|(name, value)| (name.to_owned(), value)));
                row.values.extend(bound.then(|| ("upper_bound".to_owned(), 1.0)));
                rows.push(row);
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let findings = findings(&runs);
        assert_eq!(findings[0].verdict, Verdict::Depends);
        let text = &findings[0].text;
        assert!(
            text.contains("taking no more time than that, as in 1 of these, is not a gain at equal error."),
            "{text}"
        );
        assert!(text.ends_with("It wins in 0 and loses in 1."), "{text}");
    }
}
