//! Choices with names: the words that stand for them in a file, on a command line or in print.
//!
//! Such an enum has a table `ALL`, and for each of its values a `name()` and a short description `help()`;
//! [`parse_by_name!`](crate::parse_by_name) adds `Display` and `FromStr`.

/// An unknown name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} `{name}`; available: {}", known.join(", "))]
pub struct UnknownName {
    /// What was looked up: "mode", "weight".
    pub what: &'static str,
    /// The word.
    pub name: String,
    /// All names.
    pub known: Vec<&'static str>,
}

/// `Display` and `FromStr` by the names in `ALL`.
#[doc(hidden)]
#[macro_export]
macro_rules! parse_by_name {
    ($type:ty, $what:literal) => {
        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::UnknownName;

            fn from_str(name: &str) -> Result<$type, $crate::UnknownName> {
                let found = Self::ALL.iter().find(|choice| choice.name() == name).cloned();
                found.ok_or_else(|| $crate::UnknownName {
                    what: $what,
                    name: name.to_owned(),
                    known: Self::ALL.iter().map(|choice| choice.name()).collect(),
                })
            }
        }
    };
}
