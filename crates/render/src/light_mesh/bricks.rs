//! The sparse store of cells and light points.
//!
//! Space is divided into bricks of 4×4×4 lattice points. What an image touches lies on surfaces, so an image needs only few
//! bricks, and a brick's 64 points are one machine word: the used-bitmap is one `u64` per brick, and a light point's rank among
//! all used ones is a brick's base plus a population count. Bricks are found through a hash table and kept in ascending order
//! of their keys, so that nothing depends on the order in which threads encountered them.

use std::sync::Arc;

use glam::IVec3;
use lightmesh_layout::constants::{AXIS_BITS, BRICK_BITS, GOLDEN_RATIO, INDEX_BIAS, NO_SLOT, POINT_BITS};

/// A brick's coordinates packed into 57 bits: x in the lowest 19.
pub type BrickKey = u64;

/// A lattice point (or the cell above it): its brick's key, then its bit within the brick, in 63 bits.
pub type PointKey = u64;

/// The bits of a lattice point's index that give its position in its brick.
const WITHIN_BRICK: i32 = (1 << BRICK_BITS) - 1;

/// The brick that holds the lattice point `index`.
#[inline(always)]
pub fn brick_of(index: IVec3) -> BrickKey {
    let brick: IVec3 = (index + INDEX_BIAS) >> BRICK_BITS;
    (brick.z as u64) << (2 * AXIS_BITS) | (brick.y as u64) << AXIS_BITS | brick.x as u64
}

/// The bit of lattice point `index` within its brick: x in the lowest two bits.
#[inline(always)]
pub fn point_bit(index: IVec3) -> u32 {
    let within = index & WITHIN_BRICK;
    (within.z << (2 * BRICK_BITS) | within.y << BRICK_BITS | within.x) as u32
}

/// Brick and bit of a lattice point in one number.
#[inline(always)]
pub fn point_key(index: IVec3) -> PointKey {
    brick_of(index) << POINT_BITS | u64::from(point_bit(index))
}

/// The lattice point of a key: the inverse of [`point_key`].
#[inline(always)]
pub fn point_of(key: PointKey) -> IVec3 {
    let axis = |shift: u32| ((key >> (POINT_BITS + shift)) & ((1 << AXIS_BITS) - 1)) as i32;
    let bit = (key & ((1 << POINT_BITS) - 1)) as u32;
    (IVec3::new(axis(0), axis(AXIS_BITS), axis(2 * AXIS_BITS)) << BRICK_BITS) + place_of_bit(bit) - INDEX_BIAS
}

/// The position in its brick of the lattice point of a bit: the inverse of [`point_bit`].
#[inline(always)]
pub(super) fn place_of_bit(bit: u32) -> IVec3 {
    let bit = bit as i32;
    IVec3::new(bit, bit >> BRICK_BITS, bit >> (2 * BRICK_BITS)) & WITHIN_BRICK
}

/// A set of bricks, each with a dense index in ascending order of keys.
#[derive(Clone, Debug, Default)]
pub struct BrickMap {
    keys: Vec<BrickKey>,
    /// Open addressing with linear probing, at most half full; an entry is an index into `keys` or `NO_SLOT`.
    table: Vec<u32>,
}

impl BrickMap {
    /// The set of `keys`, which must ascend without duplicates.
    pub fn new(keys: Vec<BrickKey>) -> BrickMap {
        debug_assert!(keys.is_sorted_by(|a, b| a < b));
        let mut table = vec![NO_SLOT; (2 * keys.len()).next_power_of_two()];
        let mask = table.len() - 1;
        for (index, &key) in keys.iter().enumerate() {
            let mut slot = brick_hash(key) & mask;
            while table[slot] != NO_SLOT {
                slot = (slot + 1) & mask;
            }
            table[slot] = index as u32;
        }
        BrickMap { keys, table }
    }

    /// All keys, in ascending order.
    pub fn keys(&self) -> &[BrickKey] {
        &self.keys
    }

    /// The dense index of brick `key`, if it is in the set.
    #[inline(always)]
    pub fn find(&self, key: BrickKey) -> Option<usize> {
        let mask = self.table.len() - 1;
        let mut slot = brick_hash(key) & mask;
        loop {
            let index = self.table[slot] as usize;
            if index == NO_SLOT as usize {
                return None;
            }
            if self.keys[index] == key {
                return Some(index);
            }
            slot = (slot + 1) & mask;
        }
    }
}

/// Fibonacci hashing: the golden ratio spreads neighbouring keys.
#[inline(always)]
pub(crate) fn brick_hash(key: BrickKey) -> usize {
    (key.wrapping_mul(GOLDEN_RATIO) >> 32) as usize
}

/// The used light points of an image: a bitmap over bricks with a rank directory.
#[derive(Clone, Debug)]
pub struct UsedPoints {
    bricks: Arc<BrickMap>,
    used: Vec<u64>,
    /// Number of used points in all bricks before each one, and the total at the end.
    rank: Vec<u32>,
}

impl UsedPoints {
    /// Counts the used points of every brick; `used` has one word per brick.
    pub fn new(bricks: BrickMap, used: Vec<u64>) -> UsedPoints {
        UsedPoints::within(Arc::new(bricks), used)
    }

    /// A subset of the points: `used`, by brick. Bricks without remaining points stay.
    pub(crate) fn only(&self, used: Vec<u64>) -> UsedPoints {
        UsedPoints::within(Arc::clone(&self.bricks), used)
    }

    fn within(bricks: Arc<BrickMap>, used: Vec<u64>) -> UsedPoints {
        debug_assert_eq!(bricks.keys().len(), used.len());
        let mut rank = Vec::with_capacity(used.len() + 1);
        let mut total = 0;
        rank.push(0);
        for word in &used {
            total += word.count_ones();
            rank.push(total);
        }
        UsedPoints { bricks, used, rank }
    }

    /// Number of used light points, S_total.
    pub fn count(&self) -> usize {
        self.rank[self.rank.len() - 1] as usize
    }

    /// The bricks, each of which has at least one used point.
    pub fn bricks(&self) -> &BrickMap {
        &self.bricks
    }

    /// The used points of each brick.
    pub fn used(&self) -> &[u64] {
        &self.used
    }

    /// The rank of the first used point of brick `brick`.
    #[inline(always)]
    pub fn first_rank(&self, brick: usize) -> usize {
        self.rank[brick] as usize
    }

    /// The rank of a used point: its position among all used points in ascending order of brick, then bit.
    #[inline(always)]
    pub fn rank(&self, brick: usize, bit: u32) -> usize {
        let below = self.used[brick] & ((1 << bit) - 1);
        self.rank[brick] as usize + below.count_ones() as usize
    }

    /// The used points of brick `brick`, in ascending order.
    pub fn points(&self, brick: usize) -> impl Iterator<Item = IVec3> + '_ {
        let key = self.bricks.keys()[brick];
        bits(self.used[brick]).map(move |bit| point_of(key << POINT_BITS | u64::from(bit)))
    }
}

/// The positions of the set bits of `word`, in ascending order.
#[inline(always)]
pub fn bits(mut word: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        (word != 0).then(|| {
            let bit = word.trailing_zeros();
            word &= word - 1;
            bit
        })
    })
}
