//! Corners of triangles, listed by a key.

/// For each key, the corners that have it, in ascending order: a counting sort.
pub struct Buckets {
    /// Where the list of each key begins, and where the last ends.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Buckets {
    /// Lists all corners by their key, which is below `keys`; those without one are left out.
    pub fn new(keys: usize, corners: usize, key: impl Fn(u32) -> Option<u32>) -> Buckets {
        let all = 0..corners as u32;
        let mut starts = vec![0; keys + 1];
        for key in all.clone().filter_map(&key) {
            starts[key as usize + 1] += 1;
        }
        for index in 1..starts.len() {
            starts[index] += starts[index - 1];
        }
        let mut listed = vec![0; starts[keys] as usize];
        for (corner, key) in all.filter_map(|corner| Some((corner, key(corner)?))) {
            let next = &mut starts[key as usize];
            listed[*next as usize] = corner;
            *next += 1;
        }
        // Each start has moved to that of the next key.
        starts.rotate_right(1);
        starts[0] = 0;
        Buckets { starts, corners: listed }
    }

    /// The list of each key, to be ordered as needed.
    pub fn each(&mut self, mut visit: impl FnMut(usize, &mut [u32])) {
        for (key, ends) in self.starts.windows(2).enumerate() {
            visit(key, &mut self.corners[ends[0] as usize..ends[1] as usize]);
        }
    }
}
