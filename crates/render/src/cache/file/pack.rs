//! Compression. Without the feature `mesh-file` there is none, and files can be neither read nor written.

#[cfg(feature = "mesh-file")]
pub(super) use with::*;
#[cfg(not(feature = "mesh-file"))]
pub(super) use without::*;

#[cfg(feature = "mesh-file")]
mod with {
    use std::io::{self, Read, Write};

    use zstd::{Decoder, Encoder};

    /// Of Zstandard: more takes much more time and memory, and saves little.
    const LEVEL: i32 = 3;
    /// The window has at most so many bits: as much memory is taken to read a file, and no more.
    const WINDOW_BITS: u32 = 21;

    pub(in super::super) fn encoder<W: Write>(output: W) -> io::Result<Encoder<'static, W>> {
        let mut encoder = Encoder::new(output, LEVEL)?;
        encoder.window_log(WINDOW_BITS)?;
        Ok(encoder)
    }

    pub(in super::super) fn finish<W: Write>(encoder: Encoder<'static, W>) -> io::Result<()> {
        encoder.finish().map(drop)
    }

    pub(in super::super) fn decoder(packed: &[u8]) -> io::Result<impl Read + '_> {
        let mut decoder = Decoder::with_buffer(packed)?;
        decoder.window_log_max(WINDOW_BITS)?;
        Ok(decoder)
    }
}

#[cfg(not(feature = "mesh-file"))]
mod without {
    use std::io::{self, Empty, Sink, Write};

    fn missing() -> io::Error {
        io::Error::new(io::ErrorKind::Unsupported, "this program was built without the feature mesh-file")
    }

    pub(in super::super) fn encoder<W: Write>(_: W) -> io::Result<Sink> {
        Err(missing())
    }

    pub(in super::super) fn finish(_: Sink) -> io::Result<()> {
        Err(missing())
    }

    pub(in super::super) fn decoder(_: &[u8]) -> io::Result<Empty> {
        Err(missing())
    }
}
