//! Quotations from files in messages: seen, and short. A file that is read by mistake must not be told by its error.

use lightmesh_files::visible;

/// Maximum number of characters of a word that is not what is expected.
const QUOTED: usize = 24;
/// Maximum number of characters of a name.
const NAME: usize = 64;
/// Maximum number of names in a list; a table of scene files has fewer keys.
const LISTED: usize = 20;
/// Maximum number of characters of a reference, and between the quotations in another library's message.
const MESSAGE: usize = 200;

/// The beginning of a text from a file.
pub(crate) fn quote(text: &str) -> String {
    cut(text.trim(), QUOTED)
}

/// The name of something in a file.
pub(crate) fn name(text: &str) -> String {
    cut(text, NAME)
}

/// A path or address from a file.
pub(crate) fn reference(name: &str) -> String {
    cut(name, MESSAGE)
}

/// Names from a file: the first few, and how many more there are.
pub(crate) fn list<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let more = names.len().saturating_sub(LISTED);
    let shown = names.take(LISTED).map(name).collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

/// Another library's message, with what it quotes from the file cut.
pub(crate) fn abridged(message: &str) -> String {
    let marks = ['`', '"'];
    let pieces = message.split_inclusive(marks).enumerate().map(|(index, piece)| {
        let text = piece.trim_end_matches(marks);
        cut(text, if index % 2 == 1 { QUOTED } else { MESSAGE }) + &piece[text.len()..]
    });
    cut(&pieces.collect::<String>(), 2 * MESSAGE)
}

fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => visible(&text[..end]).into_owned() + "…",
        None => visible(text).into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotations_are_short_and_seen() {
        assert_eq!(quote(" oak\n"), "oak");
        assert_eq!(quote("a\u{1b}[31m\u{202e}"), r"a\u{1b}[31m\u{202e}");
        assert_eq!(quote(&"ü".repeat(1000)), "ü".repeat(QUOTED) + "…");
    }

    #[test]
    fn lists_are_short() {
        let names: Vec<String> = (0..1_000_000).map(|name| name.to_string()).collect();
        assert_eq!(
            list(names.iter().map(String::as_str)),
            "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19 and 999980 more"
        );
        assert_eq!(list(["a", "b"].into_iter()), "a, b");
    }

    #[test]
    fn messages_of_others_quote_as_little() {
        let long = "secret ".repeat(100);
        let message = abridged(&format!("invalid type: string \"{long}\", expected u32 at line 1"));
        assert_eq!(message, "invalid type: string \"secret secret secret sec…\", expected u32 at line 1");
        assert_eq!(abridged("expected `,` or `]`"), "expected `,` or `]`");
        assert!(abridged(&format!("{long}{long}")).chars().count() <= MESSAGE + 1);
        assert!(abridged(&"\"a".repeat(1000)).chars().count() <= 2 * MESSAGE + 1);
    }
}
