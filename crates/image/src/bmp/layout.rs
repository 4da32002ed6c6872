//! The headers of a BMP, and the sizes in them.
//!
//! Layout (little-endian): `BITMAPFILEHEADER` of 14 bytes, `BITMAPINFOHEADER` of 40 bytes, then the rows from bottom to
//! top, each of blue, green, red triples and padded to a multiple of 4 bytes.

const FILE_HEADER: u32 = 14;
const INFO_HEADER: u32 = 40;
const HEADERS: u32 = FILE_HEADER + INFO_HEADER;

/// Largest values of the header fields.
pub(crate) const LIMIT: &str = "4 GiB per file";

/// 72 dots per inch, in dots per metre.
const RESOLUTION: i32 = 2835;

/// The sizes stored in the headers, all within 32 bits.
pub struct Layout {
    width: i32,
    height: i32,
    pub(super) row: usize,
    image: u32,
    /// Bytes of the file.
    pub file: u32,
}

impl Layout {
    /// Those of an image of this width and height, if it fits.
    pub fn new(width: u32, height: u32) -> Option<Self> {
        let row = (u64::from(width) * 3).next_multiple_of(4);
        let image = u32::try_from(row.checked_mul(u64::from(height))?).ok()?;
        Some(Self {
            width: i32::try_from(width).ok()?,
            height: i32::try_from(height).ok()?,
            row: usize::try_from(row).ok()?,
            image,
            file: image.checked_add(HEADERS)?,
        })
    }

    pub(super) fn headers(&self) -> [u8; HEADERS as usize] {
        let mut bytes = [0; HEADERS as usize];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(0, b"BM");
        put(2, &self.file.to_le_bytes());
        put(10, &HEADERS.to_le_bytes()); // where the rows start
        put(14, &INFO_HEADER.to_le_bytes());
        put(18, &self.width.to_le_bytes());
        put(22, &self.height.to_le_bytes()); // positive: bottom row first
        put(26, &1_u16.to_le_bytes()); // planes
        put(28, &24_u16.to_le_bytes()); // bits per pixel
        put(34, &self.image.to_le_bytes()); // after four zero bytes: no compression
        put(38, &RESOLUTION.to_le_bytes());
        put(42, &RESOLUTION.to_le_bytes());
        bytes
    }
}

/// Whether the sizes of such an image fit into the headers.
pub(crate) fn can_hold(width: u32, height: u32) -> bool {
    Layout::new(width, height).is_some()
}
