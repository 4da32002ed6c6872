//! The number of lights above which the method is faster than hard shadows: by the cost model, formulas (4) and (5), and as
//! measured.
//!
//! ```text
//! wh · nL · c_long = wh · S_sphere · c_short + nL · S_total · c_long                                 (4) = (5)
//! nL = wh · S_sphere · c_short / ((wh − S_total) · c_long)
//! ```
//!
//! wh is the number of pixels that hit something. c_short is the time of the short tests over wh · S_sphere, c_long the time of
//! hard shadows' shadow rays over their number: both with the fewest lights measured. The model omits primary rays, which both
//! modes have, and everything in the method except its tests. The measured answer is interpolated linearly between the last
//! number of lights at which the method is slower and the first at which it is not.
//!
//! A linear fit over all numbers of lights explains the difference between the two: a fixed time, and a time per light. In the
//! model a light costs the method S_total long tests. In practice it also costs one evaluation of formula (3), and in both modes
//! a term of formula (1), per pixel.

use std::collections::BTreeMap;

use super::derived::keys;
use super::experiments::LIGHTS;
use super::published::{FIGURE_SCENE, LIGHTS_RADIUS};
use crate::{Findings, Key, Row, WHOLE};

/// The method and hard shadows at one number of lights.
struct Pair<'r> {
    lights: f64,
    method: &'r Row,
    hard: &'r Row,
}

/// Adds a row for each device on which figure 11 was measured.
pub(super) fn add(findings: &mut Findings) {
    let mut devices: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in findings.rows.iter().filter(|row| row.experiment == LIGHTS) {
        devices.entry(format!("{:?}", keys(row, &["device", "threads"]))).or_default().push(row);
    }
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for pairs in devices.values().map(|rows| pairs(rows)) {
        let Some(first) = pairs.first() else { continue };
        let mut row = Row::new("figure 11, break-even", keys(first.method, &["scene", "size", "device", "threads"]));
        predict(first, &mut row);
        fit(&pairs, &mut row);
        match measured(&pairs) {
            Some(lights) => drop(row.values.insert("measured_lights".to_owned(), lights)),
            None => notes.push(format!("{}: the method was slower for every measured number of lights.", row.id)),
        }
        if !row.values.contains_key("predicted_lights") {
            notes.push(format!(
                "{}: according to the cost model the method is never faster, as S_total is not below the number of pixels.",
                row.id
            ));
        }
        rows.push(row);
    }
    findings.add(rows);
    findings.notes.extend(notes);
}

/// Both modes at each number of lights, in ascending order.
fn pairs<'r>(rows: &[&'r Row]) -> Vec<Pair<'r>> {
    let of_mode =
        |mode: &str| rows.iter().copied().filter(move |row| row.keys.get("mode") == Some(&mode.into())).collect();
    let (methods, hards): (Vec<&Row>, Vec<&Row>) = (of_mode("light-mesh"), of_mode("ray-trace"));
    let pair = |method: &'r Row| {
        let hard = hards.iter().find(|hard| hard.keys.get("lights") == method.keys.get("lights"))?;
        let Some(Key::Number(lights)) = method.keys.get("lights") else { return None };
        Some(Pair { lights: *lights, method, hard })
    };
    let mut pairs: Vec<Pair> = methods.into_iter().filter_map(pair).collect();
    pairs.sort_by(|a, b| a.lights.total_cmp(&b.lights));
    pairs
}

/// The prediction of the cost model, and its two constants.
fn predict(pair: &Pair, row: &mut Row) {
    let value = |row: &Row, name: &str| row.values.get(name).copied().unwrap_or(0.0);
    let (hits, half_ball) = (value(pair.method, "hits"), value(pair.method, "half_ball_mean"));
    let (points, rays) = (value(pair.method, "light_points"), value(pair.hard, "shadow_rays"));
    let (Some(short), Some(long)) = (pair.method.median("short_tests"), pair.hard.median("shadow_rays")) else {
        return;
    };
    let (c_short, c_long) = (short / (hits * half_ball), long / rays);
    let lights = hits * half_ball * c_short / ((hits - points) * c_long);
    let figures = [
        ("step", FIGURE_SCENE.step),
        ("radius", LIGHTS_RADIUS),
        ("short_test_seconds", c_short),
        ("long_test_seconds", c_long),
        ("predicted_lights", lights),
    ];
    // A negative or infinite number of lights means never; without hits or rays there is no prediction.
    let told = figures.into_iter().filter(|(_, figure)| figure.is_finite() && *figure > 0.0);
    row.values.extend(told.map(|(name, figure)| (name.to_owned(), figure)));
}

/// Linear least-squares fits to the seconds of both modes.
fn fit(pairs: &[Pair], row: &mut Row) {
    let mut add = |name: &str, of: for<'p, 'r> fn(&'p Pair<'r>) -> &'r Row| {
        let seconds = pairs.iter().filter_map(|pair| Some((pair.lights, of(pair).median(WHOLE)?)));
        if let Some((fixed, per_light)) = line(&seconds.collect::<Vec<_>>()) {
            row.values.insert(format!("{name}_seconds"), fixed);
            row.values.insert(format!("{name}_seconds_per_light"), per_light);
        }
    };
    add("method", |pair| pair.method);
    add("hard", |pair| pair.hard);
}

/// Intercept and slope of the line through points; `None` unless there are two distinct abscissae.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let spread: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    let together: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    (spread > 0.0).then(|| (y - together / spread * x, together / spread))
}

/// The measured break-even: the fewest lights from which on the method is always as fast; `None` if it never is.
fn measured(pairs: &[Pair]) -> Option<f64> {
    let lead = |pair: &Pair| Some((pair.lights, pair.method.median(WHOLE)? - pair.hard.median(WHOLE)?));
    let leads: Vec<(f64, f64)> = pairs.iter().filter_map(lead).collect();
    let first = leads.iter().position(|(_, lead)| *lead <= 0.0)?;
    let (lights, after) = leads[first];
    let Some(&(fewer, before)) = first.checked_sub(1).map(|index| &leads[index]) else { return Some(lights) };
    Some(fewer + (lights - fewer) * before / (before - after))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;

    fn row(mode: &str, lights: f64, seconds: &[(&str, f64)], values: &[(&str, f64)]) -> Row {
        let mut row = Row::new(LIGHTS, [("lights", lights.into()), ("mode", mode.into()), ("device", "cpu".into())]);
        row.seconds = seconds.iter().map(|(stage, seconds)| ((*stage).to_owned(), Samples(vec![*seconds]))).collect();
        row.values = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        row
    }

    /// The method takes 10 + lights / 10 seconds, hard shadows take 2 + lights.
    fn findings(light_points: f64) -> Findings {
        let rows = [1.0, 8.0, 16.0].into_iter().flat_map(|lights| {
            let counts = [("hits", 1000.0), ("half_ball_mean", 20.0), ("light_points", light_points)];
            let method = [("render", 10.0 + 0.1 * lights), ("short_tests", 8.0)];
            let hard = [("render", 2.0 + lights), ("shadow_rays", lights)];
            let rays = [("shadow_rays", 1000.0 * lights)];
            [row("light-mesh", lights, &method, &counts), row("ray-trace", lights, &hard, &rays)]
        });
        Findings { rows: rows.collect(), ..Findings::default() }
    }

    #[test]
    fn model_and_clock_name_a_number_of_lights() {
        let mut findings = findings(100.0);
        add(&mut findings);
        let values = &findings.rows.last().unwrap().values;
        assert!((values["predicted_lights"] - 8.0 / 0.9).abs() < 1e-9, "{values:?}");
        assert!((values["measured_lights"] - 8.0 / 0.9).abs() < 1e-9, "{values:?}");
        assert_eq!((values["short_test_seconds"], values["long_test_seconds"]), (4e-4, 1e-3));
        let lines = ["method_seconds", "method_seconds_per_light", "hard_seconds", "hard_seconds_per_light"];
        for (name, expected) in lines.into_iter().zip([10.0, 0.1, 2.0, 1.0]) {
            assert!((values[name] - expected).abs() < 1e-9, "{name}: {values:?}");
        }
        assert!(findings.notes.is_empty());
    }

    #[test]
    fn never_is_said_in_notes() {
        let mut findings = findings(2000.0);
        findings.rows.retain(|row| row.keys["lights"] != 16.0.into());
        add(&mut findings);
        let values = &findings.rows.last().unwrap().values;
        assert!(!values.contains_key("predicted_lights") && !values.contains_key("measured_lights"), "{values:?}");
        assert_eq!(findings.notes.len(), 2);
    }
}
