//! The three figures with which a page begins: the most telling ones of the rows at hand.
//!
//! Each candidate is computed from the rows of one experiment, on the fastest device that measured it; the first three
//! that exist are shown. Ratios of many rows are geometric means.

use super::layouts::lights::contests;
use super::layouts::thesis::{SCENES, speed_up};
use super::layouts::{self, ANTIALIASING, BREAK_EVEN, LIGHTS, MANY_LIGHTS, WHOLE_FRAMES, whole};
use super::numbers;
use super::runs::{Measured, Runs};
use super::side_by_side::geometric_mean;

/// Number of figures.
const COUNT: usize = 3;

/// The mean of a ratio over the rows of an experiment.
struct Mean {
    experiment: &'static str,
    /// A key and its word in the rows that count; all rows if it is empty.
    of: [&'static str; 2],
    value: &'static str,
    says: &'static str,
}

const MEANS: [Mean; 6] = [
    Mean {
        experiment: WHOLE_FRAMES,
        of: ["method", "lists"],
        value: "faster_than_half_ball",
        says: "as fast by occluder lists as with the thesis' half-ball",
    },
    Mean {
        experiment: WHOLE_FRAMES,
        of: ["method", "lists"],
        value: "nearer_than_half_ball",
        says: "the half-ball's error by that of occluder lists",
    },
    Mean {
        experiment: "equal error",
        of: ["lookup", "lists"],
        value: "faster_than_area",
        says: "as fast by occluder lists as with shadow rays of the same error",
    },
    Mean {
        experiment: "programs at equal error",
        of: ["", ""],
        value: "times",
        says: "the time of other programs with the same error, by that of Lightmesh",
    },
    Mean {
        experiment: ANTIALIASING,
        of: ["quality", "good"],
        value: "time_by_one",
        says: "the time of several samples of a pixel, by that of one",
    },
    Mean {
        experiment: ANTIALIASING,
        of: ["quality", "good"],
        value: "error_by_one",
        says: "the error of several samples of a pixel, by that of one",
    },
];

/// A large number, and what it says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Figure {
    pub(crate) value: String,
    pub(crate) label: String,
}

/// The figures of a report; none without rows.
pub(crate) fn figures(runs: &Runs) -> Vec<Figure> {
    if runs.all().next().is_none() {
        return Vec::new();
    }
    let mut all = Vec::new();
    all.extend(by_thesis(&runs.rows("timings")));
    all.extend(many_lights_by_hard_shadows(runs));
    all.extend(MEANS.iter().filter_map(|mean| mean.figure(runs)));
    all.extend(rays(&runs.rows("rays")));
    all.extend(per_light(&runs.rows(MANY_LIGHTS)));
    all.extend(fastest(&runs.all().collect::<Vec<_>>()));
    all.extend(counts(runs));
    all.truncate(COUNT);
    all
}

/// Speed-ups over the thesis: on a GPU, on a CPU.
fn by_thesis(rows: &[Measured]) -> Vec<Figure> {
    let figure = |device: &str| {
        let (place, rows) =
            fastest_place(rows.iter().filter(|row| row.is("device", device) && speed_up(row).is_some()))?;
        let ratios: Vec<f64> = rows.iter().filter_map(speed_up).collect();
        let frames = images(ratios.len());
        Some(Figure {
            value: numbers::ratio(geometric_mean(&ratios)?),
            label: format!(
                "as fast as the thesis on its {}: geometric mean of {frames} on {place}. {SCENES}",
                kind(device)
            ),
        })
    };
    ["cuda", "cpu"].into_iter().filter_map(figure).collect()
}

fn kind(device: &str) -> &'static str {
    if device == "cuda" { "GPU" } else { "CPU" }
}

/// With the most lights, the method's speed relative to hard shadows, where that is highest.
fn many_lights_by_hard_shadows(runs: &Runs) -> Option<Figure> {
    let contests = contests(&runs.rows(LIGHTS), &runs.rows(BREAK_EVEN));
    let ratios = contests.iter().filter_map(|contest| Some((1.0 / contest.ratio_at_most()?, contest)));
    let (ratio, contest) = ratios.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let lights = contest.most().map(numbers::setting)?;
    Some(Figure {
        value: numbers::ratio(ratio),
        label: format!("as fast as hard shadows with {lights} lights: {}, on {}", contest.subject, contest.place),
    })
}

impl Mean {
    fn figure(&self, runs: &Runs) -> Option<Figure> {
        let Mean { experiment, of: [key, word], value, says } = self;
        let rows = runs.rows(experiment);
        let counts = |row: &&Measured| (key.is_empty() || row.is(key, word)) && row.value(value).is_some();
        let (place, rows) = fastest_place(rows.iter().filter(counts))?;
        let ratios: Vec<f64> = rows.iter().filter_map(|row| row.value(value)).collect();
        let rows = if ratios.len() == 1 { "1 row".to_owned() } else { format!("{} rows", ratios.len()) };
        Some(Figure {
            value: numbers::ratio(geometric_mean(&ratios)?),
            label: format!("{says}: geometric mean of {rows}, on {place}"),
        })
    }
}

/// The highest rate.
fn rays(rows: &[Measured]) -> Option<Figure> {
    let rated = rows.iter().filter_map(|row| Some((row.value("million_per_second")?, row)));
    let (rate, row) = rated.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let keys = ["rays", "scene", "accel", "program"].map(|key| row.text(key));
    let keys: Vec<String> = keys.into_iter().filter(|text| !text.is_empty()).collect();
    Some(Figure {
        value: numbers::significant(rate, 3),
        label: format!("million rays per second at most: {}, on {}", keys.join(", "), row.place()),
    })
}

/// The cost of each of many lights by that of a single one.
fn per_light(rows: &[Measured]) -> Option<Figure> {
    let (place, rows) = fastest_place(rows.iter().filter(|row| row.value("per_light_by_one").is_some()))?;
    let row = rows
        .iter()
        .max_by(|a, b| a.number("lights").partial_cmp(&b.number("lights")).unwrap_or(std::cmp::Ordering::Equal))?;
    Some(Figure {
        value: numbers::ratio(row.value("per_light_by_one")?),
        label: format!("the time of each of {} lights, by that of a single one, on {place}", row.text("lights")),
    })
}

/// The shortest time.
fn fastest(rows: &[Measured]) -> Option<Figure> {
    let timed = rows.iter().filter_map(|row| Some((whole(row)?, row)));
    let (seconds, row) = timed.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let scene = row.text("scene");
    let scene = if scene.is_empty() { layouts::title(&row.row.experiment) } else { layouts::title(&scene) };
    let place = row.place();
    let on = if place.is_empty() { String::new() } else { format!(", on {place}") };
    Some(Figure {
        value: format!("{} ms", numbers::milliseconds(seconds)),
        label: format!("the fastest row: {scene}{on}"),
    })
}

/// How much was measured.
fn counts(runs: &Runs) -> Vec<Figure> {
    let figure = |count: usize, label: &str| Figure { value: numbers::count(count as f64), label: label.to_owned() };
    let experiments = figure(runs.experiments().len(), "experiments");
    vec![figure(runs.all().count(), "measured rows"), experiments]
}

/// The rows of the fastest device: a GPU, or the CPU with the most threads.
fn fastest_place<'a>(rows: impl Iterator<Item = &'a Measured<'a>>) -> Option<(String, Vec<Measured<'a>>)> {
    let rows: Vec<Measured> = rows.copied().collect();
    let rank = |row: &&Measured| (!row.is("device", "cuda"), row.number("threads").is_some());
    let place = rows.iter().min_by_key(rank)?.place();
    let of_place = rows.into_iter().filter(|row| row.place() == place).collect();
    Some((place, of_place))
}

/// As in "12 frames".
fn images(count: usize) -> String {
    if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{results, thesis};

    fn of(results: Vec<crate::Results>) -> Vec<Figure> {
        let runs = results.into_iter().enumerate().map(|(index, run)| (format!("{index}.json").into(), run));
        figures(&crate::report::named(runs.collect()))
    }

    #[test]
    fn a_thesis_run_is_told_by_its_speed_and_says_that_the_scenes_are_others() {
        let figures = of(vec![thesis(2.0)]);
        assert_eq!(figures.len(), 3);
        // 0.63 seconds by 2.2, the median.
        assert_eq!(figures[0].value, "0.29×");
        assert!(
            figures[0].label.starts_with("as fast as the thesis on its GPU: geometric mean of 1 frame on Some GPU.")
        );
        assert!(figures[0].label.ends_with("in the spirit of the thesis' scenes, not the same."), "{figures:?}");
        assert!(figures[1].value == "6.6×" && figures[1].label.contains("with 64 lights: Childpark"), "{figures:?}");
    }

    #[test]
    fn any_results_have_three_figures_and_none_has_none() {
        let plain = results("new", |rows| {
            let mut row = crate::Row::new("something", [("scene", "park".into())]);
            row.seconds.insert("render".into(), crate::Samples(vec![0.5]));
            rows.push(row);
        });
        let values: Vec<String> = of(vec![plain]).into_iter().map(|figure| figure.value).collect();
        assert_eq!(values, ["500 ms", "1", "1"]);
        assert_eq!(of(vec![results("new", |_| ())]).len(), 0);
    }

    #[test]
    fn the_fastest_device_is_told_of() {
        let results = results("shadows", |rows| {
            for (device, ratio) in [("cpu", 9.0), ("cuda", 2.0), ("cuda", 8.0)] {
                let keys = [("device", device.into()), ("size", ratio.into()), ("method", "lists".into())];
                let mut row = crate::Row::new(WHOLE_FRAMES, keys);
                row.values.insert("faster_than_half_ball".into(), ratio);
                rows.push(row);
            }
        });
        let figures = of(vec![results]);
        assert!(figures[0].value == "4.0×" && figures[0].label.ends_with("on Some GPU"), "{figures:?}");
    }
}
