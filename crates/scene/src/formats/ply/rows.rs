//! The rows after a PLY header, number by number.

use memchr::memchr2;

use super::header::{Element, Encoding, Header, Shape, Type};
use crate::formats::text::{number, odd_number, quoted, words};

/// Why a row cannot be read.
#[derive(Debug, PartialEq)]
pub(super) enum Fault {
    /// The file ends within it.
    Ended,
    /// This was found in place of a number.
    NoNumber(String),
    /// A list with an impossible number of items.
    NoCount(f64),
}

/// One row: a number for each property, and the items of one list.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// By property; the number of items for a list.
    pub(super) values: Vec<f64>,
    /// Items of the requested list.
    pub(super) list: Vec<f64>,
}

/// A position among the rows.
pub(super) struct Rows<'a> {
    bytes: &'a [u8],
    /// Offset of the next byte.
    pub(super) at: usize,
    encoding: Encoding,
    header: &'a Header,
    /// Whether each row of an ASCII file has a line of its own, and more than that, once that matters.
    has_surplus: Option<bool>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &'a Header) -> Rows<'a> {
        Rows { bytes, at: header.length, encoding: header.encoding, header, has_surplus: None }
    }

    /// Maximum number of rows of `element` that the rest of the file can contain.
    pub(super) fn room(&self, element: &Element) -> u64 {
        // The last row of an ASCII file need not be terminated.
        let rest = (self.bytes.len() - self.at) as u64 + u64::from(self.encoding == Encoding::Ascii);
        rest.checked_div(element.least_row(self.encoding)).unwrap_or(u64::MAX)
    }

    /// Reads the next row of `element` and, of its lists, the items of property number `list`.
    pub(super) fn read(&mut self, element: &Element, list: Option<usize>, row: &mut Row) -> Result<(), Fault> {
        row.values.clear();
        row.list.clear();
        for (index, property) in element.properties.iter().enumerate() {
            let value = match property.shape {
                Shape::One(of) => self.value(of)?,
                Shape::List(count, item) => {
                    let count = self.count(count, item)?;
                    if list == Some(index) {
                        for _ in 0..count {
                            row.list.push(self.value(item)?);
                        }
                    } else {
                        self.skip(count, item)?;
                    }
                    count as f64
                }
            };
            row.values.push(value);
        }
        Ok(())
    }

    /// Skips what follows a row on its line in an ASCII file, and returns its first word; unless the rows are broken into lines in
    /// another way, and that is the next row.
    pub(super) fn surplus(&mut self) -> Option<&'a [u8]> {
        if self.encoding != Encoding::Ascii {
            return None;
        }
        let rest = &self.bytes[self.at..];
        let line = &rest[..memchr2(b'\n', b'\r', rest).unwrap_or(rest.len())];
        let word = words(line).next()?;
        if self.has_surplus.is_none() {
            self.has_surplus = Some(!self.is_complete_without_lines() && self.has_line_for_each_row());
        }
        self.at += if self.has_surplus == Some(true) { line.len() } else { return None };
        Some(word)
    }

    /// Whether all rows, read one after another wherever lines end, take all words of the file.
    fn is_complete_without_lines(&self) -> bool {
        let mut rows = Rows::new(self.bytes, self.header);
        let mut row = Row::default();
        self.elements_with_rows().all(|element| (0..element.count).all(|_| rows.read(element, None, &mut row).is_ok()))
            && rows.word().is_err()
    }

    fn has_line_for_each_row(&self) -> bool {
        let count = self.elements_with_rows().fold(0, |sum: u64, element| sum.saturating_add(element.count));
        let lines = self.bytes[self.header.length..].split(|&byte| byte == b'\n' || byte == b'\r');
        lines.filter(|line| !line.trim_ascii().is_empty()).count() as u64 >= count
    }

    fn elements_with_rows(&self) -> impl Iterator<Item = &'a Element> {
        self.header.elements.iter().filter(|element| !element.properties.is_empty())
    }

    /// The number of items of a list, for which there are enough bytes.
    fn count(&mut self, count: Type, item: Type) -> Result<usize, Fault> {
        let count = self.value(count)?;
        if !(count >= 0.0 && count.fract() == 0.0) {
            return Err(Fault::NoCount(count));
        }
        let least = if self.encoding == Encoding::Ascii { 2 } else { item.size() };
        let room = (self.bytes.len() - self.at + 1) / least;
        if count > room as f64 { Err(Fault::Ended) } else { Ok(count as usize) }
    }

    fn skip(&mut self, count: usize, item: Type) -> Result<(), Fault> {
        if self.encoding == Encoding::Ascii {
            return (0..count).try_for_each(|_| self.word().map(drop));
        }
        self.at += count * item.size();
        if self.at > self.bytes.len() { Err(Fault::Ended) } else { Ok(()) }
    }

    fn value(&mut self, of: Type) -> Result<f64, Fault> {
        if self.encoding == Encoding::Ascii {
            let word = self.word()?;
            return number(word).or_else(|| odd_number(word)).ok_or_else(|| Fault::NoNumber(quoted(word)));
        }
        Ok(match of {
            Type::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Type::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Type::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Type::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Type::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Type::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Type::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Type::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    /// The bytes of a number, the lowest first.
    fn take<const SIZE: usize>(&mut self) -> Result<[u8; SIZE], Fault> {
        let mut bytes = *self.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<SIZE>).ok_or(Fault::Ended)?;
        self.at += SIZE;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// The next word of an ASCII file.
    fn word(&mut self) -> Result<&'a [u8], Fault> {
        let rest = &self.bytes[self.at..];
        let begin = rest.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(Fault::Ended)?;
        let length = rest[begin..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - begin);
        self.at += begin + length;
        Ok(&rest[begin..begin + length])
    }
}
