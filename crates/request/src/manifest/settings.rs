//! The settings that decide the bytes of frames, with their values.
//!
//! Not among them are those of the machine (device, threads, memory, acceleration structure, short tests: the same bytes by other ways), and of the
//! part of the film; the table of settings says which.

use std::collections::BTreeMap;

use crate::request::{FIELDS, Request};
use crate::words::Name;

/// What messages call the value of a setting that is not given.
const NONE: &str = "not given";

/// Their values by name, as they are typed.
pub(super) fn of(request: &Request) -> BTreeMap<String, String> {
    let decisive = FIELDS.iter().filter(|field| field.decides_bytes);
    decisive
        .map(|field| {
            let texts = field.texts(request);
            (field.name.to_owned(), if texts.is_empty() { NONE.to_owned() } else { texts.join(" ") })
        })
        .collect()
}

/// A setting that differs, with its values.
pub(super) fn difference(
    was: &BTreeMap<String, String>,
    is: &BTreeMap<String, String>,
) -> Option<(Name, String, String)> {
    let value = |of: &BTreeMap<String, String>, name| of.get(name).cloned().unwrap_or_else(|| NONE.to_owned());
    let both = |name: Name| (name, value(was, name), value(is, name));
    FIELDS.iter().map(|field| both(field.name)).find(|(_, was, is)| was != is)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_differs_is_seen() {
        let (mut a, mut b) = (Request::default(), Request::default());
        assert_eq!(difference(&of(&a), &of(&b)), None);
        a.set("threads", 1).unwrap();
        b.set("device", "cpu").unwrap();
        assert_eq!(difference(&of(&a), &of(&b)), None);
        b.set("seed", 2).unwrap();
        assert_eq!(difference(&of(&a), &of(&b)), Some(("seed", "0".to_owned(), "2".to_owned())));
        a.set("seed", 2).unwrap();
        a.set("step", 0.5).unwrap();
        assert_eq!(difference(&of(&a), &of(&b)), Some(("step", "0.5".to_owned(), NONE.to_owned())));
    }

    #[test]
    fn ways_to_the_same_bytes_do_not_count() {
        let settings = of(&Request::default());
        for name in
            ["device", "threads", "accel", "grid_file", "short_tests", "memory_limit", "frames", "resume", "partial"]
        {
            assert!(!settings.contains_key(name), "{name}");
        }
        for name in ["size", "seed", "turntable", "sun", "smooth", "exposure", "view", "light", "scene_format"] {
            assert!(settings.contains_key(name), "{name}");
        }
    }
}
