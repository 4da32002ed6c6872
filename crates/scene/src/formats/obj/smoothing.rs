//! Smoothing groups: `s` and a number, or `off`.

/// The groups of all triangles so far.
#[derive(Debug, Default)]
pub struct Smoothing {
    /// By triangle, 0 for none; empty as long as no group has begun.
    pub groups: Vec<u32>,
    current: Option<u32>,
}

impl Smoothing {
    /// Begins a group above which there are `triangles`; `false` if the word names none.
    pub fn begin(&mut self, word: &[u8], triangles: usize) -> bool {
        let Some(group) = group(word) else { return false };
        // Before the first statement the format has smoothing off.
        self.groups.resize(triangles, 0);
        self.current = Some(group);
        true
    }

    /// Puts all triangles that are in no group yet, up to that many, into the current one.
    pub fn extend_to(&mut self, triangles: usize) {
        if let Some(group) = self.current {
            self.groups.resize(triangles, group);
        }
    }
}

/// The number of a group; 0 is off.
pub fn group(word: &[u8]) -> Option<u32> {
    if word.eq_ignore_ascii_case(b"off") {
        return Some(0);
    }
    // A number that is too large still is another one than the usual.
    let is_number = !word.is_empty() && word.iter().all(u8::is_ascii_digit);
    is_number.then(|| {
        word.iter().fold(0, |number: u32, digit| number.saturating_mul(10).saturating_add(u32::from(digit - b'0')))
    })
}
