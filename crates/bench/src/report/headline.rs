//! The figures with which a report begins: those of occluder lists, the default method, come first.
//!
//! Each candidate is computed from the rows of one experiment, on the fastest device that measured it; the first four that exist
//! are shown. Ratios of many rows are geometric means.

use super::document::Figure;
use super::experiments::{BREAK_EVEN, LIGHTS};
use super::numbers;
use super::runs::{Measured, Runs};
use super::side_by_side::geometric_mean;
use super::thesis::{SCENES, contests, speed_up};
use crate::{FILM, FLICKER, WHOLE_FRAMES};

/// Number of figures.
const COUNT: usize = 4;

/// Ratios: an experiment, a key and its word in the rows that count, the value, and its meaning.
const MEANS: [(&str, [&str; 2], &str, &str); 7] = [
    (WHOLE_FRAMES, ["method", "lists"], "faster_than_half_ball", "half-ball's time over occluder lists' time"),
    (WHOLE_FRAMES, ["method", "lists"], "nearer_than_half_ball", "half-ball's error over occluder lists' error"),
    ("equal error", ["lookup", "lists"], "faster_than_area", "time of as exact shadow rays over occluder lists' time"),
    ("programs at equal error", ["program", "Cycles"], "times", "time of as exact Cycles over occluder lists' time"),
    ("programs at equal error", ["program", "Mitsuba"], "times", "time of as exact Mitsuba over occluder lists' time"),
    (FLICKER, ["shadows", "lists"], "flicker_by_area", "flicker of occluder lists over 64 shadow rays' flicker"),
    (FILM, ["shadows", "lists"], "time_ratio", "time of a film's frame over a lone frame's: occluder lists"),
];

/// The figures of a report.
pub(crate) fn figures(runs: &Runs) -> Vec<Figure> {
    let means = MEANS.iter().filter_map(|(experiment, [key, word], value, says)| {
        let of = |row: &Measured| if row.is(key, word) { row.value(value) } else { None };
        mean(&runs.rows(experiment), says, of)
    });
    let timings = runs.rows("timings");
    let by_thesis = [("cuda", "GPU"), ("cpu", "CPU")].into_iter().filter_map(|(device, kind)| {
        let of = |row: &Measured| if row.is("device", device) { speed_up(row) } else { None };
        let mut figure = mean(&timings, &format!("as fast as the thesis on its {kind}"), of)?;
        figure.label += &format!(". {SCENES}");
        Some(figure)
    });
    let all = figure_1(runs).into_iter().chain(means).chain(by_thesis).chain(figure_11(runs)).chain(rays(runs));
    all.take(COUNT).collect()
}

/// The geometric mean of a ratio on the fastest device: a GPU, or the CPU with the most threads.
fn mean(rows: &[Measured], says: &str, ratio: impl Fn(&Measured) -> Option<f64>) -> Option<Figure> {
    let counts = || rows.iter().filter(|row| ratio(row).is_some());
    let place = counts().min_by_key(|row| (!row.is("device", "cuda"), row.number("threads").is_some()))?.place();
    let ratios: Vec<f64> = counts().filter(|row| row.place() == place).filter_map(&ratio).collect();
    let rows = if ratios.len() == 1 { "1 row".to_owned() } else { format!("geometric mean of {} rows", ratios.len()) };
    let value = numbers::ratio(geometric_mean(ratios.into_iter())?);
    Some(Figure { value, label: format!("{says}: {rows}, on {place}") })
}

/// Occluder lists and area shadows with as many samples of each light. Both must have as many samples of a pixel, too, and so as
/// many primary rays: else neither time nor error can be compared.
fn figure_1(runs: &Runs) -> Option<Figure> {
    let rows = runs.rows("figure 1");
    let lists = rows.iter().find(|row| row.is_default())?;
    let alike = |row: &&Measured| {
        row.is("mode", "area")
            && row.key("samples") == lists.key("samples")
            && row.place() == lists.place()
            && row.value("rays").is_some_and(|rays| lists.value("rays") == Some(rays))
    };
    let ratio = rows.iter().find(alike)?.whole()? / lists.whole()?;
    let [samples, place] = [lists.text("samples"), lists.place()];
    let flip = numbers::small(lists.value("mean_flip")?);
    let label = format!(
        "as fast by occluder lists as by {samples} shadow rays per light, at a mean FLIP of {flip}: figure 1, on {place}"
    );
    Some(Figure { value: numbers::ratio(ratio), label })
}

/// With the most lights, the light mesh's speed relative to hard shadows, where that is highest.
fn figure_11(runs: &Runs) -> Option<Figure> {
    let contests = contests(&runs.rows(LIGHTS), &runs.rows(BREAK_EVEN));
    let ratios = contests.iter().filter_map(|contest| {
        let (lights, [mesh, hard]) = contest.most()?;
        Some((hard / mesh, lights, &contest.place))
    });
    let (ratio, lights, place) = ratios.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let label = format!("as fast by the light mesh as hard shadows, with {lights} lights: figure 11, on {place}");
    Some(Figure { value: numbers::ratio(ratio), label })
}

/// The highest rate.
fn rays(runs: &Runs) -> Option<Figure> {
    let rated = runs.rows("rays").into_iter().filter_map(|row| Some((row.value("million_per_second")?, row)));
    let (rate, row) = rated.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let keys = ["rays", "scene", "accel", "program"].map(|key| row.text(key));
    let keys: Vec<String> = keys.into_iter().filter(|text| !text.is_empty()).collect();
    let label = format!("million rays per second at most: {}, on {}", keys.join(", "), row.place());
    Some(Figure { value: numbers::significant(rate, 3), label })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tests::{results, runs, thesis};

    #[test]
    fn a_thesis_run_is_told_by_its_speed_and_says_that_the_scenes_are_others() {
        let figures = figures(&runs(vec![thesis(2.0)]));
        // 0.63 seconds by 2.2, the median.
        assert_eq!(figures[0].value, "0.29×");
        assert!(figures[0].label.starts_with("as fast as the thesis on its GPU: 1 row, on Some GPU."), "{figures:?}");
        assert!(figures[0].label.ends_with("in the spirit of the thesis' scenes, not the same."), "{figures:?}");
        assert!(figures[1].value == "6.6×" && figures[1].label.contains("with 64 lights"), "{figures:?}");
    }

    #[test]
    fn the_default_comes_first_where_it_is_compared_with_its_like() {
        let with_lists = |rays: f64| {
            let mut results = thesis(2.0);
            for (mode, lookup, seconds, rays) in [("area", None, 2.0, 1e6), ("light-mesh", Some("lists"), 0.5, rays)] {
                let keys = [("mode", mode.into()), ("samples", 225.0.into())].into_iter();
                let mut row = crate::Row::new("figure 1", keys.chain(lookup.map(|lookup| ("lookup", lookup.into()))));
                row.seconds.insert("render".to_owned(), crate::Samples(vec![seconds]));
                row.values.extend([("rays".to_owned(), rays), ("mean_flip".to_owned(), 0.0)]);
                results.rows.push(row);
            }
            figures(&runs(vec![results])).swap_remove(0)
        };
        let told = with_lists(1e6);
        assert!(
            told.value == "4.0×" && told.label.contains("by 225 shadow rays per light, at a mean FLIP of 0"),
            "{told:?}"
        );
        assert!(with_lists(8e6).label.contains("the thesis"));
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
        let figures = figures(&runs(vec![results]));
        assert!(figures[0].value == "4.0×" && figures[0].label.ends_with("on Some GPU"), "{figures:?}");
    }
}
