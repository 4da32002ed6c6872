//! What light points see, in the form in which it goes from one table to another, and to files: by brick, in ascending order. It is the same
//! for all backends.

use lightmesh_layout::constants::POINT_BITS;

use super::column_key::ColumnKey;
use crate::light_mesh::{BrickKey, bits};

/// Number of light points in a brick.
pub(super) const POINTS: usize = 1 << POINT_BITS;

/// Bytes that a table takes at most for so many bricks and these lights. Its keys grow to twice of what they hold, while the old ones are
/// still there; columns, one after the other, by a `SLACK`th.
pub fn bytes_of_rows<'a>(bricks: usize, lights: impl Iterator<Item = &'a ColumnKey>) -> u64 {
    let (sum, largest) =
        lights.map(bytes_of_brick).fold((0, 0), |(sum, largest), column| (sum + column, column.max(largest)));
    let keys = 3 * (size_of::<(BrickKey, usize)>() + size_of::<u32>());
    (bricks * (keys + sum + sum / SLACK + largest)) as u64
}

/// Bytes of a brick in the column of a light: which of its light points are known, and what they see.
pub(super) fn bytes_of_brick(seen: &ColumnKey) -> usize {
    size_of::<u64>() + if seen.is_share() { POINTS * size_of::<u16>() } else { size_of::<u64>() }
}

/// Columns have room for one part in this many more than they hold.
pub(super) const SLACK: usize = 4;

/// The known values of some light points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stored {
    /// Bricks, in ascending order.
    pub bricks: Vec<BrickKey>,
    /// The number of the last image that used each of them: of those from files, 0.
    pub ages: Vec<u32>,
    /// One for each light, in the order of lights.
    pub columns: Vec<StoredColumn>,
}

/// The known values for one light.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredColumn {
    /// What determines the values.
    pub seen: ColumnKey,
    /// The light points whose value is known, by brick.
    pub known: Vec<u64>,
    /// The values.
    pub answers: StoredAnswers,
}

/// What known light points see of a light.
#[derive(Clone, Debug, PartialEq)]
pub enum StoredAnswers {
    /// Lit or not, by brick; of known light points only.
    Bits(Vec<u64>),
    /// Rays that reached the light: one number for each known light point.
    Shares(Vec<u16>),
}

impl Stored {
    /// Number of values: light points times lights.
    pub(super) fn len(&self) -> u64 {
        self.columns.iter().flat_map(|column| &column.known).map(|known| u64::from(known.count_ones())).sum()
    }

    /// Bytes in the host's memory.
    pub(super) fn memory(&self) -> u64 {
        let column = |column: &StoredColumn| {
            let answers = match &column.answers {
                StoredAnswers::Bits(words) => size_of_val(&words[..]),
                StoredAnswers::Shares(shares) => size_of_val(&shares[..]),
            };
            size_of_val(&column.known[..]) + answers
        };
        (size_of_val(&self.bricks[..]) + self.columns.iter().map(column).sum::<usize>()) as u64
    }

    /// Leaves out bricks of which a table would take more bytes than `most`.
    pub fn limit(&mut self, most: Option<u64>) {
        let bytes = bytes_of_rows(self.bricks.len(), self.columns.iter().map(|column| &column.seen));
        let Some(most) = most.filter(|&most| bytes > most) else { return };
        self.truncate((self.bricks.len() as u128 * u128::from(most) / u128::from(bytes)) as usize);
    }

    /// Leaves the first `left` bricks.
    pub(super) fn truncate(&mut self, left: usize) {
        self.bricks.truncate(left);
        self.ages.truncate(left);
        for column in &mut self.columns {
            column.known.truncate(left);
            match &mut column.answers {
                StoredAnswers::Bits(words) => words.truncate(left),
                StoredAnswers::Shares(shares) => {
                    shares.truncate(column.known.iter().map(|known| known.count_ones() as usize).sum());
                }
            }
        }
    }

    /// What is known at places of a table that are told by `keys`: those of bricks, each once, and `None` where there is none. Bricks of
    /// which nothing is known are left out.
    pub(super) fn gather(keys: &[Option<BrickKey>], ages: &[u32], columns: &[Readable]) -> Stored {
        let is_known = |&(place, _): &(usize, BrickKey)| columns.iter().any(|column| column.known[place] != 0);
        let places = keys.iter().enumerate().filter_map(|(place, key)| Some((place, (*key)?)));
        let mut places: Vec<(usize, BrickKey)> = places.filter(is_known).collect();
        places.sort_unstable_by_key(|&(_, key)| key);
        let column = |column: &Readable| {
            let known: Vec<u64> = places.iter().map(|&(place, _)| column.known[place]).collect();
            let answers = match &column.answers {
                ReadableAnswers::Bits(words) => {
                    StoredAnswers::Bits(places.iter().map(|&(place, _)| words[place] & column.known[place]).collect())
                }
                ReadableAnswers::Shares(shares) => {
                    let of = |&(place, _): &(usize, BrickKey)| {
                        bits(column.known[place]).map(move |bit| shares[place * POINTS + bit as usize])
                    };
                    StoredAnswers::Shares(places.iter().flat_map(of).collect())
                }
            };
            StoredColumn { seen: column.seen.clone(), known, answers }
        };
        Stored {
            columns: columns.iter().map(column).collect(),
            ages: places.iter().map(|&(place, _)| ages[place]).collect(),
            bricks: places.into_iter().map(|(_, key)| key).collect(),
        }
    }
}

impl StoredColumn {
    /// All shares by brick, known or not.
    pub(super) fn spread(&self, shares: &[u16], mut put: impl FnMut(usize, u32, u16)) {
        let points = self.known.iter().enumerate().flat_map(|(row, &known)| bits(known).map(move |bit| (row, bit)));
        points.zip(shares).for_each(|((row, bit), &share)| put(row, bit, share));
    }
}

/// The column of a table, by place.
pub(super) struct Readable<'a> {
    pub(super) seen: &'a ColumnKey,
    pub(super) known: &'a [u64],
    pub(super) answers: ReadableAnswers<'a>,
}

pub(super) enum ReadableAnswers<'a> {
    Bits(&'a [u64]),
    /// [`POINTS`] shares at each place.
    Shares(&'a [u16]),
}
