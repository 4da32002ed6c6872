//! The corners of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from −1.

use super::error::Fault;
use crate::formats::{
    text::{quoted, words},
    vertices::{Corner, NONE},
};

const KINDS: [&str; 3] = ["position", "texture coordinate", "normal"];

const REMEDY: &str = "indices count from 1, or backwards from −1; correct the face or export the file again";

/// Why an index has no effect: some programs write those of attributes that they do not write.
const NOTHING_TO_REFER_TO: [&str; 3] = [
    "",
    "refers to a texture coordinate, but there is none: it is ignored",
    "refers to a normal, but there is none: it is ignored",
];

/// Numbers of positions, texture coordinates and normals.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    /// Above the face: indices below 0 count backwards from here.
    pub(super) above: [usize; 3],
    /// All that the face can refer to.
    pub(super) all: [usize; 3],
}

/// Reads the corners up to a comment into `corners`. An attribute that one corner lacks is removed from all. Calls `odd` with what is read
/// all the same: the attribute, the oddity, and the corner.
pub(super) fn read(
    text: &[u8],
    counts: Counts,
    corners: &mut Vec<Corner>,
    mut odd: impl FnMut(usize, &'static str, &[u8]),
) -> Result<(), Fault> {
    corners.clear();
    for word in words(text).take_while(|word| word[0] != b'#') {
        corners.push(corner(word, counts, &mut odd)?);
    }
    for kind in [1, 2] {
        if corners.iter().any(|corner| corner[kind] == NONE) {
            corners.iter_mut().for_each(|corner| corner[kind] = NONE);
        }
    }
    Ok(())
}

fn corner(word: &[u8], counts: Counts, odd: &mut impl FnMut(usize, &'static str, &[u8])) -> Result<Corner, Fault> {
    let mut corner = [NONE; 3];
    for (kind, text) in word.split(|&byte| byte == b'/').enumerate() {
        if kind == corner.len() {
            return Err(Fault(format!("the face corner `{}` has more than three indices", quoted(word)), REMEDY));
        }
        if text.is_empty() && kind > 0 {
            continue;
        }
        let refuse = || Fault(format!("the face corner `{}` is not made of indices", quoted(word)), REMEDY);
        let number = integer(text).ok_or_else(refuse)?;
        let [above, all] = [counts.above[kind], counts.all[kind]].map(|count| count as i64);
        if all == 0 && kind > 0 {
            odd(kind, NOTHING_TO_REFER_TO[kind], word);
            continue;
        }
        let (index, count) = if number < 0 { (above + number, above) } else { (number - 1, all) };
        if (above..all).contains(&index) {
            odd(kind, "refers to a line below it", word);
        }
        if !(0..count.min(i64::from(NONE))).contains(&index) {
            let problem = format!("the face corner `{}` refers to {} {number} of {count}", quoted(word), KINDS[kind]);
            return Err(Fault(problem, REMEDY));
        }
        corner[kind] = index as u32;
    }
    Ok(corner)
}

/// An integer of at most 18 digits; no index has more.
fn integer(text: &[u8]) -> Option<i64> {
    const MAX_DIGITS: usize = 18;
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > MAX_DIGITS {
        return None;
    }
    let mut number = 0;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        number = 10 * number + i64::from(digit - b'0');
    }
    Some(if negative { -number } else { number })
}
