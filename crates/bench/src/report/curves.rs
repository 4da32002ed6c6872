//! Errors against time: for each scene and device, a curve or points for each method, on logarithmic axes.

use super::document::Block;
use super::plot::{Curve, Plot};
use super::runs::{Measured, distinct};

/// Errors that are plotted: the first two that rows have.
const ERRORS: [(&str, &str); 3] =
    [("visibility_rmse", "RMSE of visibility"), ("mean_flip", "mean FLIP"), ("rmse", "RMSE of the image")];

/// Plots of errors for each scene, number of lights, size and device.
pub(super) fn plots(experiment: &str, rows: &[Measured]) -> Vec<Block> {
    let subject = |row: &Measured| {
        let parts = [row.text("scene"), row.text("lights"), row.text("size"), row.place()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    };
    let plots = distinct(rows.iter().map(subject)).into_iter().flat_map(|wanted| {
        let of_subject: Vec<Measured> = rows.iter().filter(|row| subject(row) == wanted).copied().collect();
        let plots = ERRORS.iter().filter_map(|&(error, title)| {
            let plot = Plot {
                caption: format!("{wanted}: {title} against milliseconds per frame. Lower and further left is better."),
                axes: ["ms", title],
                log: true,
                curves: curves(&of_subject, error),
                marks: Vec::new(),
            };
            plot.image(&format!("{experiment} {wanted} {error}")).map(Block::Plot)
        });
        plots.take(2).collect::<Vec<_>>()
    });
    plots.collect()
}

/// Points by method, each in order of time. Samples make a line; light meshes differ in several settings.
fn curves(rows: &[Measured], error: &str) -> Vec<Curve> {
    let curves = distinct(rows.iter().map(method)).into_iter().map(|name| {
        let of_method = || rows.iter().filter(|row| method(row) == name);
        let mut points: Vec<(f64, f64)> =
            of_method().filter_map(|row| Some((1e3 * row.whole()?, row.value(error)?))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let scattered = of_method().any(|row| row.is("mode", "light-mesh") && row.key("lookup").is_none());
        Curve { points, scattered, name }
    });
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// The name of a row's method.
fn method(row: &Measured) -> String {
    let name = ["program", "mode"].map(|key| row.text(key)).into_iter().find(|name| !name.is_empty());
    let name = match name.unwrap_or_default().as_str() {
        "light-mesh" if row.is("lookup", "lists") => "occluder lists".to_owned(),
        "light-mesh" if row.is("lookup", "adaptive") => "adaptive shadow rays".to_owned(),
        "light-mesh" => "light mesh".to_owned(),
        "area" => "shadow rays".to_owned(),
        "ray-trace" => "hard shadows".to_owned(),
        other => other.to_owned(),
    };
    if row.is("emitter", "point") { name + ", point lights" } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{results, runs};
    use crate::{Row, Samples};

    #[test]
    fn samples_make_lines_and_light_meshes_do_not() {
        let results = results("quality", |rows| {
            for (mode, lookup, samples) in [
                ("area", None, 4.0),
                ("light-mesh", None, 4.0),
                ("light-mesh", Some("lists"), 16.0),
                ("light-mesh", Some("lists"), 4.0),
            ] {
                let lookup = lookup.map(|lookup| ("lookup", lookup.into()));
                let mut row =
                    Row::new("errors", [("mode", mode.into()), ("samples", samples.into())].into_iter().chain(lookup));
                row.seconds.insert("render".to_owned(), Samples(vec![samples]));
                row.values.insert("mean_flip".to_owned(), 1.0 / samples);
                rows.push(row);
            }
        });
        let runs = runs(vec![results]);
        let curves = curves(&runs.rows("errors"), "mean_flip");
        let shown: Vec<(&str, bool)> = curves.iter().map(|curve| (curve.name.as_str(), curve.scattered)).collect();
        assert_eq!(shown, [("shadow rays", false), ("light mesh", true), ("occluder lists", false)]);
        assert_eq!(curves[2].points, [(4e3, 0.25), (16e3, 0.0625)]);
    }
}
