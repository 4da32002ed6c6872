//! The images that a statement is about: their settings as text.

use super::layouts::key_text;
use super::runs::{Measured, distinct};
use crate::Key;

/// Settings of an image with the method, with the prefix of their values.
const SETTINGS: [(&str, &str); 6] = [
    ("size", "size "),
    ("step", "h = "),
    ("radius", "R = "),
    ("weight", "weight "),
    ("lookup", "lookup "),
    ("emitter", "lights as "),
];

/// The values of an image's settings.
type Values<'a> = [Option<&'a Key>; SETTINGS.len()];

/// The settings of `part`, a subset of `all`. Values of a setting are listed together if that is accurate, that is, if none of
/// the other images has a combination of them; otherwise image by image, by the settings in which they differ.
pub(crate) fn text(part: &[Measured], all: &[Measured]) -> String {
    let wanted = distinct(part.iter().map(values));
    let others = all.iter().map(values).filter(|values| !wanted.contains(values));
    let lists: Vec<Vec<Option<&Key>>> =
        (0..SETTINGS.len()).map(|setting| sorted(wanted.iter().map(|values| values[setting]))).collect();
    let fits = |values: Values| values.iter().zip(&lists).all(|(value, list)| list.contains(value));
    if !others.into_iter().any(fits) {
        return phrase(&lists);
    }
    let differs = |setting: usize| all.iter().any(|row| values(row)[setting] != wanted[0][setting]);
    let phrases = wanted.iter().map(|values| {
        let list = |setting: usize| if differs(setting) { vec![values[setting]] } else { Vec::new() };
        phrase(&(0..SETTINGS.len()).map(list).collect::<Vec<_>>())
    });
    phrases.collect::<Vec<_>>().join("; ")
}

/// Settings that are present, with their values.
fn phrase(lists: &[Vec<Option<&Key>>]) -> String {
    let parts = SETTINGS.iter().zip(lists).filter_map(|((_, before), list)| {
        let values: Vec<String> = list.iter().flatten().map(|key| key_text(key)).collect();
        (!values.is_empty()).then(|| format!("{before}{}", enumerated(&values)))
    });
    parts.collect::<Vec<_>>().join(", ")
}

/// Joins words with commas and a final "and".
pub(crate) fn enumerated(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [word] => word.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn values<'a>(row: &Measured<'a>) -> Values<'a> {
    SETTINGS.map(|(name, _)| row.key(name))
}

/// Each value once, in order.
fn sorted<'a>(keys: impl Iterator<Item = Option<&'a Key>>) -> Vec<Option<&'a Key>> {
    let mut keys = distinct(keys);
    keys.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Row;

    #[test]
    fn pictures_are_listed_together_where_that_is_true_alone() {
        let results = crate::report::tests::results("thesis", |rows| {
            for (step, radius) in [(0.1, 2.1), (0.1, 3.1), (0.05, 2.1), (0.05, 3.1)] {
                rows.push(Row::new("t", [("step", step.into()), ("radius", radius.into()), ("size", 512.0.into())]));
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let all = runs.rows("t");
        assert_eq!(text(&all, &all), "size 512, h = 0.05 and 0.1, R = 2.1 and 3.1");
        assert_eq!(text(&all[..2], &all), "size 512, h = 0.1, R = 2.1 and 3.1");
        assert_eq!(text(&[all[0], all[3]], &all), "h = 0.1, R = 2.1; h = 0.05, R = 3.1");
        assert_eq!(text(&[all[0], all[3]], &[all[0], all[3]]), "size 512, h = 0.05 and 0.1, R = 2.1 and 3.1");
    }
}
