//! Compression. Without the feature `mesh-file` there is none, and files can be neither read nor written.

#[cfg(feature = "mesh-file")]
pub(super) use with::*;
#[cfg(not(feature = "mesh-file"))]
pub(super) use without::*;

#[cfg(feature = "mesh-file")]
mod with {
    use std::io::{self, Write};

    use flate2::Compression;
    use flate2::bufread::DeflateDecoder;
    use flate2::write::DeflateEncoder;

    pub(in super::super) fn encoder<W: Write>(output: W) -> io::Result<DeflateEncoder<W>> {
        // Better compression makes files 7 % smaller at best, in ten times the time.
        Ok(DeflateEncoder::new(output, Compression::fast()))
    }

    pub(in super::super) fn finish<W: Write>(encoder: DeflateEncoder<W>) -> io::Result<()> {
        encoder.finish().map(drop)
    }

    /// Takes the memory of its window, and no more.
    pub(in super::super) fn decoder(packed: &[u8]) -> io::Result<DeflateDecoder<&[u8]>> {
        Ok(DeflateDecoder::new(packed))
    }

    /// Bytes after the end of what was compressed.
    pub(in super::super) fn rest(decoder: &DeflateDecoder<&[u8]>) -> usize {
        decoder.get_ref().len()
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

    pub(in super::super) fn rest(_: &Empty) -> usize {
        0
    }
}
