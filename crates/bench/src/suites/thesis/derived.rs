//! Tables 1 and 2, from the timings.

use super::experiments::TIMINGS;
use super::published::{SCENES, TABLE_1, TABLE_2};
use crate::{Findings, Key, Row, WHOLE};

/// Table 1: the share of listing used light points and creating the mesh, which are one step here. Garden with h and R = 3.1.
pub(super) fn table_1(findings: &mut Findings) {
    let garden = SCENES[2];
    let wanted = [
        ("scene", garden.name.into()),
        ("lights", f64::from(garden.lights).into()),
        ("mode", "light-mesh".into()),
        ("step", garden.step.into()),
        ("radius", 3.1.into()),
    ];
    let rows = timings(findings).filter(|row| wanted.iter().all(|(name, key)| row.keys.get(*name) == Some(key)));
    let rows: Vec<Row> = rows.filter_map(share).collect();
    findings.add(rows);
}

fn share(timing: &Row) -> Option<Row> {
    let (collect, total) = (timing.median("collect")?, timing.median(WHOLE)?);
    let mut row = Row::new("table 1", keys(timing, &["scene", "size", "device", "threads"]));
    row.values = values([("collect_seconds", collect), ("total_seconds", total), ("share", collect / total)]).collect();
    if let Some(&(_, collect, total)) = TABLE_1.iter().find(|cell| is_number(timing, "size", f64::from(cell.0))) {
        let figures =
            [("thesis_collect_seconds", collect), ("thesis_total_seconds", total), ("thesis_share", collect / total)];
        row.values.extend(values(figures));
    }
    Some(row)
}

/// Table 2: S_total. It is the same on every device; the thesis does not state size and radius for its values.
pub(super) fn table_2(findings: &mut Findings) {
    let mut rows: Vec<Row> = Vec::new();
    for timing in timings(findings) {
        let cell = TABLE_2.iter().find(|(scene, step, _)| {
            timing.keys.get("scene") == Some(&(*scene).into()) && is_number(timing, "step", *step)
        });
        let (Some(&(_, _, thesis)), Some(&ours)) = (cell, timing.values.get("light_points")) else { continue };
        let mut row = Row::new("table 2", keys(timing, &["scene", "step", "size", "radius"]));
        // Once for all devices and numbers of lights.
        if rows.iter().all(|known| known.id != row.id) {
            row.values = values([("light_points", ours), ("thesis_light_points", thesis)]).collect();
            rows.push(row);
        }
    }
    findings.add(rows);
}

fn timings(findings: &Findings) -> impl Iterator<Item = &Row> {
    findings.rows.iter().filter(|row| row.experiment == TIMINGS)
}

/// The row's keys with these names.
pub(super) fn keys(row: &Row, names: &[&'static str]) -> Vec<(&'static str, Key)> {
    names.iter().filter_map(|&name| Some((name, row.keys.get(name)?.clone()))).collect()
}

fn values<const N: usize>(figures: [(&str, f64); N]) -> impl Iterator<Item = (String, f64)> {
    figures.map(|(name, figure)| (name.to_owned(), figure)).into_iter()
}

fn is_number(row: &Row, key: &str, number: f64) -> bool {
    row.keys.get(key) == Some(&Key::Number(number))
}
