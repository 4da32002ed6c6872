//! One vertex for every combination of position and attributes used by the corners of faces.

use std::collections::HashMap;

/// No index: a corner without this attribute.
pub const NONE: u32 = u32::MAX;

/// Number of combinations of one position that are searched linearly before a hash table takes over: a file with thousands must not
/// take thousands of steps for each.
const LONGEST_CHAIN: usize = 12;

/// Indices of a corner: position, and two attributes or [`NONE`].
pub type Corner = [u32; 3];

/// The vertices so far.
///
/// Combinations of one position form a chain, the newest first. Faces use combinations that were used shortly before, and positions
/// near each other, so that the starts of the chains are in the cache; a hash table over all would be several times slower.
#[derive(Debug, Default)]
pub struct Vertices {
    corners: Vec<Corner>,
    /// By position: the newest vertex of its chain.
    newest: Vec<u32>,
    /// By vertex: the one before it in its chain.
    before: Vec<u32>,
    /// Vertices that are in no chain.
    others: HashMap<Corner, u32>,
}

impl Vertices {
    /// The vertex of this corner.
    pub fn of(&mut self, corner: Corner) -> u32 {
        let position = corner[0] as usize;
        if position >= self.newest.len() {
            self.newest.resize(position + 1, NONE);
        }
        let mut vertex = self.newest[position];
        for _ in 0..LONGEST_CHAIN {
            if vertex == NONE {
                let added = self.add(corner, self.newest[position]);
                self.newest[position] = added;
                return added;
            }
            if self.corners[vertex as usize] == corner {
                return vertex;
            }
            vertex = self.before[vertex as usize];
        }
        if let Some(&known) = self.others.get(&corner) {
            return known;
        }
        let added = self.add(corner, NONE);
        self.others.insert(corner, added);
        added
    }

    fn add(&mut self, corner: Corner, before: u32) -> u32 {
        self.corners.push(corner);
        self.before.push(before);
        self.corners.len() as u32 - 1
    }

    /// The combination of each vertex.
    pub fn into_corners(self) -> Vec<Corner> {
        self.corners
    }
}
