//! Figure 11: time against the number of lights, and the number from which on the method is faster than hard shadows.

use super::{key_text, title, whole};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::plot::{Axis, Curve, Plot};
use crate::report::runs::{Measured, distinct};

/// Times of both modes on one device.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contest {
    /// The device, and the scene if there are several, as a title.
    pub(crate) title: String,
    /// The scene and its settings, as text.
    pub(crate) subject: String,
    /// The device, as text.
    pub(crate) place: String,
    /// The device, for column names.
    name: String,
    /// Lights and seconds of the method, in order of lights.
    pub(crate) mesh: Vec<(f64, f64)>,
    /// The same for hard shadows.
    pub(crate) hard: Vec<(f64, f64)>,
    /// Number of lights from which on the method is faster, according to the cost model.
    pub(crate) predicted: Option<f64>,
}

/// Times of both modes for each scene and device; predictions are rows of the corresponding experiment.
pub(crate) fn contests(rows: &[Measured], predictions: &[Measured]) -> Vec<Contest> {
    let several = distinct(rows.iter().map(|measured| measured.text("scene"))).len() > 1;
    let scene = |measured: &Measured, end| if several { measured.text("scene") + end } else { String::new() };
    let name = |measured: &Measured| scene(measured, " ") + &measured.place_name();
    let names = distinct(rows.iter().map(name));
    let contests = names.into_iter().map(|wanted| {
        let rows: Vec<&Measured> = rows.iter().filter(|measured| name(measured) == wanted).collect();
        let of = |mode| {
            let rows = rows.iter().filter(|measured| measured.is("mode", mode));
            let mut points: Vec<(f64, f64)> =
                rows.filter_map(|measured| Some((measured.number("lights")?, whole(measured)?))).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points
        };
        let prediction = predictions.iter().find(|measured| name(measured) == wanted);
        let predicted = prediction.and_then(|measured| measured.value("predicted_lights"));
        let title = rows.first().map(|first| scene(first, ", ") + &first.place()).unwrap_or_default();
        let method = rows.iter().find(|measured| measured.is("mode", "light-mesh")).or(rows.first());
        let subject = method.map(|measured| subject(measured)).unwrap_or_default();
        let place = rows.first().map(|first| first.place()).unwrap_or_default();
        Contest { title, subject, place, mesh: of("light-mesh"), hard: of("ray-trace"), predicted, name: wanted }
    });
    contests.filter(|contest| !contest.mesh.is_empty() && !contest.hard.is_empty()).collect()
}

/// The scene and its settings, as in "Childpark, 2048 × 2048 pixels, h = 1, R = 2".
fn subject(row: &Measured) -> String {
    let setting = |key: &str, text: fn(&str) -> String| row.key(key).map(|key| text(&key_text(key)));
    let parts = [
        setting("scene", title),
        setting("size", |side| format!("{side} × {side} pixels")),
        setting("step", |step| format!("h = {step}")),
        setting("radius", |radius| format!("R = {radius}")),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

impl Contest {
    /// Lights and seconds of both modes, if both were measured.
    fn both(&self) -> Vec<(f64, f64, f64)> {
        let hard = |lights: f64| self.hard.iter().find(|point| point.0 == lights).map(|point| point.1);
        self.mesh.iter().filter_map(|&(lights, mesh)| Some((lights, mesh, hard(lights)?))).collect()
    }

    /// The number of lights from which on the method takes less time, interpolated linearly between measurements; `None` if it is
    /// slower with the most lights.
    pub(crate) fn break_even(&self) -> Option<f64> {
        let both = self.both();
        let ahead = |point: &&(f64, f64, f64)| point.1 < point.2;
        let last_behind = both.iter().rposition(|point| !ahead(&point));
        let Some(last) = last_behind else { return both.first().map(|point| point.0) };
        let ((from, mesh, hard), &(to, mesh_after, hard_after)) = (both[last], both.get(last + 1)?);
        let (behind, ahead) = (mesh - hard, hard_after - mesh_after);
        Some(from + (to - from) * behind / (behind + ahead))
    }

    /// The largest number of lights measured in both modes.
    pub(crate) fn most(&self) -> Option<f64> {
        self.both().last().map(|point| point.0)
    }

    /// The method's time over that of hard shadows with that many lights.
    pub(crate) fn ratio_at_most(&self) -> Option<f64> {
        self.both().last().map(|(_, mesh, hard)| mesh / hard)
    }
}

/// A plot for each device, and a table of all.
pub(super) fn figure(rows: &[Measured], predictions: &[Measured]) -> Vec<Block> {
    let contests = contests(rows, predictions);
    let plots = contests.iter().enumerate().map(|(index, contest)| Block::Plot(plot(index, contest)));
    plots.chain([Block::Table(table(&contests))]).chain(lines(predictions).map(Block::Table)).collect()
}

/// The linear fits to the times of each mode, if the suite computed them: values, with their headings.
const LINES: [(&str, &str, &str); 4] = [
    ("method_seconds", "fixed", "light mesh, ms"),
    ("method_seconds_per_light", "per light", "light mesh, ms"),
    ("hard_seconds", "fixed", "hard shadows, ms"),
    ("hard_seconds_per_light", "per light", "hard shadows, ms"),
];

/// The fixed time of an image and the time per light; `None` if the suite fitted no lines.
fn lines(predictions: &[Measured]) -> Option<Table> {
    let mut columns = vec![Column::words("place", "on")];
    columns.extend(LINES.map(|(name, title, group)| Column::numbers(name, title).below(group)));
    columns.push(Column::numbers("crossing", "lights at intersection"));
    let caption = "Linear fits to the same times: a fixed time, and a time per light. The cost model, formulas (4) and (5), only counts \
                   tests; but each light also costs the method a weighted mean per pixel, and both modes their shading, so the measured \
                   break-even tends to be higher than the model's.";
    let mut table = Table::new("figure 11, lines", caption, columns);
    for row in predictions {
        let values = LINES.map(|(name, ..)| row.value(name));
        let [Some(method), Some(method_light), Some(hard), Some(hard_light)] = values else { continue };
        let crossing = (method - hard) / (hard_light - method_light);
        let mut cells: Vec<Cell> = vec![row.place().into()];
        cells.extend(values.map(|value| Cell::number(value, numbers::milliseconds)));
        cells.push(Cell::number((crossing > 0.0 && hard_light > method_light).then_some(crossing), lights_text));
        table.rows.push(cells);
    }
    (!table.rows.is_empty()).then(|| table.without_empty_columns())
}

fn plot(index: usize, contest: &Contest) -> Plot {
    let curve = |name: &str, points: &[(f64, f64)]| Curve {
        name: name.to_owned(),
        points: points.iter().map(|&(lights, seconds)| (lights, 1e3 * seconds)).collect(),
        scattered: false,
    };
    let measured = contest.break_even().map(|lights| (lights, format!("break-even: {}", lights_text(lights))));
    let fits = |lights: &f64| contest.most().is_some_and(|most| *lights <= most);
    let predicted = contest.predicted.filter(fits).filter(|predicted| {
        // If both coincide, one label is enough.
        contest.break_even().is_none_or(|measured| (measured / predicted).ln().abs() > 0.2)
    });
    let predicted = predicted.map(|lights| (lights, format!("predicted: {}", lights_text(lights))));
    Plot {
        name: format!("figure-11-{}", index + 1),
        caption: format!("{}: milliseconds per frame against the number of lights, medians.", contest.title),
        x: Axis { title: "lights".to_owned(), log: false },
        y: Axis { title: "ms".to_owned(), log: false },
        curves: vec![curve("light mesh", &contest.mesh), curve("hard shadows", &contest.hard)],
        marks: measured.into_iter().chain(predicted).collect(),
    }
}

/// A number of lights, which need not be an integer.
pub(crate) fn lights_text(lights: f64) -> String {
    numbers::significant(lights, 2)
}

fn table(contests: &[Contest]) -> Table {
    let mut columns = vec![Column::numbers("lights", "lights")];
    for Contest { name, title: place, .. } in contests {
        for (key, title) in [("mesh", "light mesh, ms"), ("hard", "hard shadows, ms"), ("ratio", "ratio")] {
            columns.push(Column::numbers(format!("{name} {key}"), title).below(place));
        }
    }
    let mut lights =
        distinct(contests.iter().flat_map(|contest| contest.mesh.iter().chain(&contest.hard)).map(|point| point.0));
    lights.sort_by(f64::total_cmp);
    let caption = "Medians; at a ratio below 1 the method takes less time.";
    let mut table = Table::new("figure 11", caption, columns);
    for lights in lights {
        let mut cells: Vec<Cell> = vec![numbers::setting(lights).into()];
        for contest in contests {
            let of = |points: &[(f64, f64)]| points.iter().find(|point| point.0 == lights).map(|point| point.1);
            let (mesh, hard) = (of(&contest.mesh), of(&contest.hard));
            cells.push(Cell::number(mesh, numbers::milliseconds));
            cells.push(Cell::number(hard, numbers::milliseconds));
            cells.push(Cell::number(mesh.zip(hard).map(|(mesh, hard)| mesh / hard), numbers::ratio));
        }
        table.rows.push(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contest(mesh: [f64; 3], hard: [f64; 3]) -> Contest {
        let points = |seconds: [f64; 3]| [1.0, 8.0, 64.0].into_iter().zip(seconds).collect();
        let empty = String::new;
        Contest {
            title: empty(),
            subject: empty(),
            place: empty(),
            name: empty(),
            mesh: points(mesh),
            hard: points(hard),
            predicted: None,
        }
    }

    #[test]
    fn break_even_lies_where_the_lines_cross() {
        assert_eq!(contest([3.0, 4.0, 5.0], [1.0, 6.0, 60.0]).break_even(), Some(4.5));
        assert_eq!(contest([3.0, 4.0, 5.0], [1.0, 2.0, 3.0]).break_even(), None);
        assert_eq!(contest([1.0, 1.0, 1.0], [2.0, 2.0, 2.0]).break_even(), Some(1.0));
        // Being faster temporarily is not enough.
        assert_eq!(contest([3.0, 1.0, 9.0], [1.0, 2.0, 3.0]).break_even(), None);
    }

    #[test]
    fn lines_are_shown_where_they_were_fitted() {
        let values = [0.010, 0.001, 0.004, 0.003];
        let results = |known: usize| {
            crate::report::tests::results("thesis", |rows| {
                let mut row = crate::Row::new(crate::report::layouts::BREAK_EVEN, [("device", "cuda".into())]);
                row.values.extend(
                    LINES.iter().zip(values).take(known).map(|((name, ..), value)| ((*name).to_owned(), value)),
                );
                rows.push(row);
            })
        };
        let table = |known| {
            let runs = crate::report::named(vec![("a.json".into(), results(known))]);
            lines(&runs.rows(crate::report::layouts::BREAK_EVEN))
        };
        let text = crate::report::markdown::table(&table(4).unwrap());
        assert!(text.contains("| Some GPU | 10.0 | 1.00 | 4.00 | 3.00 | 3.0 |"), "{text}");
        assert!(table(3).is_none() && table(0).is_none());
    }
}
