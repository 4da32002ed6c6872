//! Integers that are written as floats, such as `"count": 24.0`, by programs for which all numbers are alike. JSON Schema, by which
//! glTF is defined, calls them integers as well.

use std::ops::Range;

/// Integers up to here have one form as `f64`.
const LARGEST: f64 = (1u64 << 53) as f64;

/// The same JSON with all whole numbers as integers, in their places where they fit there: floats may be written as integers, so
/// this changes nothing else. `-0.0` stays, as there is no such integer.
pub fn as_integers(json: &[u8]) -> Vec<u8> {
    let mut text = Vec::with_capacity(json.len());
    let mut rest = 0;
    while rest < json.len() {
        let token = token(json, rest);
        rest = token.end;
        let token = &json[token];
        match whole(token) {
            Some(number) => {
                let start = text.len();
                text.extend_from_slice(number.to_string().as_bytes());
                // Errors name the same places as before.
                text.resize(text.len().max(start + token.len()), b' ');
            }
            None => text.extend_from_slice(token),
        }
    }
    text
}

/// A string, what may be a number, or another byte.
fn token(json: &[u8], start: usize) -> Range<usize> {
    let rest = &json[start..];
    let length = match rest[0] {
        b'"' => string(rest),
        b'-' | b'0'..=b'9' => {
            let of_number = |byte: &u8| matches!(byte, b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9');
            rest.iter().position(|byte| !of_number(byte)).unwrap_or(rest.len())
        }
        _ => 1,
    };
    start..start + length
}

/// The length of the string at the beginning, with its quotes.
fn string(rest: &[u8]) -> usize {
    let mut escaped = false;
    let end = rest[1..].iter().position(|&byte| {
        let ends = byte == b'"' && !escaped;
        escaped = byte == b'\\' && !escaped;
        ends
    });
    end.map_or(rest.len(), |end| end + 2)
}

/// A float that is an integer.
fn whole(token: &[u8]) -> Option<i64> {
    if !token.iter().any(|byte| matches!(byte, b'.' | b'e' | b'E')) {
        return None;
    }
    let number: f64 = serde_json::from_slice(token).ok()?;
    let is_whole = number.fract() == 0.0 && number.abs() <= LARGEST && !(number == 0.0 && number.is_sign_negative());
    is_whole.then_some(number as i64)
}
