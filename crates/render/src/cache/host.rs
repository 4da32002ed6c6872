//! Visibility of light points, cached on the host.

use std::collections::HashMap;
use std::convert::Infallible;

use rayon::prelude::*;

use super::stored::{POINTS, Readable, ReadableAnswers, SLACK, Stored, StoredAnswers, StoredColumn, bytes_of_rows};
use super::{Allowance, ColumnKey, Invalidation, Table};
use crate::data::light_point_visibility::VisibilityOfLight;
use crate::light_mesh::{BrickKey, bits};
use crate::stages::irradiance_cache::cpu::SurfaceLight;
use crate::stages::irradiance_cache::saved::SavedLight;

/// Rows of bricks, columns of lights. Known values do not move when bricks are added or lights change.
#[derive(Default)]
pub struct HostTable {
    /// The row of each brick.
    #[doc(hidden)]
    pub rows: HashMap<BrickKey, usize>,
    /// The number of the last image that used each row.
    ages: Vec<u32>,
    columns: Vec<Column>,
    allowance: Allowance,
}

/// The known values for one light, by row.
struct Column {
    seen: ColumnKey,
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

    fn saved_light(light: &SurfaceLight) -> Result<SavedLight, Infallible> {
        Ok(light.saved())
    }

    fn restored_light(saved: SavedLight) -> SurfaceLight {
        SurfaceLight::restored(saved)
    }

    fn len(&self) -> u64 {
        self.columns.iter().flat_map(|column| &column.known).map(|known| u64::from(known.count_ones())).sum()
    }

    fn memory(&self) -> u64 {
        let columns: usize = self.columns.iter().map(Column::memory).sum();
        let rows = self.rows.capacity() * size_of::<(BrickKey, usize)>() + self.ages.capacity() * size_of::<u32>();
        (rows + columns) as u64
    }

    fn evict(&mut self, invalidation: &Invalidation) -> Result<(), Infallible> {
        for Column { seen, known, answers } in &mut self.columns {
            let is_known = |row: usize| known.get(row).is_some_and(|&points| points != 0);
            let invalidated =
                self.rows.par_iter().filter(|&(&brick, &row)| is_known(row) && invalidation.by(brick, seen.kind()));
            for row in invalidated.map(|(_, &row)| row).collect::<Vec<usize>>() {
                known[row] = 0;
                if let Answers::Bits(words) = answers {
                    words[row] = 0;
                }
            }
        }
        Ok(())
    }

    fn allow(&mut self, allowance: Allowance) {
        self.allowance = allowance;
    }

    fn stored(&self) -> Result<Stored, Infallible> {
        let mut keys = vec![None; self.rows.len()];
        self.rows.iter().for_each(|(&brick, &row)| keys[row] = Some(brick));
        let columns: Vec<Readable> = self.columns.iter().map(Column::readable).collect();
        Ok(Stored::gather(&keys, &self.ages, &columns))
    }

    fn restored(stored: Stored) -> HostTable {
        let ages = stored.ages;
        let rows = stored.bricks.into_iter().enumerate().map(|(row, brick)| (brick, row)).collect();
        let columns = stored.columns.into_iter().map(Column::restored).collect();
        HostTable { rows, ages, columns, allowance: Allowance::default() }
    }
}

impl HostTable {
    /// The rows of some bricks, which are added where they are new, and a column for each light. Values for another light, or for
    /// other samples, are discarded. `None` if these bricks alone would take more memory than is allowed.
    #[doc(hidden)]
    pub fn admit(&mut self, bricks: &[BrickKey], lights: Vec<ColumnKey>) -> Option<Vec<usize>> {
        self.columns.truncate(lights.len());
        for (index, seen) in lights.into_iter().enumerate() {
            match self.columns.get_mut(index) {
                Some(column) if column.seen == seen => {}
                Some(column) => *column = Column::new(seen),
                None => self.columns.push(Column::new(seen)),
            }
        }
        if !self.make_room(bricks) {
            *self = HostTable { allowance: self.allowance, ..HostTable::default() };
            return None;
        }
        let mut rows = Vec::with_capacity(bricks.len());
        for &brick in bricks {
            let next = self.rows.len();
            rows.push(*self.rows.entry(brick).or_insert(next));
        }
        self.ages.resize(self.rows.len(), 0);
        rows.iter().for_each(|&row| self.ages[row] = self.allowance.image);
        for column in &mut self.columns {
            column.grow(self.rows.len());
        }
        Some(rows)
    }

    /// Evicts bricks until there is room for those of `bricks` that are new: those that were not used for the longest go first. `false` if
    /// there is no room for them alone.
    fn make_room(&mut self, bricks: &[BrickKey]) -> bool {
        let Some(most) = self.allowance.most else { return true };
        let of_one = bytes_of_rows(1, self.columns.iter().map(|column| &column.seen));
        let most = (most / of_one) as usize;
        let known: Vec<usize> = bricks.iter().filter_map(|brick| self.rows.get(brick).copied()).collect();
        let new = bricks.len() - known.len();
        if self.rows.len() + new <= most {
            return true;
        }
        if bricks.len() > most {
            return false;
        }
        known.into_iter().for_each(|row| self.ages[row] = u32::MAX);
        // With a quarter more, not every image evicts some.
        let left = bricks.len().max(most - most / 4) - new;
        let mut order: Vec<usize> = (0..self.ages.len()).collect();
        order.sort_unstable_by_key(|&row| (u32::MAX - self.ages[row], row));
        order.truncate(left);
        self.retain(order);
        true
    }

    /// Moves some rows to the beginning, and removes the others.
    fn retain(&mut self, mut kept: Vec<usize>) {
        kept.sort_unstable();
        let mut moved = vec![None; self.ages.len()];
        kept.iter().enumerate().for_each(|(to, &from)| moved[from] = Some(to));
        let rows = std::mem::take(&mut self.rows);
        self.rows = rows.into_iter().filter_map(|(brick, row)| Some((brick, moved[row]?))).collect();
        self.ages = kept.iter().map(|&row| self.ages[row]).collect();
        self.columns.iter_mut().for_each(|column| column.retain(&kept));
    }

    /// Number of rays from each light point to a light.
    pub(crate) fn samples(&self, light: usize) -> u32 {
        self.columns[light].seen.samples()
    }

    /// The points of `used`, by brick, whose value for a light is unknown.
    #[doc(hidden)]
    pub fn unknown(&self, light: usize, rows: &[usize], used: &[u64]) -> Vec<u64> {
        let known = &self.columns[light].known;
        rows.iter().zip(used).map(|(&row, used)| used & !known[row]).collect()
    }

    /// Stores the results for the points of `asked`, by brick.
    #[doc(hidden)]
    pub fn learn(&mut self, light: usize, rows: &[usize], asked: &[u64], found: &VisibilityOfLight) {
        let column = &mut self.columns[light];
        match (&mut column.answers, found) {
            (Answers::Bits(kept), VisibilityOfLight::Bits(words)) => {
                rows.iter().zip(words).for_each(|(&row, word)| kept[row] |= word);
            }
            (Answers::Shares(kept), VisibilityOfLight::Share { seen, .. }) => {
                let points = rows.iter().zip(asked).flat_map(|(&row, &asked)| bits(asked).map(move |bit| (row, bit)));
                points.zip(seen).for_each(|((row, bit), &share)| kept[row][bit as usize] = share);
            }
            // A column has the same form as its light.
            _ => return,
        }
        rows.iter().zip(asked).for_each(|(&row, asked)| column.known[row] |= asked);
    }

    /// What the points of `used`, by brick, see of a light.
    #[doc(hidden)]
    pub fn lookup(&self, light: usize, rows: &[usize], used: &[u64]) -> VisibilityOfLight {
        let column = &self.columns[light];
        let places = rows.iter().zip(used);
        match &column.answers {
            Answers::Bits(kept) => VisibilityOfLight::Bits(places.map(|(&row, used)| kept[row] & used).collect()),
            Answers::Shares(kept) => {
                let shares = places.flat_map(|(&row, &used)| bits(used).map(move |bit| kept[row][bit as usize]));
                VisibilityOfLight::Share { seen: shares.collect(), samples: column.seen.samples() }
            }
        }
    }
}

impl Column {
    fn new(seen: ColumnKey) -> Column {
        let answers = if seen.is_share() { Answers::Shares(Vec::new()) } else { Answers::Bits(Vec::new()) };
        Column { seen, known: Vec::new(), answers }
    }

    fn restored(column: StoredColumn) -> Column {
        let answers = match &column.answers {
            StoredAnswers::Bits(words) => Answers::Bits(words.clone()),
            StoredAnswers::Shares(found) => {
                let mut shares = vec![[0; POINTS]; column.known.len()];
                column.spread(found, |row, bit, share| shares[row][bit as usize] = share);
                Answers::Shares(shares)
            }
        };
        Column { seen: column.seen, known: column.known, answers }
    }

    fn readable(&self) -> Readable<'_> {
        let answers = match &self.answers {
            Answers::Bits(words) => ReadableAnswers::Bits(words),
            Answers::Shares(shares) => ReadableAnswers::Shares(shares.as_flattened()),
        };
        Readable { seen: &self.seen, known: &self.known, answers }
    }

    fn retain(&mut self, kept: &[usize]) {
        // A new column has no rows yet.
        let kept = kept.iter().copied().take_while(|&row| row < self.known.len());
        match &mut self.answers {
            Answers::Bits(words) => *words = kept.clone().map(|row| words[row]).collect(),
            Answers::Shares(shares) => *shares = kept.clone().map(|row| shares[row]).collect(),
        }
        self.known = kept.map(|row| self.known[row]).collect();
    }

    fn grow(&mut self, rows: usize) {
        resize(&mut self.known, rows, 0);
        match &mut self.answers {
            Answers::Bits(words) => resize(words, rows, 0),
            Answers::Shares(shares) => resize(shares, rows, [0; POINTS]),
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

/// Makes a vector longer, with little room to spare.
fn resize<T: Clone>(values: &mut Vec<T>, len: usize, value: T) {
    if len > values.capacity() {
        values.reserve_exact(len + len / SLACK - values.len());
    }
    values.resize(len, value);
}
