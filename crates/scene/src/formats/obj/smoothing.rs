//! Smoothing groups: `s` and a number, or `off`.

/// The groups of all triangles so far.
#[derive(Debug, Default)]
pub(super) struct Smoothing {
    /// By triangle, 0 for none; empty as long as no group has begun.
    pub(super) groups: Vec<u32>,
    current: Option<u32>,
}

impl Smoothing {
    /// Begins a group above which there are `triangles`; `false` if the word names none.
    pub(super) fn begin(&mut self, word: &[u8], triangles: usize) -> bool {
        let Some(group) = group(word) else { return false };
        // Before the first statement the format has smoothing off.
        self.groups.resize(triangles, 0);
        self.current = Some(group);
        true
    }

    /// Puts all triangles that are in no group yet, up to that many, into the current one.
    pub(super) fn extend_to(&mut self, triangles: usize) {
        if let Some(group) = self.current {
            self.groups.resize(triangles, group);
        }
    }
}

/// The number of a group; 0 is off.
fn group(word: &[u8]) -> Option<u32> {
    if word.eq_ignore_ascii_case(b"off") {
        return Some(0);
    }
    // A number that is too large still is another one than the usual.
    let is_number = !word.is_empty() && word.iter().all(u8::is_ascii_digit);
    is_number.then(|| {
        word.iter().fold(0, |number: u32, digit| number.saturating_mul(10).saturating_add(u32::from(digit - b'0')))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_is_a_number_or_off() {
        assert_eq!([&b"off"[..], b"OFF", b"0", b"007", b"99999999999"].map(group), [0, 0, 0, 7, u32::MAX].map(Some));
        assert_eq!([&b""[..], b"on", b"-1", b"1.5"].map(group), [None; 4]);
    }

    #[test]
    fn triangles_above_the_first_group_are_in_none() {
        let mut smoothing = Smoothing::default();
        smoothing.extend_to(2);
        assert!(smoothing.groups.is_empty());
        assert!(!smoothing.begin(b"on", 2) && smoothing.groups.is_empty());
        assert!(smoothing.begin(b"3", 2));
        smoothing.extend_to(4);
        assert!(smoothing.begin(b"off", 4));
        smoothing.extend_to(5);
        assert_eq!(smoothing.groups, [0, 0, 3, 3, 0]);
    }
}
