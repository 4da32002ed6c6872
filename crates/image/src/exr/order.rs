//! The order of attributes. The `exr` crate writes those without a field of their own in an order that changes from run to run; here the
//! attributes of each header are sorted by name, so that equal images are equal files.
//!
//! A header is a sequence of attributes: name and type, each ended by a zero, the value's length and the value (OpenEXR File Layout,
//! "Header"). It is ended by a zero. In front of the first are eight bytes: magic number and version.

use std::cell::Cell;
use std::io::{self, Seek, SeekFrom, Write};

const PREFIX: usize = 8;

/// Writes to another output, as soon as it is told that all headers have been written; until then it keeps the bytes.
pub struct Sorted<'a, W> {
    /// Where they go.
    pub output: W,
    /// Whether all headers have been written.
    complete: &'a Cell<bool>,
    headers: usize,
    kept: Option<Vec<u8>>,
}

impl<'a, W: Write> Sorted<'a, W> {
    /// For a file with `headers` headers.
    pub fn new(output: W, headers: usize, complete: &'a Cell<bool>) -> Sorted<'a, W> {
        Sorted { output, complete, headers, kept: Some(Vec::new()) }
    }

    /// Writes what was kept, once that is complete.
    fn release(&mut self) -> io::Result<()> {
        if self.complete.get()
            && let Some(mut kept) = self.kept.take()
        {
            if sort(&mut kept, self.headers).is_none() {
                return Err(io::Error::other("the headers of the file are damaged"));
            }
            self.output.write_all(&kept)?;
        }
        Ok(())
    }
}

impl<W: Write> Write for Sorted<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.release()?;
        match &mut self.kept {
            Some(kept) => {
                kept.extend(bytes);
                Ok(bytes.len())
            }
            None => self.output.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.release()?;
        self.output.flush()
    }
}

impl<W: Write + Seek> Seek for Sorted<'_, W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.release()?;
        self.output.seek(to)
    }
}

/// Sorts the attributes of the first `headers` headers; `None` if there are not as many.
pub fn sort(bytes: &mut [u8], headers: usize) -> Option<()> {
    let mut start = PREFIX;
    for _ in 0..headers {
        let mut attributes = Vec::new();
        let mut at = start;
        while *bytes.get(at)? != 0 {
            let end = end_of_attribute(bytes, at)?;
            attributes.push(bytes.get(at..end)?.to_vec());
            at = end;
        }
        // Up to the zero after the name.
        attributes.sort_by(|a, b| name(a).cmp(name(b)));
        bytes[start..at].copy_from_slice(&attributes.concat());
        start = at + 1;
    }
    Some(())
}

fn name(attribute: &[u8]) -> &[u8] {
    attribute.split(|&byte| byte == 0).next().unwrap_or_default()
}

fn end_of_attribute(bytes: &[u8], start: usize) -> Option<usize> {
    let end_of_text = |start: usize| Some(start + bytes.get(start..)?.iter().position(|&byte| byte == 0)? + 1);
    let length = end_of_text(end_of_text(start)?)?;
    let value = length.checked_add(4)?;
    let bytes = u32::from_le_bytes(bytes.get(length..value)?.try_into().ok()?);
    value.checked_add(bytes as usize)
}
