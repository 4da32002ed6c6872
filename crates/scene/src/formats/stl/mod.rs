//! STL (3D Systems 1988), ASCII or binary.
//!
//! Not based on stl_io, which treats any file starting with `solid` as ASCII, as many binary files do, and rejects text that differs
//! from the specification in whitespace or case.
//!
//! A file is binary if it has exactly the length implied by the count in its header, whatever it begins with. In text, lines between
//! facets are ignored with a warning, unless they are parts of one; a count of 0 in front of facets, left by a program that did not know
//! their number at the start, is corrected. Facet normals are not
//! used: they follow from the corners. Colours in the attribute bytes, of which there are several
//! conventions, are not used either. Corners are not merged: each facet has its own vertices, which get smooth normals if the options ask
//! for them.

mod ascii;
mod binary;
mod error;
mod soup;

use std::path::Path;

use self::soup::{BEGINNING, Soup};
use super::text::with_line_feeds;
use crate::build::draft::Draft;
use crate::build::loaded_mesh::LoadedMesh;
use crate::build::placement::Placement;
use crate::{LoadError, Objects, Position};

/// Reads an STL file into `draft`.
pub(crate) fn read(path: &Path, mut bytes: Vec<u8>, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    draft.access.check_content(path, &bytes)?;
    if !binary::has_exact_length(&bytes) && is_text(&bytes) {
        let soup = ascii::read(path, with_line_feeds(&mut bytes))?;
        hand_over(path, soup, bytes, placement, draft)
    } else {
        let soup = binary::read(path, &bytes)?;
        hand_over(path, soup, bytes, placement, draft)
    }
}

fn hand_over<P: Position>(
    path: &Path,
    soup: Soup<P>,
    bytes: Vec<u8>,
    placement: &Placement,
    draft: &mut Draft,
) -> Result<(), LoadError> {
    // From here on its memory is needed for the scene.
    drop(bytes);
    draft.warnings.extend(soup.warnings);
    let material = placement.material.unwrap_or_else(|| draft.default_material());
    let mesh = LoadedMesh {
        positions: soup.positions,
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
        materials: vec![material; soup.triangles.len()],
        triangles: soup.triangles,
        groups: Vec::new(),
        objects: Objects::default(),
    };
    draft.begin_object(placement.object_in(path));
    draft.take(mesh, &placement.transform)
}

/// Whether it begins with `solid` and continues like text, or has facets of text below something else.
fn is_text(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let beginning = bytes[..bytes.len().min(BEGINNING)].to_ascii_lowercase();
    let holds = |word: &[u8]| memchr::memmem::find(&beginning, word).is_some();
    if beginning.starts_with(b"solid") {
        holds(b"facet") || holds(b"endsolid") || !beginning.contains(&0)
    } else {
        holds(b"facet") && holds(b"vertex") && !beginning.contains(&0)
    }
}
