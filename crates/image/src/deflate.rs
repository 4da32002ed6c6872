//! Deflate (RFC 1951) and zlib (RFC 1950), in pieces that are compressed independently of each other.
//!
//! A [`Piece`] ends at a byte, as after a sync flush: so pieces may be compressed by any number of threads and joined to one stream,
//! [`HEADER`], pieces, [`end`]. What they begin with does not refer to what is before, which costs a few bytes per piece. Sizes of pieces are
//! chosen by the caller from the data alone, so that no byte depends on the number of threads.

use zlib_rs::adler32::{adler32, adler32_combine};
use zlib_rs::{Deflate, DeflateFlush, Status};

/// Logarithm of the window in which repetitions are found.
pub const WINDOW: u8 = 15;
/// Bytes that a stored block and the end of a stream need beyond the data.
const SPARE: usize = 64;

/// The start of a zlib stream: a window of 32 KiB, compressed fast.
pub const HEADER: [u8; 2] = [0x78, 0x01];

/// A part of a deflate stream, aligned to bytes.
pub struct Piece {
    /// Whole blocks, none of them the last.
    pub bytes: Vec<u8>,
    adler: u32,
    length: u64,
}

impl Piece {
    /// Compresses `data` at a level from 1 (fastest) to 9.
    pub fn new(data: &[u8], level: i32) -> Piece {
        let bytes = compress(data, Deflate::new(level, false, WINDOW), DeflateFlush::SyncFlush);
        Piece { bytes, adler: adler32(1, data), length: data.len() as u64 }
    }
}

/// The checksum of the data of all pieces so far, of which `piece` is the next; it starts at 1.
pub fn checksum(before: u32, piece: &Piece) -> u32 {
    adler32_combine(before, piece.adler, piece.length)
}

/// The end of a zlib stream: an empty stored block that is the last, and the checksum of all pieces.
pub fn end(checksum: u32) -> [u8; 9] {
    let [a, b, c, d] = checksum.to_be_bytes();
    [1, 0, 0, 0xff, 0xff, a, b, c, d]
}

/// A whole zlib stream.
pub fn zlib(data: &[u8], level: i32) -> Vec<u8> {
    compress(data, Deflate::new(level, true, WINDOW), DeflateFlush::Finish)
}

fn compress(data: &[u8], mut deflate: Deflate, flush: DeflateFlush) -> Vec<u8> {
    let mut bytes = vec![0; data.len() / 2 + SPARE];
    loop {
        let (read, written) = (deflate.total_in() as usize, deflate.total_out() as usize);
        let status = deflate.compress(&data[read..], &mut bytes[written..], flush);
        let status = status.expect("a new stream with valid settings has no errors");
        let written = deflate.total_out() as usize;
        // What is flushed may still be in the stream if the room was filled to its end.
        if status == Status::StreamEnd || (flush != DeflateFlush::Finish && written < bytes.len()) {
            bytes.truncate(written);
            return bytes;
        }
        bytes.resize(2 * bytes.len(), 0);
    }
}
