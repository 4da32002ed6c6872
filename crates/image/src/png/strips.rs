//! The image data of a PNG file, compressed in strips of rows by all threads.
//!
//! Every row is filtered with *Sub* (PNG specification, 9.2): each byte less the one a pixel to its left. Other filters, and choosing
//! by row, save no more than 5 % of rendered images. It refers to no other row, so strips are independent, as are the
//! [pieces](crate::deflate) that they are compressed to. Level 2 of zlib-rs takes less than half of the time of level 6 for a tenth
//! more bytes (`cargo bench -p lightmesh --bench write`).

use std::io::Write;

use png::{EncodingError, Writer, chunk};
use rayon::prelude::*;

use crate::deflate::{self, Piece};

const LEVEL: i32 = 2;
/// Bytes of a strip, unless a single row is longer.
const STRIP: usize = 256 << 10;
/// Strips that are held in memory at once.
const AT_ONCE: usize = 64;
const FILTER_SUB: u8 = 1;

/// How the rows of an image are stored.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    /// Number of rows.
    pub(super) count: usize,
    /// Bytes of each.
    pub(super) bytes: usize,
    /// Bytes of a pixel.
    pub(super) pixel: usize,
}

/// Writes all image data; `fill` appends the bytes of a row.
pub(super) fn write<W: Write>(
    writer: &mut Writer<W>,
    rows: Rows,
    fill: impl Fn(usize, &mut Vec<u8>) + Sync,
) -> Result<(), EncodingError> {
    let height = (STRIP / rows.bytes).max(1);
    let starts: Vec<usize> = (0..rows.count).step_by(height).collect();
    let mut checksum = 1;
    for (batch, starts) in starts.chunks(AT_ONCE).enumerate() {
        let strip = |&start: &usize| strip(rows, start..rows.count.min(start + height), &fill);
        let pieces: Vec<Piece> = starts.par_iter().map(strip).collect();
        for (index, piece) in pieces.into_iter().enumerate() {
            checksum = deflate::checksum(checksum, &piece);
            let header = if batch + index == 0 { &deflate::HEADER[..] } else { &[] };
            writer.write_chunk(chunk::IDAT, &[header, &piece.bytes].concat())?;
        }
    }
    writer.write_chunk(chunk::IDAT, &deflate::end(checksum))
}

fn strip(rows: Rows, range: std::ops::Range<usize>, fill: &impl Fn(usize, &mut Vec<u8>)) -> Piece {
    let mut filtered = Vec::with_capacity(range.len() * (1 + rows.bytes));
    let mut row = Vec::with_capacity(rows.bytes);
    for y in range {
        row.clear();
        fill(y, &mut row);
        filtered.push(FILTER_SUB);
        let (first, others) = row.split_at(rows.pixel);
        filtered.extend_from_slice(first);
        filtered.extend(others.iter().zip(&row).map(|(&byte, &left)| byte.wrapping_sub(left)));
    }
    Piece::new(&filtered, LEVEL)
}
