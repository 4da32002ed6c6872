//! Text from files and file names, made safe to show.

use std::borrow::Cow;

/// The text with every character escaped that would not be seen, or would control a terminal or a plain-text file: control characters
/// with line ends, line separators, and characters that are invisible or change the direction of others. `\n`, `\u{1b}`, `\u{202e}`
/// stand for them; backslashes stay single.
///
/// ```
/// use lightmesh_files::visible;
///
/// assert_eq!(visible("red \u{1b}[31m, büro\n"), r"red \u{1b}[31m, büro\n");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |c| if c.is_control() { c.escape_debug().collect() } else { c.escape_unicode().collect() })
}

/// [`visible`] for each line of a text; its line feeds stay.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| if c == '\n' { "\n".to_owned() } else { visible(c.encode_utf8(&mut [0; 4])).into_owned() })
}

/// JSON with the same meaning, in which no such character is left. Outside of its strings, JSON has only line feeds of them.
pub fn visible_json(text: &str) -> Cow<'_, str> {
    escaped(text, |c| match c {
        '\n' => "\n".to_owned(),
        c => c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect(),
    })
}

fn escaped(text: &str, escape: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_unseen) {
        return text.into();
    }
    let mut seen = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unseen(c) { seen += &escape(c) } else { seen.push(c) }
    }
    seen.into()
}

/// Control characters, line and paragraph separators, interlinear annotations, and what has the property
/// `Default_Ignorable_Code_Point` (Unicode 16, `DerivedCoreProperties.txt`): joiners, fillers, directions, selectors, tags.
fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}'..='\u{1160}' | '\u{17b4}'..='\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
            | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}'
            | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ESC, BEL, CR, DEL, C1's CSI, soft hyphen, directions, joiners, line separators, a byte order mark, a tag.
    const UNSEEN: &str = "\u{1b}\u{7}\r\0\u{7f}\u{9b}\u{ad}\u{200b}\u{200d}\u{202e}\u{2066}\u{2028}\u{2029}\u{feff}\u{fe0f}\u{3164}\u{e0041}";

    #[test]
    fn nothing_unseen_is_left() {
        assert!(UNSEEN.chars().all(is_unseen));
        assert_eq!(
            visible(UNSEEN),
            r"\u{1b}\u{7}\r\0\u{7f}\u{9b}\u{ad}\u{200b}\u{200d}\u{202e}\u{2066}\u{2028}\u{2029}\u{feff}\u{fe0f}\u{3164}\u{e0041}"
        );
        assert_eq!(visible("a\nb\tc"), r"a\nb\tc");
    }

    #[test]
    fn what_is_seen_stays() {
        for text in ["büro", "bu\u{308}ro", "日本 \u{a0}", r"C:\new `a` 'b' \u{1b}", "αβγ עברית"] {
            assert!(matches!(visible(text), Cow::Borrowed(same) if same == text), "{text}");
        }
    }

    #[test]
    fn lines_stay_lines_and_json_stays_json() {
        assert_eq!(visible_lines("a\u{202e}\nb\r\n"), "a\\u{202e}\nb\\r\n");
        assert_eq!(visible_json("{\n\"a\": \"\u{9b}\u{e0041}\\n\"\n}"), "{\n\"a\": \"\\u009b\\udb40\\udc41\\n\"\n}");
    }
}
