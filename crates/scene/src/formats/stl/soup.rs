//! What is read of an STL file.

/// Number of bytes at the start of a text in which a keyword must be found.
pub(super) const BEGINNING: usize = 4096;

/// Triangles with their own vertices.
#[derive(Debug, Default)]
pub(super) struct Soup<P> {
    pub(super) positions: Vec<P>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Complete sentences.
    pub(super) warnings: Vec<String>,
}
