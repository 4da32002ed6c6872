//! The corners of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from −1.

use super::parse::Fault;
use crate::formats::{
    text::{quoted, words},
    vertices::{Corner, NONE},
};

const KINDS: [&str; 3] = ["position", "texture coordinate", "normal"];

const REMEDY: &str = "indices count from 1, or backwards from −1; correct the face or export the file again";

/// Reads the corners up to a comment into `corners`; `counts` are those of positions, texture coordinates and normals so far. An
/// attribute that one corner lacks is removed from all.
pub(super) fn read(text: &[u8], counts: [usize; 3], corners: &mut Vec<Corner>) -> Result<(), Fault> {
    corners.clear();
    for word in words(text).take_while(|word| word[0] != b'#') {
        corners.push(corner(word, counts)?);
    }
    for kind in [1, 2] {
        if corners.iter().any(|corner| corner[kind] == NONE) {
            corners.iter_mut().for_each(|corner| corner[kind] = NONE);
        }
    }
    Ok(())
}

fn corner(word: &[u8], counts: [usize; 3]) -> Result<Corner, Fault> {
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
        let count = counts[kind] as i64;
        let index = if number < 0 { count + number } else { number - 1 };
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
    const MOST_DIGITS: usize = 18;
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > MOST_DIGITS {
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
