//! Hours of direct sun by object, as a table.
//!
//! What counts is the surface that the image shows: each pixel with the area that it shows of a surface. What is hidden from the camera, or
//! outside of the image, does not count; a plan is made by a camera with parallel rays from above. The number of points says how much a row
//! rests on: that of its pixels, or of [their parts](super::finer) where these are few. Objects that no pixel sees have a row with 0 pixels and no
//! hours.
//!
//! Hours have as many decimals as the step of the study allows. Spreadsheets would run names that begin like formulas: they get an apostrophe
//! in front, which shows them as text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use glam::Vec3;

use super::finer;
use super::found::SunHours;
use super::pixel_area::PixelGrid;

/// The columns. Areas are in squares of the scene's unit, hours are weighted by them.
const HEADER: &str =
    "object,pixels,visible_area,mean_hours_by_area,min_hours,max_hours,share_of_area_with_at_least_2_hours,points\n";
/// The hours that planners usually ask for.
const ENOUGH: f32 = 2.0;
/// Sums of single precision may be less by this.
const ROUNDING: f32 = 1e-4;

#[derive(Default)]
struct Row {
    pixels: u64,
    /// Points that the rest is the mean of.
    points: u64,
    area: f64,
    hours: f64,
    enough: f64,
    least: f32,
    most: f32,
}

impl Row {
    fn new(pixels: u64) -> Row {
        Row { pixels, least: f32::INFINITY, ..Row::default() }
    }

    /// Adds a point that stands for some area.
    fn add(&mut self, area: f64, hours: f32) {
        self.points += 1;
        self.area += area;
        self.hours += area * f64::from(hours);
        self.enough += if hours >= ENOUGH - ROUNDING { area } else { 0.0 };
        (self.least, self.most) = (self.least.min(hours), self.most.max(hours));
    }
}

/// The rows of the objects that pixels see, by their numbers. What has no object is number 0.
fn rows(found: &SunHours) -> BTreeMap<u32, Row> {
    let (layers, window) = (found.layers(), found.frame.window());
    let grid = PixelGrid::new(&found.camera, window.whole);
    let mut rows: BTreeMap<u32, Row> = BTreeMap::new();
    for pixel in (0..found.hours.len()).filter(|&pixel| found.sees(pixel)) {
        let (hours, width) = (found.hours[pixel], found.frame.width() as usize);
        let place = [window.first[0] + (pixel % width) as i32, window.first[1] + (pixel / width) as i32];
        let area = f64::from(grid.area(place, layers.depth[pixel], Vec3::from_array(layers.normal[pixel])));
        let number = layers.object.nearest.get(pixel).copied().unwrap_or_default();
        let row = rows.entry(number).or_insert_with(|| Row::new(0));
        row.pixels += 1;
        row.add(area, hours);
    }
    for (number, points) in &found.finer.0 {
        if let Some(row) = rows.get_mut(number).filter(|row| row.points <= points.len() as u64) {
            *row = Row::new(row.pixels);
            points.iter().for_each(|point| row.add(point.area, point.hours as f32));
        }
    }
    rows
}

/// How many objects that pixels see have too few points.
pub(super) fn short(found: &SunHours) -> usize {
    rows(found).iter().filter(|(number, row)| **number > 0 && row.points < finer::ENOUGH).count()
}

/// How many objects no pixel sees, and how many there are.
pub(super) fn unseen(found: &SunHours) -> (usize, usize) {
    let object = &found.layers().object;
    let mut unseen: BTreeSet<u32> = (1..=object.names.len() as u32).collect();
    for number in object.nearest.iter().enumerate().filter_map(|(pixel, number)| found.sees(pixel).then_some(number)) {
        unseen.remove(number);
    }
    (unseen.len(), object.names.len())
}

/// Text with a row for each object, in the order of the scene.
pub(super) fn table(found: &SunHours) -> String {
    let (rows, names) = (rows(found), &found.layers().object.names);
    let decimals = found.study.decimals();
    let mut text = HEADER.to_owned();
    let nameless = rows.contains_key(&0).then_some((0, ""));
    for (number, name) in nameless.into_iter().chain((1..).zip(names.iter().map(String::as_str))) {
        let name = field(name);
        // Writing to a text cannot fail.
        let _ = match rows.get(&number) {
            Some(Row { pixels, points, area, hours, enough, least, most }) => {
                let (mean, share) = (hours / area, enough / area);
                let hours = format!("{mean:.decimals$},{least:.decimals$},{most:.decimals$}");
                writeln!(text, "{name},{pixels},{area:.6},{hours},{share:.4},{points}")
            }
            None => writeln!(text, "{name},0,0,,,,,0"),
        };
    }
    text
}

/// A field of a table: no formula, and in quotes if it needs them (RFC 4180).
fn field(name: &str) -> String {
    let apostrophe = if name.starts_with(['=', '+', '-', '@', '\t', '\r']) { "'" } else { "" };
    let name = format!("{apostrophe}{name}");
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_end_fields() {
        assert_eq!(field("house 1"), "house 1");
        assert_eq!(field("a, \"b\""), "\"a, \"\"b\"\"\"");
    }

    #[test]
    fn names_are_no_formulas() {
        assert_eq!(field("=1+1"), "'=1+1");
        assert_eq!(field("=cmd|' /C calc'!A0,x"), "\"'=cmd|' /C calc'!A0,x\"");
        for name in ["+1", "-1", "@sum", "\tx"] {
            assert_eq!(field(name), format!("'{name}"));
        }
        assert_eq!(field("a=1"), "a=1");
    }
}
