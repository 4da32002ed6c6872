//! Variables for the flags of `render`: LIGHTMESH_MEMORY_LIMIT for `--memory-limit`.
//!
//! An empty variable counts as none, and so does one that says no to a flag without a value: it excludes no other flag then.

use std::env;
use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue};
use clap::{Arg, ArgAction, Error};

/// What a single command asks for, or what has no value.
const NOT_FROM_VARIABLES: [&str; 5] = ["HELP", "OUTPUT", "LIGHT", "QUIET", "VERBOSE"];
/// What turns a flag without a value on, and off.
const WORDS: [[&str; 4]; 2] = [["1", "yes", "true", "on"], ["0", "no", "false", "off"]];

/// A flag that may be given by its variable.
pub(super) fn with_variable(flag: Arg) -> Arg {
    let Some(name) = flag.get_long().and_then(variable) else { return flag };
    let is_switch = matches!(flag.get_action(), ArgAction::SetTrue);
    let flag = if is_switch { flag.value_parser(is_on) } else { flag };
    let text = env::var_os(&name).map(|text| text.to_string_lossy().into_owned());
    let is_none = text.is_some_and(|text| text.is_empty() || is_switch && is_on(&text) == Ok(false));
    if is_none { flag } else { flag.env(name).hide_env(true) }
}

/// The variable of a flag, if it has one.
fn variable(long: &str) -> Option<String> {
    let name = long.replace('-', "_").to_uppercase();
    (!NOT_FROM_VARIABLES.contains(&&*name)).then(|| format!("LIGHTMESH_{name}"))
}

/// Whether a variable turns a flag without a value on.
fn is_on(text: &str) -> Result<bool, String> {
    let [on, off] = WORDS.map(|words| words.iter().any(|word| word.eq_ignore_ascii_case(text.trim())));
    let wrong = || "write 1, yes, true or on to turn it on, or 0, no, false or off".to_owned();
    (on || off).then_some(on).ok_or_else(wrong)
}

/// What the parser says of a command line, with the names of variables in place of flags that are not on it.
pub(crate) fn naming_variables(mut error: Error, arguments: &[OsString]) -> Error {
    let named = |shown: &str| variable_of(shown, arguments).unwrap_or_else(|| shown.to_owned());
    for kind in [ContextKind::InvalidArg, ContextKind::PriorArg] {
        let value = match error.get(kind) {
            Some(ContextValue::String(shown)) => ContextValue::String(named(shown)),
            Some(ContextValue::Strings(all)) => ContextValue::Strings(all.iter().map(|shown| named(shown)).collect()),
            _ => continue,
        };
        error.insert(kind, value);
    }
    error
}

/// The variable that a flag comes from, if it does. The flag may be shown with its value, as in `--size <WxH>`.
pub(crate) fn variable_of(shown: &str, arguments: &[OsString]) -> Option<String> {
    let flag = shown.split([' ', '=']).next()?;
    let name = variable(flag.strip_prefix("--")?)?;
    let is_render = arguments.iter().any(|argument| argument == "render");
    let is_typed = arguments.iter().any(|argument| {
        let argument = argument.to_string_lossy();
        argument.strip_prefix(flag).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
    });
    (is_render && !is_typed && env::var_os(&name).is_some_and(|text| !text.is_empty())).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_turn_flags_on_and_off() {
        for (text, expected) in [("1", true), ("Yes", true), ("TRUE", true), ("on", true), ("0", false), ("no", false)]
        {
            assert_eq!(is_on(text), Ok(expected), "{text}");
        }
        assert_eq!([is_on("False"), is_on(" off ")], [Ok(false), Ok(false)]);
        assert!(is_on("2").is_err() && is_on("").is_err() && is_on("nein").is_err());
    }

    #[test]
    fn some_flags_have_no_variable() {
        assert_eq!(variable("grid-file").as_deref(), Some("LIGHTMESH_GRID_FILE"));
        assert_eq!([variable("output"), variable("quiet")], [None, None]);
    }
}
