//! Quotations from files in messages: seen, and short. A file that is read by mistake must not be told by its error.

use lightmesh_files::visible;

/// Maximum number of characters of a word that is not what is expected.
pub const QUOTED: usize = 24;
/// Maximum number of characters of a name.
const NAME: usize = 64;
/// Maximum number of names in a list; a table of scene files has fewer keys.
const LISTED: usize = 20;
/// Maximum number of characters of a reference, and between the quotations in another library's message.
pub const MESSAGE: usize = 200;

/// The beginning of a text from a file.
pub fn quote(text: &str) -> String {
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
pub fn list<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let more = names.len().saturating_sub(LISTED);
    let shown = names.take(LISTED).map(name).collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

/// Another library's message, with what it quotes from the file cut.
pub fn abridged(message: &str) -> String {
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
