//! The samples of an emitter, in rows.
//!
//! Visibility is decided row by row: each edge of a triangle bounds the hidden part of a row, whatever the number of samples in it. So
//! the samples of an emitter lie on lines, at equal distances.
//!
//! * A **disc** is cut into strips whose areas are proportional to their numbers of samples. Its rows halve the areas of their strips.
//!   Each surface point turns them by an angle of its own.
//! * A **rectangle** cannot be turned. Its rows ascend by the distance between two of them, so that an edge of a triangle parallel to a
//!   side of the rectangle meets them one after the other. Each surface point moves them across by up to that distance. What leaves the
//!   rectangle at one side enters it at the other: one line more than there are rows.
//!
//! In both, each surface point shifts the samples along their rows, by another part of their distance in each row. Compared with rows and
//! samples in fixed places that adds a tenth to the error, and removes the visible end of a penumbra; strata with one random
//! sample each have 1.6 times the error.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, Mutex};

use bytemuck::Zeroable;
use lightmesh_layout::constants::{MAX_OF_ROW, MAX_ROWS, MAX_WORDS, SHIFT_STEPS};
use lightmesh_layout::scene::SampleRows;

use crate::sync::locked;

const ROWS: usize = MAX_ROWS as usize;
const WORDS: usize = MAX_WORDS as usize;
/// Bits of a word.
const WORD: u32 = u32::BITS;
/// The inverse of the golden ratio: its multiples are spread evenly over the unit interval.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Numbers of samples whose rows are kept: an image needs up to three, with panes up to eight, and finding them takes as long as a wave of rays in
/// a small image.
pub const MAX_KNOWN: usize = 8;

/// The rows that were found last for the images of one renderer: no other waits for it.
#[derive(Debug, Default)]
pub struct KnownRows {
    /// With their numbers of samples, the latest first.
    known: Mutex<Vec<(u32, Arc<Rows>)>>,
}

/// The rows of samples of each shape. Large numbers of samples are split into several sets, to be tested one after another.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Samples of a disc.
    pub disc: Vec<SampleRows>,
    /// Samples of a rectangle.
    pub rectangle: Vec<SampleRows>,
}

/// One row.
#[derive(Clone, Copy, Debug)]
struct Row {
    y: f64,
    /// Half of its length.
    reach: f64,
    count: u32,
    line: u32,
    entering: bool,
    leaving: bool,
}

impl KnownRows {
    /// The rows of `samples` samples, at least 1.
    pub fn of(&self, samples: u32) -> Arc<Rows> {
        let mut known = locked(&self.known);
        if let Some((_, rows)) = known.iter().find(|(number, _)| *number == samples) {
            return Arc::clone(rows);
        }
        let rows = Arc::new(Rows::new(samples));
        known.truncate(MAX_KNOWN - 1);
        known.insert(0, (samples, Arc::clone(&rows)));
        rows
    }
}

impl Rows {
    /// `samples` samples, at least 1.
    pub fn new(samples: u32) -> Rows {
        Rows { disc: disc(samples), rectangle: rectangle(samples) }
    }
}

/// As many rows as there are samples in each, and no row too long.
fn lines(samples: u32) -> u32 {
    let square = (f64::from(samples).sqrt().round() as u32).max(1);
    // The rows in the middle of a disc have 4/π of the mean number.
    square.max((1.3 * f64::from(samples) / f64::from(MAX_OF_ROW)).ceil() as u32)
}

fn disc(samples: u32) -> Vec<SampleRows> {
    let lines = lines(samples);
    let counts = strips(samples, lines);
    let mut before = 0;
    let rows = (0..).zip(counts).filter(|&(_, count)| count > 0).map(|(line, count)| {
        let y = height((f64::from(before) + 0.5 * f64::from(count)) / f64::from(samples));
        before += count;
        Row { y, reach: (1.0 - y * y).sqrt(), count, line, entering: false, leaving: false }
    });
    sets(rows.collect(), SampleRows { lines, ..SampleRows::zeroed() })
}

/// The share of a disc's area below the height `y`.
fn area_below(y: f64) -> f64 {
    0.5 + (y * (1.0 - y * y).sqrt() + y.asin()) / PI
}

/// The height below which `share` of a disc's area lies.
fn height(share: f64) -> f64 {
    let (mut low, mut high) = (-FRAC_PI_2, FRAC_PI_2);
    // Over the arc's sine the area is smooth up to the ends.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if area_below(middle.sin()) < share { low = middle } else { high = middle }
    }
    (0.5 * (low + high)).sin()
}

/// Distributes samples over strips of equal height by their areas; what rounding leaves goes to those that lack most.
fn strips(samples: u32, lines: u32) -> Vec<u32> {
    let edge = |line: u32| area_below(2.0 * f64::from(line) / f64::from(lines) - 1.0);
    let shares: Vec<f64> = (0..lines).map(|line| f64::from(samples) * (edge(line + 1) - edge(line))).collect();
    let mut counts: Vec<u32> = shares.iter().map(|share| *share as u32).collect();
    let lack = |line: usize| shares[line] - shares[line].floor();
    let mut order: Vec<usize> = (0..shares.len()).collect();
    order.sort_by(|&a, &b| lack(b).total_cmp(&lack(a)).then(a.cmp(&b)));
    let left = samples - counts.iter().sum::<u32>();
    for &line in order.iter().cycle().take(left as usize) {
        counts[line] += 1;
    }
    counts
}

fn rectangle(samples: u32) -> Vec<SampleRows> {
    let lines = lines(samples);
    let count = samples.div_ceil(lines);
    // The first line and the last are parts of one row.
    let rows = (0..=lines).map(|line| Row {
        y: (2.0 * f64::from(line) - 1.0) / f64::from(lines) - 1.0,
        reach: 1.0,
        count,
        line: (line + lines - 1) % lines,
        entering: line == 0,
        leaving: line == lines,
    });
    sets(rows.collect(), SampleRows { lines, surplus: lines * count - samples, ..SampleRows::zeroed() })
}

/// Splits rows into sets, and arranges the rows of each by words.
fn sets(rows: Vec<Row>, common: SampleRows) -> Vec<SampleRows> {
    let mut sets = Vec::new();
    let mut rest = rows.as_slice();
    while !rest.is_empty() {
        let fits = |&size: &usize| packed(&rest[..size]).len() <= WORDS;
        let size = (1..=rest.len().min(ROWS)).rev().find(fits).unwrap_or(1);
        sets.push(set(&packed(&rest[..size]), common));
        rest = &rest[size..];
    }
    sets
}

/// Distributes rows over words: in their order, or the longest first if that takes fewer words.
fn packed(rows: &[Row]) -> Vec<Vec<Row>> {
    let mut sorted = rows.to_vec();
    sorted.sort_by_key(|row| std::cmp::Reverse(row.count));
    let (in_order, longest_first) = (first_fit(rows), first_fit(&sorted));
    if longest_first.len() < in_order.len() { longest_first } else { in_order }
}

/// Puts each row into the first word that has room.
fn first_fit(rows: &[Row]) -> Vec<Vec<Row>> {
    let mut words: Vec<Vec<Row>> = Vec::new();
    for &row in rows {
        let room = |word: &&mut Vec<Row>| word.iter().map(|other| other.count).sum::<u32>() + row.count <= WORD;
        match words.iter_mut().find(room) {
            Some(word) => word.push(row),
            None => words.push(vec![row]),
        }
    }
    words
}

fn set(words: &[Vec<Row>], common: SampleRows) -> SampleRows {
    let mut set = SampleRows { entering: MAX_ROWS, leaving: MAX_ROWS, words: words.len() as u32, ..common };
    let mut number = 0;
    for (word, rows) in words.iter().enumerate() {
        let mut place = 0;
        for row in rows {
            set.y[number] = row.y as f32;
            set.density[number] = (0.5 * f64::from(row.count) / row.reach) as f32;
            set.half[number] = 0.5 * row.count as f32;
            set.shift[number] =
                ((f64::from(row.line) * GOLDEN).fract() * f64::from(SHIFT_STEPS)).floor() as f32 / SHIFT_STEPS;
            set.count[number] = row.count;
            set.place[number] = place;
            set.line[number] = row.line;
            if row.entering {
                set.entering = number as u32;
            }
            if row.leaving {
                set.leaving = number as u32;
            }
            set.full[word] |= ((1 << row.count) - 1) << place;
            place += row.count;
            number += 1;
        }
        set.ends[word] = number as u32;
    }
    set.rows = number as u32;
    set
}
