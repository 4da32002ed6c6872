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

#[cfg(test)]
mod tests {
    use crate::{Falloff, Up, Weight};

    #[test]
    fn names_are_read_and_written() {
        Weight::ALL.iter().for_each(|weight| assert_eq!(weight.to_string().parse(), Ok(*weight)));
        Falloff::ALL.iter().for_each(|falloff| assert_eq!(falloff.to_string().parse(), Ok(*falloff)));
        Up::ALL.iter().for_each(|up| assert_eq!(up.to_string().parse(), Ok(*up)));
        assert_eq!(format!("[{:>9}]", Weight::Smooth), "[   smooth]");
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_known() {
        let message = "soft".parse::<Weight>().unwrap_err().to_string();
        assert_eq!(message, "there is no weight `soft`; available: constant, quadratic, smooth");
        assert!("Smooth".parse::<Weight>().is_err() && "".parse::<Falloff>().is_err());
    }
}
