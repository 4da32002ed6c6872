//! Whole frames with soft shadows: a row for each scene, emitter and device, with the default, the half-ball and adaptive shadow rays
//! side by side. Many lights: a row for each number of lights and samples.

use super::generic::figure;
use super::{MANY_LIGHTS, WHOLE_FRAMES, key_column, whole};
use crate::Key;
use crate::report::document::{Block, Cell, Column, Table, Verdict};
use crate::report::numbers;
use crate::report::runs::{Measured, distinct};
use crate::report::spread::verdict;

/// Keys of a row of the table.
const KEYS: [&str; 4] = ["scene", "emitter", "size", "accel"];
/// Methods with their headings.
const METHODS: [(&str, &str); 3] = [("lists", "lists"), ("half-ball", "half-ball"), ("adaptive", "adaptive")];
/// The methods that are compared with the half-ball.
const RIVALS: [&str; 2] = ["lists", "adaptive"];
/// Ratios to the half-ball, and what they are called.
const RATIOS: [(&str, &str); 2] = [("faster_than_half_ball", "faster"), ("nearer_than_half_ball", "nearer")];

pub(super) fn whole_frames(rows: &[Measured]) -> Vec<Block> {
    let case = |row: &Measured| (row.place(), row.case(&["method"]));
    let mut columns: Vec<Column> = KEYS.iter().map(|key| key_column(key, rows)).collect();
    columns.push(Column::words("place", "device"));
    let figures = |value: &str, unit: &str| {
        METHODS.map(|(name, title)| Column::numbers(format!("{name} {value}"), title).below(unit))
    };
    columns.extend(figures("ms", "whole frame, ms"));
    columns.extend(figures("rmse", "RMSE of visibility"));
    for name in RIVALS {
        let below = |column: Column| column.below(format!("{name} by half-ball"));
        columns.extend(RATIOS.map(|(_, title)| below(Column::numbers(format!("{name} {title}"), title))));
        columns.push(below(Column::words(format!("{name} is"), "is")));
    }
    let caption = "The program's default, the thesis' lookup with its defaults, and one shadow ray, or as many as the lists have samples \
                   where a neighbourhood disagrees. Faster and nearer: the half-ball's time and error by theirs, above 1 they are ahead.";
    let mut table = Table::new(WHOLE_FRAMES, caption, columns);
    for wanted in distinct(rows.iter().map(case)) {
        let of_case: Vec<&Measured> = rows.iter().filter(|row| case(row) == wanted).collect();
        let method = |name: &str| of_case.iter().find(|row| row.is("method", name)).copied();
        let mut cells: Vec<Cell> = KEYS.iter().map(|key| of_case[0].text(key).into()).collect();
        cells.push(of_case[0].place().into());
        let milliseconds = |name| Cell::number(method(name).and_then(whole), numbers::milliseconds);
        cells.extend(METHODS.map(|(name, _)| milliseconds(name)));
        let error = |name| method(name).and_then(|row| row.value("visibility_rmse"));
        cells.extend(METHODS.map(|(name, _)| Cell::number(error(name), |error| figure("rmse", error))));
        for name in RIVALS {
            let ratios = RATIOS.map(|(ratio, _)| method(name).and_then(|row| row.value(ratio)));
            cells.extend(ratios.map(|ratio| Cell::number(ratio, numbers::ratio)));
            cells.push(words(ratios).into());
        }
        table.rows.push(cells);
    }
    vec![Block::Table(table.without_empty_columns())]
}

/// Time and memory by number of lights.
pub(super) fn many_lights(rows: &[Measured]) -> Vec<Block> {
    let keys = ["scene", "size", "samples", "lights", "accel"];
    let mut columns: Vec<Column> = keys.iter().map(|key| key_column(key, rows)).collect();
    columns.push(Column::words("place", "device"));
    columns.push(Column::numbers("frame ms", "whole frame").below("ms"));
    columns.push(Column::numbers("shadows ms", "shadows").below("ms"));
    columns.push(Column::numbers("light ms", "per light").below("ms"));
    columns.push(Column::numbers("by one", "per light").below("by one light"));
    columns.push(Column::numbers("bytes", "peak memory").below("bytes per pixel"));
    let caption = "Occluder lists with growing numbers of lights. Shadows: the stages between primary rays and shading. By one light: above \
                   1 each of many lights costs more than a single one. Memory is that of the GPU, or of the whole process.";
    let mut table = Table::new(MANY_LIGHTS, caption, columns);
    for row in rows {
        let shadows = row.row.seconds.get("shadows").and_then(|samples| samples.median());
        let lights = match row.key("lights") {
            Some(Key::Number(lights)) => Some(*lights),
            _ => None,
        };
        let mut cells: Vec<Cell> = keys.iter().map(|key| row.text(key).into()).collect();
        cells.push(row.place().into());
        cells.push(Cell::number(whole(row), numbers::milliseconds));
        cells.push(Cell::number(shadows, numbers::milliseconds));
        cells.push(Cell::number(shadows.zip(lights).map(|(time, lights)| time / lights), numbers::milliseconds));
        cells.push(Cell::number(row.value("per_light_by_one"), numbers::ratio));
        cells.push(Cell::number(row.value("peak_bytes_per_pixel"), numbers::setting));
        table.rows.push(cells);
    }
    vec![Block::Table(table.without_empty_columns())]
}

/// What ratios of times and errors say: `faster, nearer`; nothing unless both are known.
fn words(ratios: [Option<f64>; 2]) -> String {
    let [Some(faster), Some(nearer)] = ratios else { return String::new() };
    let word = |ratio: f64, [ahead, even, behind]: [&'static str; 3]| match verdict(1.0 / ratio) {
        Verdict::Wins => ahead,
        Verdict::Loses => behind,
        _ => even,
    };
    let time = word(faster, ["faster", "as fast", "slower"]);
    let error = word(nearer, ["nearer", "as near", "farther"]);
    format!("{time}, {error}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Row;

    #[test]
    fn a_row_says_at_a_glance_what_is_faster_and_nearer() {
        let results = crate::report::tests::results("shadows", |rows| {
            for (method, seconds, error, ratios) in [
                ("lists", 0.005, 0.01, Some([2.0, 5.0])),
                ("half-ball", 0.01, 0.05, None),
                ("adaptive", 0.02, 0.05, Some([0.5, 1.0])),
            ] {
                let keys = [("scene", "garden".into()), ("emitter", 0.042.into()), ("method", method.into())];
                let mut row = Row::new(WHOLE_FRAMES, keys.into_iter().chain([("device", "cuda".into())]));
                row.seconds.entry("render".to_owned()).or_default().push(seconds);
                row.values.insert("visibility_rmse".to_owned(), error);
                for (name, ratio) in RATIOS.iter().zip(ratios.into_iter().flatten()) {
                    row.values.insert(name.0.to_owned(), ratio);
                }
                rows.push(row);
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let blocks = whole_frames(&runs.rows(WHOLE_FRAMES));
        let [Block::Table(table)] = &blocks[..] else { panic!("{blocks:?}") };
        assert_eq!(table.rows.len(), 1);
        let text = |name: &str| {
            let column = table.columns.iter().position(|column| column.name == name);
            table.rows[0][column.unwrap_or_else(|| panic!("{name}"))].text.clone()
        };
        assert_eq!([text("scene"), text("emitter")], ["garden", "0.042"]);
        assert_eq!([text("lists ms"), text("half-ball ms"), text("adaptive rmse")], ["5.00", "10.0", "0.0500"]);
        assert_eq!([text("lists is"), text("adaptive is")], ["faster, nearer", "slower, as near"]);
        assert_eq!(text("lists faster"), "2.0×");
    }

    #[test]
    fn many_lights_are_compared_with_one() {
        let results = crate::report::tests::results("shadows", |rows| {
            for (lights, seconds, ratio) in [(1.0, 0.002, 1.0), (64.0, 0.064, 0.5)] {
                let keys = [("scene", "childpark".into()), ("lights", lights.into()), ("device", "cuda".into())];
                let mut row = Row::new(MANY_LIGHTS, keys);
                row.seconds.entry("render".to_owned()).or_default().push(2.0 * seconds);
                row.seconds.entry("shadows".to_owned()).or_default().push(seconds);
                row.values.insert("per_light_by_one".to_owned(), ratio);
                row.values.insert("peak_bytes_per_pixel".to_owned(), 52.0);
                rows.push(row);
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let blocks = many_lights(&runs.rows(MANY_LIGHTS));
        let [Block::Table(table)] = &blocks[..] else { panic!("{blocks:?}") };
        let text = |row: usize, name: &str| {
            let column = table.columns.iter().position(|column| column.name == name);
            table.rows[row][column.unwrap_or_else(|| panic!("{name}"))].text.clone()
        };
        assert_eq!(
            ["lights", "shadows ms", "light ms", "by one"].map(|name| text(1, name)),
            ["64", "64.0", "1.00", "0.50×"]
        );
        assert_eq!([text(0, "light ms"), text(0, "by one"), text(0, "bytes")], ["2.00", "1.0×", "52"]);
    }

    #[test]
    fn what_was_not_measured_is_not_judged() {
        assert_eq!(words([Some(2.0), None]), "");
        assert_eq!(words([Some(1.02), Some(0.5)]), "as fast, farther");
    }
}
