//! The table of the thesis: full frames in both modes, their time by stage, and counts.

use lightmesh::Stage;

use super::{WHOLE, key_column, key_columns};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::runs::{Case, Measured, distinct};

/// The mode, and keys that only some modes have.
const OF_A_MODE: [&str; 7] = ["mode", "step", "radius", "weight", "lookup", "samples", "method"];

/// Seconds of the thesis on its CPU and its GPU.
const THESIS: [&str; 2] = ["thesis_cpu_seconds", "thesis_gpu_seconds"];

/// To be said beside every ratio to the thesis' figures.
pub(crate) const SCENES: &str = "The three scenes are in the spirit of the thesis' scenes, not the same.";

const TIMES: &str = "Milliseconds per frame with the method. Hard: the median with hard shadows, one shadow ray per pixel and light; the ratio \
                     is the method's median over that. Speed-up: relative to the thesis' seconds on a CPU (Core i7-950) or a GPU (Tesla \
                     C2070), according to the device used here.";

/// Added to [`TIMES`] if there are rows of a GPU.
const GPU_TIMES: &str = "A full frame is timed by the host's clock, including transfers; stages are timed by the GPU itself: the sum of their \
                         medians, without transfers.";

/// Stages that move data to a GPU and back.
const TRANSFERS: [&str; 2] = ["upload", "download"];

/// Counts by name, with their headings.
const COUNTS: [(&str, &str); 7] = [
    ("light_points", "S_total"),
    ("light_points_per_pixel", "S_total per pixel"),
    ("half_ball_mean", "half-ball mean"),
    ("used_mean", "used mean, m"),
    ("fallback_share", "m = 0"),
    ("host_peak_bytes", "host memory"),
    ("device_peak_bytes", "GPU memory"),
];

/// All stages of a frame by name, with their headings, and the whole frame.
fn shown_stages() -> Vec<(&'static str, String)> {
    let heading = |stage: Stage| match stage {
        Stage::LongTests => "long tests, shadow rays".to_owned(),
        other => other.name().replace('_', " "),
    };
    let stages = Stage::ALL.into_iter().filter(|&stage| stage != Stage::Build);
    stages.map(|stage| (stage.name(), heading(stage))).chain([(WHOLE, "whole".to_owned())]).collect()
}

pub(super) fn frames(rows: &[Measured]) -> Vec<Block> {
    vec![Block::Table(times(rows)), Block::Table(stages(rows).folded()), Block::Table(counts(rows).folded())]
}

/// Whether two rows have the same scene, lights, size and device, whatever the mode.
pub(crate) fn same_picture(row: &Measured, other: &Measured) -> bool {
    let case = |row: &Measured| row.case(&OF_A_MODE);
    row.place_name() == other.place_name() && case(row) == case(other)
}

/// The corresponding row of another mode on the same device.
fn companion<'a>(row: &Measured, mode: &str, rows: &'a [Measured<'a>]) -> Option<&'a Measured<'a>> {
    rows.iter().find(|other| other.is("mode", mode) && same_picture(row, other))
}

/// A line for each image with the method on each device: its time, hard shadows, and the thesis' seconds. A single device goes to
/// the caption.
fn times(rows: &[Measured]) -> Table {
    let mesh: Vec<Measured> = rows.iter().filter(|row| row.is("mode", "light-mesh")).copied().collect();
    let cases = distinct(mesh.iter().map(|row| row.case(&["mode"])));
    let places = distinct(mesh.iter().map(Measured::place));
    let keys = case_columns(&mesh);

    let mut columns: Vec<Column> = keys.iter().map(|key| key_column(key, &mesh)).collect();
    if places.len() > 1 {
        columns.push(Column::words("place", "on"));
    }
    columns.extend(
        [("min", "min"), ("median", "median"), ("hard", "hard"), ("ratio", "ratio")]
            .map(|(name, title)| Column::numbers(name, title).below("full frame, ms")),
    );
    columns.extend(
        [("stages", "method"), ("hard stages", "hard"), ("stages ratio", "ratio")]
            .map(|(name, title)| Column::numbers(name, title).below("stages on the GPU, ms")),
    );
    columns.extend(
        [("thesis cpu", "CPU"), ("thesis gpu", "GPU")]
            .map(|(name, title)| Column::numbers(name, title).below("thesis, s")),
    );
    columns.push(Column::numbers("faster", "speed-up"));

    let mut caption = TIMES.to_owned();
    if mesh.iter().any(|row| on_gpu(row).is_some()) {
        caption = format!("{caption} {GPU_TIMES}");
    }
    if let [place] = &places[..] {
        caption = format!("{caption} All rows: {place}.");
    }
    if mesh.iter().any(|row| speed_up(row).is_some()) {
        caption = format!("{caption} {SCENES}");
    }
    let mut table = Table::new("timings", caption, columns);
    for case in &cases {
        for row in mesh.iter().filter(|row| row.case(&["mode"]) == *case) {
            let mut cells: Vec<Cell> = keys.iter().map(|key| case.text(key).into()).collect();
            if places.len() > 1 {
                cells.push(row.place().into());
            }
            cells.extend(time_cells(row, rows));
            table.rows.push(cells);
        }
    }
    table.without_empty_columns()
}

/// Full frames, stages, and the thesis' seconds with the speed-up over the same kind of device.
fn time_cells(row: &Measured, rows: &[Measured]) -> [Cell; 10] {
    let companion = companion(row, "ray-trace", rows);
    let ratio = |ours: Option<f64>, other: Option<f64>| ours.zip(other).map(|(ours, other)| ours / other);
    let (median, hard) = (row.median(WHOLE), companion.and_then(|row| row.median(WHOLE)));
    let (stages, hard_stages) = (on_gpu(row), companion.and_then(on_gpu));
    let thesis = THESIS.map(|name| row.value(name));
    let seconds = |seconds| numbers::significant(seconds, 3);
    [
        Cell::number(row.min(WHOLE), numbers::milliseconds),
        Cell::number(median, numbers::milliseconds),
        Cell::number(hard, numbers::milliseconds),
        Cell::number(ratio(median, hard), numbers::ratio),
        Cell::number(stages, numbers::milliseconds),
        Cell::number(hard_stages, numbers::milliseconds),
        Cell::number(ratio(stages, hard_stages), numbers::ratio),
        Cell::number(thesis[0], seconds),
        Cell::number(thesis[1], seconds),
        Cell::number(speed_up(row), numbers::ratio),
    ]
}

/// How many times faster a frame is than the thesis' on the same kind of device.
pub(crate) fn speed_up(row: &Measured) -> Option<f64> {
    let thesis = row.value(THESIS[usize::from(row.is("device", "cuda"))])?;
    row.median(WHOLE).map(|seconds| thesis / seconds)
}

/// Seconds of a frame's stages on a GPU, without transfers: the sum of their medians. `None` on a CPU, where the stages add up to
/// the frame.
fn on_gpu(row: &Measured) -> Option<f64> {
    let stages = row.row.seconds.iter().filter(|(name, _)| *name != WHOLE && !TRANSFERS.contains(&name.as_str()));
    let medians: Vec<f64> = stages.filter_map(|(_, samples)| samples.median()).collect();
    (row.is("device", "cuda") && !medians.is_empty()).then(|| medians.iter().sum())
}

/// Median milliseconds of each stage, in both modes.
fn stages(rows: &[Measured]) -> Table {
    let keys = case_columns(rows);
    let mut columns = vec![Column::words("place", "on"), Column::words("mode", "mode")];
    columns.extend(keys.iter().map(|key| key_column(key, rows)));
    let shown = shown_stages();
    columns.extend(shown.iter().map(|(stage, title)| Column::numbers(*stage, title)));
    let mut table =
        Table::new("timings, stages", "Milliseconds per stage, medians; stages that took no time are empty.", columns);
    for row in rows {
        let mut cells: Vec<Cell> = vec![row.place().into(), row.text("mode").into()];
        cells.extend(keys.iter().map(|key| Cell::from(row.text(key))));
        cells.extend(shown.iter().map(|(stage, _)| Cell::number(row.median(stage), numbers::milliseconds)));
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// Rows of the experiment `stages`: medians, and light points.
pub(super) fn by_stage(rows: &[Measured]) -> Vec<Block> {
    let shown = shown_stages();
    let shown: Vec<(&str, &str)> = shown.iter().map(|(stage, title)| (*stage, title.as_str())).collect();
    vec![super::generic::chosen(super::STAGES, "", rows, &shown, &COUNTS[..1])]
}

/// Counts; equal counts on several devices share a line.
fn counts(rows: &[Measured]) -> Table {
    let mesh: Vec<Measured> = rows.iter().filter(|row| row.is("mode", "light-mesh")).copied().collect();
    let keys = case_columns(&mesh);
    let mut columns = vec![Column::words("place", "on")];
    columns.extend(keys.iter().map(|key| key_column(key, &mesh)));
    columns.extend(COUNTS.iter().map(|(count, title)| Column::numbers(*count, *title)));
    let mut table = Table::new("timings, counts", "Counts of the method, and the peak memory of a frame.", columns);
    for row in &mesh {
        let mut cells: Vec<Cell> = vec![row.place().into()];
        cells.extend(keys.iter().map(|key| Cell::from(row.text(key))));
        cells.extend(
            COUNTS.iter().map(|(name, _)| Cell::number(row.value(name), |value| super::generic::figure(name, value))),
        );
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// Keys other than the device.
fn case_columns(rows: &[Measured]) -> Vec<String> {
    let cases: Vec<Case> = rows.iter().map(|row| row.case(&["mode"])).collect();
    key_columns(rows).into_iter().filter(|key| cases.iter().any(|case| case.0.contains_key(key))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::results;
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
                row.values.extend(THESIS.map(|name| (name.to_owned(), 0.4)));
                rows.push(row);
            }
        })
    }

    fn lines(runs: Vec<Results>) -> String {
        let runs = runs.into_iter().enumerate().map(|(index, run)| (format!("{index}.json").into(), run)).collect();
        let runs = crate::report::named(runs);
        crate::report::markdown::table(&times(&runs.rows("timings")))
    }

    #[test]
    fn stages_on_a_gpu_leave_transfers_out() {
        let text = lines(vec![run("cuda", 1.0)]);
        assert!(
            text.contains("| garden | 4.00 | 4.00 | 2.00 | 2.0× | 2.00 | 1.00 | 2.0× | 0.400 | 0.400 | 100× |"),
            "{text}"
        );
    }

    #[test]
    fn stages_of_a_processor_are_no_column() {
        let text = lines(vec![run("cpu", 1.0)]);
        assert!(!text.contains("stages") && text.contains("| garden | 4.00 | 4.00 | 2.00 | 2.0× | 0.400 |"), "{text}");
    }

    #[test]
    fn each_run_has_a_line_below_the_other() {
        let text = lines(vec![run("cuda", 1.0), run("cuda", 2.0)]);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert!(
            text.contains("| garden | 0: Some GPU | 4.00 |") && text.contains("| garden | 1: Some GPU | 2.00 |"),
            "{text}"
        );
    }
}
