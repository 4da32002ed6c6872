//! The header of a PLY file: the encoding of numbers, and the elements with their properties.

use std::path::Path;

use memchr::memchr;

use super::error::malformed;
use crate::LoadError;
use crate::formats::notes::Notes;
use crate::formats::text::{decoded, quoted, split_word};

/// Some editors write it in front of a text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The encoding of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    /// The type with this name, in the old or the new style.
    fn named(name: &[u8]) -> Option<Type> {
        Some(match name {
            b"char" | b"int8" => Type::I8,
            b"uchar" | b"uint8" => Type::U8,
            b"short" | b"int16" => Type::I16,
            b"ushort" | b"uint16" => Type::U16,
            b"int" | b"int32" => Type::I32,
            b"uint" | b"uint32" => Type::U32,
            b"float" | b"float32" => Type::F32,
            b"double" | b"float64" => Type::F64,
            _ => return None,
        })
    }

    /// Size in a binary file in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Type::I8 | Type::U8 => 1,
            Type::I16 | Type::U16 => 2,
            Type::I32 | Type::U32 | Type::F32 => 4,
            Type::F64 => 8,
        }
    }

    /// The value of a colour channel of this type at full intensity.
    pub(super) fn full(self) -> f64 {
        match self {
            Type::I8 | Type::U8 => 255.0,
            Type::I16 | Type::U16 => 65_535.0,
            Type::I32 | Type::U32 => 4_294_967_295.0,
            Type::F32 | Type::F64 => 1.0,
        }
    }
}

/// The content of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    One(Type),
    /// A count of the first type, and that many items of the second type.
    List(Type, Type),
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) shape: Shape,
}

/// A number of rows with the same properties.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Index of the first property with one of these names.
    pub(super) fn property(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|property| names.contains(&property.name.as_str()))
    }

    /// Minimum number of bytes per row.
    pub(super) fn least_row(&self, encoding: Encoding) -> u64 {
        let least = |property: &Property| match (encoding, property.shape) {
            // A digit and a separator.
            (Encoding::Ascii, _) => 2,
            (_, Shape::One(of) | Shape::List(of, _)) => of.size() as u64,
        };
        self.properties.iter().map(least).sum()
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The image named by `comment TextureFile`.
    pub(super) texture: Option<String>,
    /// Offset of the first row in bytes.
    pub(super) length: usize,
}

/// Reads the header of `bytes`.
pub(super) fn read(path: &Path, bytes: &[u8], notes: &mut Notes) -> Result<Header, LoadError> {
    const EXPORT: &str = "export it again as PLY";
    let refuse = |line: usize, problem: String, remedy: &str| Err(malformed(path, Some(line), problem, remedy));
    let mark = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    let mut lines = Lines { bytes, at: mark, ending: line_ending(bytes) };
    if lines.next() != Some(b"ply") {
        return refuse(1, "the file does not begin with the line `ply`".to_owned(), EXPORT);
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut texture = None;
    for number in 2.. {
        let Some(line) = lines.next() else {
            return refuse(number - 1, "the header has no end_header".to_owned(), EXPORT);
        };
        let (word, rest) = split_word(line);
        let (first, second) = split_word(rest);
        match word {
            b"format" => {
                encoding = Some(match first {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        let problem = format!("`{}` is not a known format of PLY files", quoted(first));
                        return refuse(number, problem, "supported: ascii, binary_little_endian and binary_big_endian");
                    }
                });
            }
            b"element" => {
                let Some(count) = str::from_utf8(split_word(second).0).ok().and_then(|count| count.parse().ok()) else {
                    let problem = format!("`{}` has no usable count", quoted(line));
                    return refuse(number, problem, "write `element NAME COUNT`");
                };
                elements.push(Element { name: decoded(first).into_owned(), count, properties: Vec::new() });
            }
            b"property" => match (elements.last_mut(), property(rest)) {
                (Some(element), Some(property)) => element.properties.push(property),
                (None, _) => {
                    let problem = "a property comes before the first element".to_owned();
                    return refuse(number, problem, "write `element NAME COUNT` above it");
                }
                (_, None) => {
                    let problem = format!("`{}` is not a property with a known type", quoted(line));
                    return refuse(number, problem, "write `property TYPE NAME` or `property list TYPE TYPE NAME`");
                }
            },
            b"comment" if first.eq_ignore_ascii_case(b"texturefile") && !second.is_empty() => {
                texture.get_or_insert_with(|| decoded(second).into_owned());
            }
            b"comment" | b"obj_info" | b"" => {}
            b"end_header" => match encoding {
                Some(encoding) => return Ok(Header { encoding, elements, texture, length: lines.at }),
                None => return refuse(number, "the header has no line `format`".to_owned(), EXPORT),
            },
            _ => notes.add("is an unknown word in the header; its line is ignored", || (number, quoted(word))),
        }
    }
    unreachable!("lines end before numbers do")
}

/// `TYPE NAME` or `list TYPE TYPE NAME`.
fn property(text: &[u8]) -> Option<Property> {
    let (first, rest) = split_word(text);
    let (shape, name) = if first == b"list" {
        let (count, rest) = split_word(rest);
        let (item, name) = split_word(rest);
        (Shape::List(Type::named(count)?, Type::named(item)?), name)
    } else {
        (Shape::One(Type::named(first)?), rest)
    };
    let (name, _) = split_word(name);
    (!name.is_empty()).then(|| Property { name: decoded(name).into_owned(), shape })
}

/// What ends lines: carriage returns alone if the first line ends with one, else line feeds, whether or not carriage returns come before
/// them. After `end_header` a line feed may be data.
fn line_ending(bytes: &[u8]) -> u8 {
    match bytes.iter().position(|byte| matches!(byte, b'\r' | b'\n')).map(|at| &bytes[at..]) {
        Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
        _ => b'\n',
    }
}

struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    ending: u8,
}

impl<'a> Lines<'a> {
    /// The next line, trimmed; `None` if no line is terminated.
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let length = memchr(self.ending, rest)?;
        self.at += length + 1;
        Some(rest[..length].trim_ascii())
    }
}
