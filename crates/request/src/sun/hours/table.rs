//! Hours of direct sun by object, as a table.
//!
//! What counts is the surface that the image shows: each pixel with the area that it shows of a surface. What is hidden from the camera, or
//! outside of the image, is not there; a plan is made by a camera with parallel rays from above.

use std::collections::BTreeMap;
use std::fmt::Write;

use glam::Vec3;

use super::found::SunHours;
use super::pixel_area::PixelGrid;

/// The columns. Areas are in squares of the scene's unit, hours are weighted by them.
const HEADER: &str =
    "object,pixels,visible_area,mean_hours_by_area,min_hours,max_hours,share_of_area_with_at_least_2_hours\n";
/// The hours that planners usually ask for.
const ENOUGH: f32 = 2.0;
/// Sums of single precision may be less by this.
const ROUNDING: f32 = 1e-4;

#[derive(Default)]
struct Row {
    pixels: u64,
    area: f64,
    hours: f64,
    enough: f64,
    least: f32,
    most: f32,
}

/// Text with a row for each object that is visible, in the order of the scene.
pub(super) fn table(found: &SunHours) -> String {
    let (layers, window) = (found.layers(), found.frame.window());
    let grid = PixelGrid::new(&found.camera, window.whole);
    let mut rows: BTreeMap<u32, Row> = BTreeMap::new();
    for pixel in (0..found.hours.len()).filter(|&pixel| found.sees(pixel)) {
        let (hours, width) = (found.hours[pixel], found.frame.width() as usize);
        let place = [window.first[0] + (pixel % width) as u32, window.first[1] + (pixel / width) as u32];
        let area = f64::from(grid.area(place, layers.depth[pixel], Vec3::from_array(layers.normal[pixel])));
        let number = layers.object.nearest.get(pixel).copied().unwrap_or_default();
        let row = rows.entry(number).or_insert_with(|| Row { least: f32::INFINITY, ..Row::default() });
        row.pixels += 1;
        row.area += area;
        row.hours += area * f64::from(hours);
        row.enough += if hours >= ENOUGH - ROUNDING { area } else { 0.0 };
        (row.least, row.most) = (row.least.min(hours), row.most.max(hours));
    }
    let mut text = HEADER.to_owned();
    for (number, Row { pixels, area, hours, enough, least, most }) in rows {
        let names = &layers.object.names;
        let name = quoted((number as usize).checked_sub(1).and_then(|index| names.get(index)).map_or("", |name| name));
        let (mean, share) = (hours / area, enough / area);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{name},{pixels},{area:.6},{mean:.4},{least:.4},{most:.4},{share:.4}");
    }
    text
}

/// A field of a table: in quotes if it needs them (RFC 4180).
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_end_fields() {
        assert_eq!(quoted("house 1"), "house 1");
        assert_eq!(quoted("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
