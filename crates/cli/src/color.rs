//! Colours of messages: whether a stream gets them, and which words have which.
//!
//! In this order: `--color always` and `never`; `NO_COLOR`; `CLICOLOR_FORCE`; `CLICOLOR=0`; whether the stream is a
//! terminal that knows them. See <https://no-color.org> and <https://bixense.com/clicolors>.

use std::borrow::Cow;
use std::ffi::{OsStr, OsString};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU8, Ordering};

use clap::ValueEnum;
use clap::builder::Styles;
use clap::builder::styling::{AnsiColor, Style};
use serde::{Deserialize, Serialize};

/// The flag.
const FLAG: &str = "--color";

/// When messages have colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[repr(u8)]
pub(crate) enum When {
    /// On a terminal, unless NO_COLOR, CLICOLOR or CLICOLOR_FORCE decides
    #[default]
    Auto,
    /// Everywhere
    Always,
    /// Nowhere
    Never,
}

static WHEN: AtomicU8 = AtomicU8::new(When::Auto as u8);

/// Colours from now on.
pub(crate) fn set(when: When) {
    WHEN.store(when as u8, Ordering::Relaxed);
}

/// What the arguments say, for messages on arguments that cannot be parsed.
pub(crate) fn asked(arguments: impl IntoIterator<Item = OsString>) -> When {
    let mut arguments = arguments.into_iter().take_while(|argument| argument != "--");
    let mut when = When::Auto;
    while let Some(argument) = arguments.next() {
        let Some(rest) = argument.to_str().and_then(|argument| argument.strip_prefix(FLAG)) else { continue };
        let value = match rest.strip_prefix('=') {
            Some(value) => value.to_owned(),
            None if rest.is_empty() => arguments.next().and_then(|value| value.into_string().ok()).unwrap_or_default(),
            None => continue,
        };
        when = When::from_str(&value, false).unwrap_or(when);
    }
    when
}

/// What was [set].
pub(crate) fn when() -> When {
    match WHEN.load(Ordering::Relaxed) {
        when if when == When::Always as u8 => When::Always,
        when if when == When::Never as u8 => When::Never,
        _ => When::Auto,
    }
}

/// Whether a stream gets colours.
pub(crate) fn on(stream: &impl IsTerminal) -> bool {
    decided(when(), |name| std::env::var_os(name), stream.is_terminal())
}

fn decided(when: When, variable: impl Fn(&str) -> Option<OsString>, is_terminal: bool) -> bool {
    let is = |name, value: &str| variable(name).is_some_and(|found| found == OsStr::new(value));
    let is_set = |name| variable(name).is_some_and(|value| !value.is_empty());
    match when {
        When::Always => true,
        When::Never => false,
        When::Auto if is_set("NO_COLOR") => false,
        When::Auto if is_set("CLICOLOR_FORCE") && !is("CLICOLOR_FORCE", "0") => true,
        When::Auto => is_terminal && !is("CLICOLOR", "0") && knows_colors(variable),
    }
}

/// Consoles of Windows that know escape sequences say who they are.
fn knows_colors(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    match variable("TERM") {
        Some(terminal) => terminal != OsStr::new("dumb"),
        None => cfg!(windows) && variable("WT_SESSION").is_some(),
    }
}

/// A message whose first word says what it is, in that word's colour: that of clap's errors, too.
pub(crate) fn painted<'a>(line: Cow<'a, str>, stream: &impl IsTerminal) -> Cow<'a, str> {
    let colored = || {
        let (word, style) = words().into_iter().find(|(word, _)| line.starts_with(word))?;
        Some(format!("{style}{word}{style:#}{}", &line[word.len()..]))
    };
    match on(stream).then(colored).flatten() {
        Some(colored) => Cow::Owned(colored),
        None => line,
    }
}

fn words() -> [(&'static str, Style); 3] {
    let warning = AnsiColor::Yellow.on_default().bold();
    [("error:", *Styles::styled().get_error()), ("warning:", warning), ("interrupted:", warning)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auto(variables: &[(&str, &str)], is_terminal: bool) -> bool {
        let variable = |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| value.into());
        decided(When::Auto, variable, is_terminal)
    }

    #[test]
    fn terminals_have_colors_and_files_have_none() {
        let term = ("TERM", "xterm");
        assert!(auto(&[term], true) && !auto(&[term], false));
        assert!(!auto(&[("TERM", "dumb")], true) && !auto(&[term, ("CLICOLOR", "0")], true));
    }

    #[test]
    fn variables_and_the_flag_decide_in_their_order() {
        let (term, no, force) = (("TERM", "xterm"), ("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1"));
        assert!(!auto(&[term, no], true) && auto(&[force], false) && !auto(&[no, force], true));
        assert!(auto(&[term, ("NO_COLOR", "")], true) && !auto(&[("CLICOLOR_FORCE", "0")], false));
        assert!(decided(When::Always, |_| Some("1".into()), false));
        assert!(!decided(When::Never, |_| Some("xterm".into()), true));
    }

    #[test]
    fn the_flag_is_found_among_arguments_that_are_wrong() {
        let asked = |line: &str| asked(line.split(' ').map(OsString::from));
        assert_eq!(asked("render --sise 3 --color always"), When::Always);
        assert_eq!(asked("--color=never render --colors always"), When::Never);
        assert_eq!(asked("render -- --color always"), When::Auto);
        assert_eq!((asked("render --color"), asked("render --color=blue")), (When::Auto, When::Auto));
    }
}
