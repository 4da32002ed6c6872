//! Kernels must not repeat numbers shared with the host: those are in `crates/layout/src/constants.rs`, and thus in the header.
//!
//! Possible copies are rejected, unless they are listed here with the reason why only kernels use them:
//!
//! * a macro for a number;
//! * a number of more than three digits, or with an exponent;
//! * a number of threads in `KERNEL` that is not a name.

use std::collections::BTreeSet;
use std::error::Error;
use std::fs;
use std::path::Path;

use super::sources::{LAYOUT, sources_under};

/// Macros and numbers that only kernels use, and why.
const ALLOWED: [(&str, &str); 35] = [
    ("0x7ff0000000000000ll", "the bits of a double's exponent; Rust has functions for them"),
    ("ALPHA_TEST", "the host chooses the module that was compiled with it"),
    ("INSTANCES", "modules without it are for scenes without instances; the host chooses"),
    ("WALKS_bvh", "which structures a module walks; the host chooses the module"),
    ("WALKS_grid", "which structures a module walks; the host chooses the module"),
    ("WALKS_brute_force", "which structures a module walks; the host chooses the module"),
    ("PLANE_BIAS", "a byte is converted to a float by adding to its bits; the host casts"),
    ("PLANE_BIAS_BITS", "the bits of PLANE_BIAS"),
    ("2304.0f", "the 256 steps of a node's frame and the error of PLANE_BIAS"),
    ("0x01010101u", "the lowest bits of four bytes processed at once"),
    ("0x1f1f1f1fu", "the lower five bits of such bytes"),
    ("0x07070707u", "the lower three bits of such bytes"),
    ("GRID_MAX_CELLS", "the range of this traversal; the host's has different bounds"),
    ("WHOLE_FLOATS", "a float is converted to an integer by an addition; the host casts"),
    ("WHOLE_FLOATS_BITS", "the bits of WHOLE_FLOATS"),
    ("ALL_LANES", "an argument of CUDA's warp functions"),
    ("0xffff0000u", "lanes are exchanged between halves of a warp"),
    ("0xffff", "two 16-bit numbers in a word; Rust casts"),
    ("NO_POINT", "sorts threads without a surface point last"),
    ("FLAT", "a bundle without curved surfaces skips what the host does for each point"),
    ("NO_CANDIDATE", "an empty place of a list that lanes share"),
    ("NO_TARGET", "ends a list in shared memory"),
    ("0x80000000u", "more bricks than fit into any table: it is full"),
    ("UNKNOWN", "passed from one kernel to the next"),
    ("3.4e38f", "initial value of a minimum or maximum over a warp"),
    ("1e20f", "the largest stretch of a shadow; infinite on the host, where it is not multiplied"),
    ("1e-20f", "its reciprocal"),
    ("1e30f", "larger than the stretch of any shadow"),
    ("ROUND_COST", "what steps of occluder lists cost on a device; the host has its own"),
    ("CHOICE_COST", "what steps of occluder lists cost on a device; the host has its own"),
    ("CANDIDATE_COST", "what steps of occluder lists cost on a device; the host has its own"),
    ("ROW_COST", "what steps of occluder lists cost on a device; the host has its own"),
    ("RAY_COST", "what steps of occluder lists cost on a device; the host has its own"),
    ("MIN_COST_RATIO", "what steps of occluder lists cost on a device; the host has its own"),
    ("1.000001f", "rounding of products that only occur in this search"),
];

/// Possible copies in the kernel sources under some folders, a line each; and unused entries of the list.
pub(super) fn find(folders: &[&Path]) -> Result<Vec<String>, Box<dyn Error>> {
    let mut problems = Vec::new();
    let mut met = BTreeSet::new();
    let mut sources = Vec::new();
    for folder in folders {
        sources.extend(sources_under(folder, &["cu", "cuh"])?);
    }
    for path in sources {
        if !path.ends_with(LAYOUT) {
            for (line, what) in suspects(&fs::read_to_string(&path)?) {
                if !met_in_list(&what, &mut met) {
                    problems.push(format!(
                        "{}:{line}: {what} looks like a copy; declare it in crates/layout/src/constants.rs, or, if only kernels \
                         use it, list it in xtask/src/kernels/copies.rs",
                        path.display()
                    ));
                }
            }
        }
    }
    let unmet = ALLOWED.iter().map(|(what, _)| *what).filter(|what| !met.contains(what));
    problems.extend(unmet.map(|what| format!("xtask/src/kernels/copies.rs: no kernel contains {what} anymore")));
    Ok(problems)
}

/// Whether something is listed; if so, it is recorded as used.
fn met_in_list(what: &str, met: &mut BTreeSet<&'static str>) -> bool {
    let entry = ALLOWED.iter().find(|(allowed, _)| *allowed == what);
    entry.is_some_and(|(allowed, _)| {
        met.insert(allowed);
        true
    })
}

/// All possible copies in a source, with their lines.
fn suspects(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        // Text in quotation marks is not code.
        let code: String = code.split('"').step_by(2).collect();
        match macro_of_number(&code) {
            Some(name) => found.push((index + 1, name.to_owned())),
            None => found
                .extend(words(&code).into_iter().filter(|word| is_long(word)).map(|word| (index + 1, word.to_owned()))),
        }
        found.extend(threads_of_kernel(&code).map(|threads| (index + 1, format!("KERNEL of {threads} threads"))));
    }
    found
}

/// The name of a macro that consists only of numbers.
fn macro_of_number(code: &str) -> Option<&str> {
    let (name, value) = code.strip_prefix("#define ")?.split_once(' ')?;
    let parts = words(value);
    (!parts.is_empty() && !name.contains('(') && parts.into_iter().all(is_number)).then_some(name)
}

/// A kernel's number of threads, if it is not a name.
fn threads_of_kernel(code: &str) -> Option<&str> {
    let threads = code.strip_prefix("KERNEL")?.split(',').nth(2)?.trim();
    is_number(threads).then_some(threads)
}

/// Names and numbers.
fn words(code: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_part) {
        let (word, after) = rest[start..].split_at(length_of_word(&rest[start..]));
        found.push(word);
        rest = after;
    }
    found
}

/// Length of the first word of a text in bytes. The sign of an exponent belongs to its number.
fn length_of_word(text: &str) -> usize {
    let mut last = ' ';
    let ends = |c: char| {
        let signed = is_number(text) && matches!(c, '+' | '-') && matches!(last, 'e' | 'E' | 'p' | 'P');
        last = c;
        !is_part(c) && !signed
    };
    text.find(ends).unwrap_or(text.len())
}

fn is_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '.'
}

fn is_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether a word is a number of more than three digits, or with an exponent.
fn is_long(word: &str) -> bool {
    if !is_number(word) {
        return false;
    }
    let word = word.to_ascii_lowercase();
    let (digits, exponent) = match word.strip_prefix("0x") {
        Some(hexadecimal) => (hexadecimal.trim_end_matches(['u', 'l']), 'p'),
        None => (word.trim_end_matches(['u', 'l', 'f']), 'e'),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    whole.len() + fraction.trim_end_matches('0').len() > 3 || digits.contains(exponent)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::kernels::sources::SOURCES;

    fn whats(text: &str) -> Vec<String> {
        suspects(text).into_iter().map(|(_, what)| what).collect()
    }

    #[test]
    fn copies_are_found() {
        let text = "#define SHARDS 64\n#define MARGIN (1.0f / (1u << 19))\nx * 0x9e3779b97f4a7c15ull; y < 1e-12f || y > 0.1234f\n";
        assert_eq!(whats(text), ["SHARDS", "MARGIN", "0x9e3779b97f4a7c15ull", "1e-12f", "0.1234f"]);
        assert_eq!(
            whats("CONSTANT(Row, rows, [1024])\nKERNEL(name, Record, 256, 4) {"),
            ["1024", "KERNEL of 256 threads"]
        );
        assert_eq!(suspects("a\n\nb + 4096")[0].0, 3);
    }

    #[test]
    fn other_code_is_left_alone() {
        let text = "// 1024 pixels\n#define ALL(x) x\n#define INFINITE __uint_as_float(BITS)\nasm(\"dp4a.u32.u32 %0, 123456\");\n\
                    KERNEL(name, Record, BLOCK, 4) { return 0.5f * 256.0f + (x & 255) + 0xffu + 1.0f; }\n";
        assert_eq!(whats(text), [""; 0]);
    }

    #[test]
    fn the_kernels_have_none() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let sources = SOURCES.map(|folder| root.join(folder));
        assert_eq!(find(&sources.each_ref().map(PathBuf::as_path)).unwrap(), [""; 0]);
    }
}
