//! Figure 11: time against the number of lights, and from how many on the method is faster than hard shadows.

use super::whole;
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::plot::{Axis, Curve, Plot};
use crate::report::runs::{Measured, distinct};

/// Times of both modes at one place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contest {
    /// Scene, and where it was measured, for people.
    pub(crate) title: String,
    /// The same for columns.
    name: String,
    /// Lights and seconds of the method, in order of lights.
    pub(crate) mesh: Vec<(f64, f64)>,
    /// The same of hard shadows.
    pub(crate) hard: Vec<(f64, f64)>,
    /// Lights from which on the method is faster, as the cost model predicts.
    pub(crate) predicted: Option<f64>,
}

/// What both modes take, for each scene and place; predictions are rows of the experiment that goes with it.
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
        Contest { title, mesh: of("light-mesh"), hard: of("ray-trace"), predicted, name: wanted }
    });
    contests.filter(|contest| !contest.mesh.is_empty() && !contest.hard.is_empty()).collect()
}

impl Contest {
    /// Lights and seconds of both modes, where both were measured.
    fn both(&self) -> Vec<(f64, f64, f64)> {
        let hard = |lights: f64| self.hard.iter().find(|point| point.0 == lights).map(|point| point.1);
        self.mesh.iter().filter_map(|&(lights, mesh)| Some((lights, mesh, hard(lights)?))).collect()
    }

    /// The number of lights from which on the method takes less time, between measurements by straight lines; `None` where it is
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

    /// The most lights that were measured in both modes.
    pub(crate) fn most(&self) -> Option<f64> {
        self.both().last().map(|point| point.0)
    }
}

/// A plot for each place, and a table of all.
pub(super) fn figure(rows: &[Measured], predictions: &[Measured]) -> Vec<Block> {
    let contests = contests(rows, predictions);
    let plots = contests.iter().enumerate().map(|(index, contest)| Block::Plot(plot(index, contest)));
    plots.chain([Block::Table(table(&contests))]).collect()
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
        // Where both fall together one name is enough.
        contest.break_even().is_none_or(|measured| (measured / predicted).ln().abs() > 0.2)
    });
    let predicted = predicted.map(|lights| (lights, format!("predicted: {}", lights_text(lights))));
    Plot {
        name: format!("figure-11-{}", index + 1),
        caption: format!("{}: milliseconds of a picture against the number of lights, medians.", contest.title),
        x: Axis { title: "lights".to_owned(), log: false },
        y: Axis { title: "ms".to_owned(), log: false },
        curves: vec![curve("light mesh", &contest.mesh), curve("hard shadows", &contest.hard)],
        marks: measured.into_iter().chain(predicted).collect(),
    }
}

/// A number of lights, which need not be whole.
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
    let caption = "Medians; a ratio below 1 says that the method takes less time.";
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
        Contest { title: String::new(), name: String::new(), mesh: points(mesh), hard: points(hard), predicted: None }
    }

    #[test]
    fn break_even_lies_where_the_lines_cross() {
        assert_eq!(contest([3.0, 4.0, 5.0], [1.0, 6.0, 60.0]).break_even(), Some(4.5));
        assert_eq!(contest([3.0, 4.0, 5.0], [1.0, 2.0, 3.0]).break_even(), None);
        assert_eq!(contest([1.0, 1.0, 1.0], [2.0, 2.0, 2.0]).break_even(), Some(1.0));
        // Faster for a while is not enough.
        assert_eq!(contest([3.0, 1.0, 9.0], [1.0, 2.0, 3.0]).break_even(), None);
    }
}
