//! Errors that name settings: they tell what is wrong in the words of a face.

use crate::words::Words;

/// An error whose message names settings. `Display` names them as fields.
pub trait Told: std::error::Error {
    /// The message in the words of a face.
    fn told(&self, words: Words) -> String;
}

/// `Display` by the names of fields.
macro_rules! display_by_fields {
    ($($type:ty),*) => {
        $(impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(&$crate::told::Told::told(self, $crate::words::Words::Fields))
            }
        })*
    };
}

pub(crate) use display_by_fields;
