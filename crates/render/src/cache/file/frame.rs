//! What surrounds the content of a mesh file: how files begin, in which version, and how long header and trailer are.

/// How files begin.
pub const MAGIC: [u8; 8] = *b"LM MESH\0";
/// To be raised with every change of the format, of what decides what light points see, and
/// of how light is gathered.
pub(super) const VERSION: u32 = 4;
/// Bytes of the header.
pub const HEADER: usize = 24;
/// Bytes of the trailer.
pub const TRAILER: usize = 16;
