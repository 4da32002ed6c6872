//! The lines of OBJ and MTL files: a backslash at the end joins a line to the next.

use memchr::memchr;

/// Iterates over the lines.
pub struct Lines<'a> {
    rest: &'a [u8],
    joined: Vec<u8>,
    /// Number of lines read so far: the number of the last one.
    number: usize,
}

impl<'a> Lines<'a> {
    /// From the start of a file.
    pub fn new(text: &'a [u8]) -> Lines<'a> {
        Lines { rest: text, joined: Vec::new(), number: 0 }
    }

    /// The next line with its number, and with its continuation lines, trimmed; `None` at the end. Comments are never
    /// continued, because their authors do not expect that of a path in them.
    pub fn next_line(&mut self) -> Option<(usize, &[u8])> {
        let line = self.take()?;
        let Some(begun) = continued(line) else { return Some((self.number, line)) };
        self.joined.clear();
        self.joined.extend(begun);
        while let Some(line) = self.take() {
            self.joined.push(b' ');
            match continued(line) {
                Some(more) => self.joined.extend(more),
                None => {
                    self.joined.extend(line);
                    break;
                }
            }
        }
        Some((self.number, self.joined.trim_ascii()))
    }

    fn take(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr(b'\n', self.rest).unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = self.rest.get(end + 1..).unwrap_or_default();
        self.number += 1;
        Some(line.trim_ascii())
    }
}

/// The line without its backslash, if it continues on the next line.
fn continued(line: &[u8]) -> Option<&[u8]> {
    line.strip_suffix(b"\\").filter(|line| !line.starts_with(b"#"))
}
