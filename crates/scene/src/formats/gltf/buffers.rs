//! The bytes behind accessors and images; each buffer is read on first use.

use std::{
    borrow::Cow,
    cell::{Cell, OnceCell},
    path::Path,
};

use super::{
    container::malformed,
    document::{BufferView, Document},
    uri::{self, Uri},
};
use crate::LoadError;
use crate::build::error::Place;
use crate::build::file_access::FileAccess;

/// All buffers of a file.
pub(super) struct Buffers<'a> {
    path: &'a Path,
    views: &'a [BufferView],
    buffers: Vec<Buffer<'a>>,
    access: FileAccess,
    bytes_read: Cell<usize>,
}

struct Buffer<'a> {
    source: Source<'a>,
    /// As stated by the document.
    length: u64,
    bytes: OnceCell<Cow<'a, [u8]>>,
}

enum Source<'a> {
    /// The binary chunk.
    Chunk(&'a [u8]),
    Data(&'a str),
    /// Name of a file.
    File(Cow<'a, str>),
    Nothing,
}

impl<'a> Buffers<'a> {
    /// Locates each buffer; none is read yet.
    pub(super) fn new(
        path: &'a Path,
        document: &'a Document,
        bin: Option<&'a [u8]>,
        access: &FileAccess,
    ) -> Result<Buffers<'a>, LoadError> {
        let buffer = |(index, buffer): (usize, &'a super::document::Buffer)| {
            let source = match (buffer.uri.as_deref().map(Uri::new), bin) {
                (Some(Uri::Data(data)), _) => Source::Data(data),
                (Some(Uri::File(name)), _) => {
                    access.path_beside(path, &name)?;
                    Source::File(name)
                }
                (None, Some(bin)) if index == 0 => Source::Chunk(bin),
                (None, _) => Source::Nothing,
            };
            Ok(Buffer { source, length: buffer.byte_length, bytes: OnceCell::new() })
        };
        let buffers = document.buffers.iter().enumerate().map(buffer).collect::<Result<_, _>>()?;
        Ok(Buffers { path, views: &document.buffer_views, buffers, access: access.clone(), bytes_read: Cell::new(0) })
    }

    /// The bytes of a view, with its stride if it has one.
    pub(super) fn view(&self, index: u32) -> Result<(&[u8], Option<u64>), LoadError> {
        let bad = |problem: String| malformed(self.path, format!("buffer view {index} {problem}"));
        let view = self.views.get(index as usize).ok_or_else(|| bad("is not there".to_owned()))?;
        let buffer = self.buffer(view.buffer)?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| buffer.get(usize::try_from(view.byte_offset).ok()?..usize::try_from(end).ok()?));
        let bytes = bytes.ok_or_else(|| bad(format!("reaches beyond its buffer of {} bytes", buffer.len())))?;
        Ok((bytes, view.byte_stride.filter(|&stride| stride > 0)))
    }

    /// Number of bytes in all buffers that have been read so far.
    pub(super) fn bytes_read(&self) -> usize {
        self.bytes_read.get()
    }

    fn buffer(&self, index: u32) -> Result<&[u8], LoadError> {
        let buffer = self
            .buffers
            .get(index as usize)
            .ok_or_else(|| malformed(self.path, format!("there is no buffer {index}")))?;
        if let Some(bytes) = buffer.bytes.get() {
            return Ok(bytes);
        }
        let bytes = buffer.read(self.path, index, &self.access)?;
        self.bytes_read.update(|sum| sum + bytes.len());
        Ok(buffer.bytes.get_or_init(|| bytes))
    }
}

impl<'a> Buffer<'a> {
    fn read(&self, path: &Path, index: u32, access: &FileAccess) -> Result<Cow<'a, [u8]>, LoadError> {
        let bytes = match &self.source {
            Source::Chunk(bytes) => Cow::Borrowed(*bytes),
            Source::Data(data) => Cow::Owned(
                uri::decode(data)
                    .ok_or_else(|| malformed(path, format!("the data URI of buffer {index} cannot be decoded")))?,
            ),
            Source::File(name) => {
                // A file may contain more than this buffer.
                let read =
                    access.read_start(path, name, self.length).map_err(|error| error.named_by(Place::file(path)));
                Cow::Owned(read?.1)
            }
            Source::Nothing => return Err(malformed(path, format!("buffer {index} has no data"))),
        };
        let short = || {
            let there = bytes.len();
            malformed(path, format!("buffer {index} has {there} of {} bytes: it is truncated", self.length))
        };
        match usize::try_from(self.length) {
            Ok(length) if length <= bytes.len() => Ok(bytes),
            _ => Err(short()),
        }
    }
}
