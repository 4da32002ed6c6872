//! The timings of the thesis beside hard shadows and its own seconds, and its figure 11.

use std::collections::BTreeMap;

use super::document::{Block, Cell, Column, Image, Table};
use super::keys::keyed;
use super::plot::{Curve, Plot};
use super::runs::{Measured, distinct};
use super::{document, numbers};
use crate::WHOLE;

/// To be said beside every ratio to the thesis' figures.
pub(crate) const SCENES: &str = "The three scenes are in the spirit of the thesis' scenes, not the same.";

const CAPTION: &str = "Hard: hard shadows, one shadow ray per pixel and light; ratio: the light mesh over these. Full frames are timed \
                       by the host's clock with transfers, stages by the GPU without. Speed-up: the thesis' seconds on a CPU (Core i7-950) \
                       or a GPU (Tesla C2070), like the device used here, over the median.";

/// Keys that only some modes have.
const OF_A_MODE: [&str; 4] = ["mode", "step", "radius", "weight"];

/// Stages that move data to a GPU and back.
const TRANSFERS: [&str; 2] = ["upload", "download"];

/// A column: its name, group and title, its figure of a row, and how that is written.
type Figures<'a> = (&'a str, &'a str, &'a str, &'a dyn Fn(&Measured) -> Option<f64>, fn(f64) -> String);

/// A line for each frame of the light mesh on each device: its time, hard shadows, and the thesis' seconds.
pub(super) fn timings(rows: &[Measured]) -> Table {
    let mesh: Vec<Measured> = rows.iter().filter(|row| row.is("mode", "light-mesh")).copied().collect();
    let mut table = keyed("timings", &format!("{CAPTION} {SCENES}"), &mesh);
    let same = |row: &Measured, other: &Measured| {
        row.place_name() == other.place_name() && row.case(&OF_A_MODE) == other.case(&OF_A_MODE)
    };
    let hard = |row: &Measured| rows.iter().find(|other| other.is("mode", "ray-trace") && same(row, other)).copied();
    let by_hard = |row: &Measured, seconds: fn(&Measured) -> Option<f64>| Some(seconds(row)? / seconds(&hard(row)?)?);
    let (milliseconds, seconds) = (numbers::milliseconds, |seconds| numbers::significant(seconds, 3));
    let [frame, gpu, thesis] = ["full frame, ms", "stages on the GPU, ms", "thesis, s"];
    let columns: [Figures; 10] = [
        ("min", frame, "min", &|row| row.row.seconds.get(WHOLE)?.min(), milliseconds),
        ("median", frame, "median", &|row| row.whole(), milliseconds),
        ("hard", frame, "hard", &|row| hard(row)?.whole(), milliseconds),
        ("ratio", frame, "ratio", &|row| by_hard(row, |row| row.whole()), numbers::ratio),
        ("stages", gpu, "method", &on_gpu, milliseconds),
        ("hard stages", gpu, "hard", &|row| on_gpu(&hard(row)?), milliseconds),
        ("stages ratio", gpu, "ratio", &|row| by_hard(row, on_gpu), numbers::ratio),
        ("thesis cpu", thesis, "CPU", &|row| row.value("thesis_cpu_seconds"), seconds),
        ("thesis gpu", thesis, "GPU", &|row| row.value("thesis_gpu_seconds"), seconds),
        ("faster", "", "speed-up", &speed_up, numbers::ratio),
    ];
    for (name, group, title, figure, text) in columns {
        table.add(Column::numbers(name, title).below(group), mesh.iter().map(|row| Cell::number(figure(row), text)));
    }
    table
}

/// How many times faster a frame is than the thesis' on the same kind of device.
pub(crate) fn speed_up(row: &Measured) -> Option<f64> {
    let thesis = row.value(if row.is("device", "cuda") { "thesis_gpu_seconds" } else { "thesis_cpu_seconds" })?;
    row.median(WHOLE).map(|seconds| thesis / seconds)
}

/// Seconds of a frame's stages on a GPU, without transfers: the sum of their medians. `None` on a CPU, where the stages add up to
/// the frame.
fn on_gpu(row: &Measured) -> Option<f64> {
    let stages = row.row.seconds.iter().filter(|(name, _)| *name != WHOLE && !TRANSFERS.contains(&name.as_str()));
    let medians: Vec<f64> = stages.filter_map(|(_, samples)| samples.median()).collect();
    (row.is("device", "cuda") && !medians.is_empty()).then(|| medians.iter().sum())
}

/// Times of both modes on one device, by number of lights.
pub(crate) struct Contest<'a> {
    pub(crate) place: String,
    name: String,
    /// Seconds of the light mesh and of hard shadows.
    pub(crate) seconds: [BTreeMap<u32, f64>; 2],
    /// Lights from which on the light mesh is faster: measured, and by the cost model.
    break_even: Option<Measured<'a>>,
}

/// Times of both modes on each device.
pub(crate) fn contests<'a>(rows: &[Measured<'a>], predictions: &[Measured<'a>]) -> Vec<Contest<'a>> {
    let contest = |name: String| {
        let of_place = || rows.iter().filter(|row| row.place_name() == name);
        let seconds = ["light-mesh", "ray-trace"].map(|mode| {
            let of_mode = of_place().filter(|row| row.is("mode", mode));
            of_mode.filter_map(|row| Some((row.number("lights")? as u32, row.whole()?))).collect()
        });
        let break_even = predictions.iter().find(|row| row.place_name() == name).copied();
        Contest { place: of_place().next().map(Measured::place).unwrap_or_default(), name, seconds, break_even }
    };
    distinct(rows.iter().map(Measured::place_name)).into_iter().map(contest).collect()
}

impl Contest<'_> {
    /// The largest number of lights measured in both modes, with the seconds of both.
    pub(crate) fn most(&self) -> Option<(u32, [f64; 2])> {
        let [mesh, hard] = &self.seconds;
        mesh.iter().rev().find_map(|(lights, seconds)| Some((*lights, [*seconds, *hard.get(lights)?])))
    }

    fn plot(&self) -> Option<Image> {
        let curve = |name: &str, seconds: &BTreeMap<u32, f64>| {
            let points = seconds.iter().map(|(lights, seconds)| (f64::from(*lights), 1e3 * seconds));
            Curve { name: name.to_owned(), points: points.collect(), scattered: false }
        };
        let most = f64::from(self.most()?.0);
        let marks = [("measured_lights", "break-even"), ("predicted_lights", "predicted")].map(|(value, name)| {
            let lights = self.break_even?.value(value).filter(|lights| *lights <= most)?;
            Some((lights, format!("{name}: {}", numbers::significant(lights, 2))))
        });
        let plot = Plot {
            caption: format!("{}: milliseconds per frame against the number of lights, medians.", self.place),
            axes: ["lights", "ms"],
            log: false,
            curves: vec![curve("light mesh", &self.seconds[0]), curve("hard shadows", &self.seconds[1])],
            marks: marks.into_iter().flatten().collect(),
        };
        plot.image(&format!("figure 11 {}", document::slug(&self.name)))
    }
}

/// Figure 11: a plot for each device, and a table of all.
pub(super) fn lights(rows: &[Measured], predictions: &[Measured]) -> Vec<Block> {
    let contests = contests(rows, predictions);
    let plots = contests.iter().filter_map(|contest| Some(Block::Plot(contest.plot()?)));
    let mut counts =
        distinct(contests.iter().flat_map(|contest| contest.seconds.iter().flat_map(BTreeMap::keys).copied()));
    counts.sort_unstable();
    let mut table =
        Table::new("figure 11", "Medians; at a ratio below 1 the light mesh takes less time.", counts.len());
    table.add(Column::numbers("lights", "lights"), counts.iter().map(|lights| lights.to_string().into()));
    for Contest { name, place, seconds: [mesh, hard], .. } in &contests {
        let ratio = |lights: &u32| Some(mesh.get(lights)? / hard.get(lights)?);
        let milliseconds = |seconds: Option<&f64>| Cell::number(seconds.copied(), numbers::milliseconds);
        let column = |key: &str, title: &str| Column::numbers(format!("{name} {key}"), title).below(place);
        table.add(column("mesh", "light mesh, ms"), counts.iter().map(|lights| milliseconds(mesh.get(lights))));
        table.add(column("hard", "hard shadows, ms"), counts.iter().map(|lights| milliseconds(hard.get(lights))));
        table.add(column("ratio", "ratio"), counts.iter().map(|lights| Cell::number(ratio(lights), numbers::ratio)));
    }
    plots.chain([Block::Table(table)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{results, runs};
    use crate::{Results, Row, Samples};

    /// An image in both modes, with its stages.
    fn run(device: &'static str, faster: f64) -> Results {
        results("thesis", |rows| {
            for (mode, seconds) in [("light-mesh", 0.004), ("ray-trace", 0.002)] {
                let keys = [("scene", "garden".into()), ("device", device.into()), ("mode", mode.into())];
                let mut row = Row::new("timings", keys);
                let stages =
                    [(WHOLE, 1.0), ("upload", 0.3), ("primary_rays", 0.25), ("short_tests", 0.25), ("download", 0.1)];
                let samples = |share: f64| Samples(vec![share * seconds / faster]);
                row.seconds.extend(stages.map(|(name, share)| (name.to_owned(), samples(share))));
                row.values.extend(["cpu", "gpu"].map(|device| (format!("thesis_{device}_seconds"), 0.4)));
                rows.push(row);
            }
        })
    }

    fn lines(all: Vec<Results>) -> String {
        crate::report::markdown::table(&timings(&runs(all).rows("timings")))
    }

    #[test]
    fn stages_on_a_gpu_leave_transfers_out() {
        let text = lines(vec![run("cuda", 1.0)]);
        let line = "| garden | light-mesh | 4.00 | 4.00 | 2.00 | 2.0× | 2.00 | 1.00 | 2.0× | 0.400 | 0.400 | 100× |";
        assert!(text.contains(line), "{text}");
    }

    #[test]
    fn stages_of_a_processor_are_no_column() {
        let text = lines(vec![run("cpu", 1.0)]);
        assert!(!text.contains("stages") && text.contains("| 4.00 | 4.00 | 2.00 | 2.0× | 0.400 |"), "{text}");
    }

    #[test]
    fn each_run_has_a_line_below_the_other() {
        let text = lines(vec![run("cuda", 1.0), run("cuda", 2.0)]);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert!(text.contains("| 0: Some GPU | 4.00 |") && text.contains("| 1: Some GPU | 2.00 |"), "{text}");
    }

    #[test]
    fn the_break_even_of_the_suite_is_marked() {
        let results = results("thesis", |rows| {
            for (mode, seconds) in [("light-mesh", [0.003, 0.004, 0.005]), ("ray-trace", [0.001, 0.005, 0.033])] {
                for (lights, seconds) in [1.0, 8.0, 64.0].into_iter().zip(seconds) {
                    let mut row = Row::new("figure 11", [("lights", lights.into()), ("mode", mode.into())]);
                    row.seconds.insert(WHOLE.to_owned(), Samples(vec![seconds]));
                    rows.push(row);
                }
            }
            let mut row = Row::new("figure 11, break-even", []);
            row.values.extend([("measured_lights".to_owned(), 6.3), ("predicted_lights".to_owned(), 99.0)]);
            rows.push(row);
        });
        let runs = runs(vec![results]);
        let (rows, predictions) = (runs.rows("figure 11"), runs.rows("figure 11, break-even"));
        let plot = String::from_utf8(contests(&rows, &predictions)[0].plot().unwrap().bytes).unwrap();
        assert!(plot.contains("break-even: 6.3") && !plot.contains("predicted"), "{plot}");
        let [Block::Plot(_), Block::Table(table)] = &lights(&rows, &predictions)[..] else { panic!() };
        let text = crate::report::markdown::table(table);
        assert!(text.contains("| 1 | 3.00 | 1.00 | 3.0× |") && text.contains("| 64 | 5.00 | 33.0 | 0.15× |"), "{text}");
    }
}
