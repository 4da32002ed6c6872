//! Visibility of light points, cached on the host.

use std::collections::HashMap;
use std::convert::Infallible;

use lightmesh_layout::constants::POINT_BITS;
use rayon::prelude::*;

use super::{Noticed, Seen, Table};
use crate::data::lit::LitBy;
use crate::gathered::SurfaceLight;
use crate::light_mesh::{BrickKey, bits};

/// Number of light points in a brick.
const POINTS: usize = 1 << POINT_BITS;

/// Rows of bricks, columns of lights. Known values do not move when bricks are added or lights change.
#[derive(Default)]
pub struct HostTable {
    rows: HashMap<BrickKey, usize>,
    columns: Vec<Column>,
}

/// The known values for one light, by row.
struct Column {
    seen: Seen,
    /// The light points whose value is known.
    known: Vec<u64>,
    answers: Answers,
}

enum Answers {
    /// Lit or not.
    Bits(Vec<u64>),
    /// Rays that reached the light.
    Shares(Vec<[u16; POINTS]>),
}

impl Table for HostTable {
    type Light = SurfaceLight;
    type Error = Infallible;

    fn memory_of(light: &SurfaceLight) -> u64 {
        light.memory()
    }

    fn len(&self) -> u64 {
        self.columns.iter().flat_map(|column| &column.known).map(|known| u64::from(known.count_ones())).sum()
    }

    fn memory(&self) -> u64 {
        let columns: usize = self.columns.iter().map(Column::memory).sum();
        (self.rows.capacity() * size_of::<(BrickKey, usize)>() + columns) as u64
    }

    fn forget(&mut self, noticed: &Noticed) -> Result<(), Infallible> {
        for Column { seen, known, answers } in &mut self.columns {
            let is_known = |row: usize| known.get(row).is_some_and(|&points| points != 0);
            let noticing =
                self.rows.par_iter().filter(|&(&brick, &row)| is_known(row) && noticed.by(brick, seen.kind()));
            for row in noticing.map(|(_, &row)| row).collect::<Vec<usize>>() {
                known[row] = 0;
                if let Answers::Bits(words) = answers {
                    words[row] = 0;
                }
            }
        }
        Ok(())
    }
}

impl HostTable {
    /// The rows of some bricks, which are added where they are new, and a column for each light. Values for another light, or for
    /// other samples, are discarded.
    pub(crate) fn admit(&mut self, bricks: &[BrickKey], lights: Vec<Seen>) -> Vec<usize> {
        let mut rows = Vec::with_capacity(bricks.len());
        for &brick in bricks {
            let next = self.rows.len();
            rows.push(*self.rows.entry(brick).or_insert(next));
        }
        self.columns.truncate(lights.len());
        for (index, seen) in lights.into_iter().enumerate() {
            match self.columns.get_mut(index) {
                Some(column) if column.seen == seen => {}
                Some(column) => *column = Column::new(seen),
                None => self.columns.push(Column::new(seen)),
            }
        }
        for column in &mut self.columns {
            column.grow(self.rows.len());
        }
        rows
    }

    /// Number of rays from each light point to a light.
    pub(crate) fn samples(&self, light: usize) -> u32 {
        self.columns[light].seen.samples()
    }

    /// The points of `used`, by brick, whose value for a light is unknown.
    pub(crate) fn unknown(&self, light: usize, rows: &[usize], used: &[u64]) -> Vec<u64> {
        let known = &self.columns[light].known;
        rows.iter().zip(used).map(|(&row, used)| used & !known[row]).collect()
    }

    /// Stores the results for the points of `asked`, by brick.
    pub(crate) fn learn(&mut self, light: usize, rows: &[usize], asked: &[u64], found: &LitBy) {
        let column = &mut self.columns[light];
        match (&mut column.answers, found) {
            (Answers::Bits(kept), LitBy::Bits(words)) => {
                rows.iter().zip(words).for_each(|(&row, word)| kept[row] |= word);
            }
            (Answers::Shares(kept), LitBy::Share { seen, .. }) => {
                let points = rows.iter().zip(asked).flat_map(|(&row, &asked)| bits(asked).map(move |bit| (row, bit)));
                points.zip(seen).for_each(|((row, bit), &share)| kept[row][bit as usize] = share);
            }
            // A column has the same form as its light.
            _ => return,
        }
        rows.iter().zip(asked).for_each(|(&row, asked)| column.known[row] |= asked);
    }

    /// What the points of `used`, by brick, see of a light.
    pub(crate) fn recall(&self, light: usize, rows: &[usize], used: &[u64]) -> LitBy {
        let column = &self.columns[light];
        let places = rows.iter().zip(used);
        match &column.answers {
            Answers::Bits(kept) => LitBy::Bits(places.map(|(&row, used)| kept[row] & used).collect()),
            Answers::Shares(kept) => {
                let shares = places.flat_map(|(&row, &used)| bits(used).map(move |bit| kept[row][bit as usize]));
                LitBy::Share { seen: shares.collect(), samples: column.seen.samples() }
            }
        }
    }
}

impl Column {
    fn new(seen: Seen) -> Column {
        let answers = if seen.is_share() { Answers::Shares(Vec::new()) } else { Answers::Bits(Vec::new()) };
        Column { seen, known: Vec::new(), answers }
    }

    fn grow(&mut self, rows: usize) {
        self.known.resize(rows, 0);
        match &mut self.answers {
            Answers::Bits(words) => words.resize(rows, 0),
            Answers::Shares(shares) => shares.resize(rows, [0; POINTS]),
        }
    }

    fn memory(&self) -> usize {
        let answers = match &self.answers {
            Answers::Bits(words) => words.capacity() * size_of::<u64>(),
            Answers::Shares(shares) => shares.capacity() * size_of::<[u16; POINTS]>(),
        };
        self.known.capacity() * size_of::<u64>() + answers
    }
}
