//! Binary STL: 80 arbitrary bytes, the number of facets, and 50 bytes for each: normal, three corners, two attribute bytes.

use std::path::Path;

use glam::Vec3;

use super::error::malformed;
use super::soup::Soup;
use crate::LoadError;

/// Bytes before the count.
const HEADER: usize = 80;
/// Bytes of the count.
const COUNT: usize = 4;
/// Bytes of a facet.
const FACET: usize = 50;
/// Bytes of a vector of three `f32`.
const VECTOR: usize = 12;

/// The declared number of facets, and the bytes that should contain them; `None` if the file is too short for that.
fn facets(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (count, facets) = bytes.get(HEADER..)?.split_first_chunk::<COUNT>()?;
    Some((u32::from_le_bytes(*count), facets))
}

/// Whether the file has exactly the length implied by its count.
pub(super) fn has_exact_length(bytes: &[u8]) -> bool {
    facets(bytes).is_some_and(|(count, facets)| facets.len() as u64 == FACET as u64 * u64::from(count))
}

/// Reads all facets.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Soup<Vec3>, LoadError> {
    let Some((count, facets)) = facets(bytes) else {
        let least = HEADER + COUNT;
        let problem = format!("{} bytes are neither ASCII STL nor binary STL, which has at least {least}", bytes.len());
        return Err(malformed(path, None, problem));
    };
    let (whole, rest) = facets.as_chunks::<FACET>();
    let is_unset = count == 0 && rest.is_empty() && u32::try_from(whole.len()).is_ok_and(|facets| facets > 0);
    let count = if is_unset { whole.len() as u32 } else { count };
    if whole.len() < count as usize {
        let problem =
            format!("the header declares {count} facets, but the rest of the file has room for only {}", whole.len());
        return Err(malformed(path, None, problem));
    }
    let whole = &whole[..count as usize];
    if whole.len() > (u32::MAX / 3) as usize {
        return Err(LoadError::TooLarge { path: path.to_owned() });
    }
    let mut positions = Vec::with_capacity(3 * whole.len());
    for facet in whole {
        positions.extend(facet[VECTOR..].as_chunks::<VECTOR>().0.iter().map(vector));
    }
    let triangles = (0..count).map(|facet| [3 * facet, 3 * facet + 1, 3 * facet + 2]).collect();
    let surplus = facets.len() - FACET * whole.len();
    let unset = is_unset.then(|| format!("the header declares no facets, but {count} follow: they are shown"));
    let surplus = (surplus > 0).then(|| format!("{surplus} bytes after the {count} facets of the header were ignored"));
    let warnings = unset.into_iter().chain(surplus).map(|warning| format!("{}: {warning}", path.display())).collect();
    Ok(Soup { positions, triangles, warnings })
}

fn vector(bytes: &[u8; VECTOR]) -> Vec3 {
    let (numbers, _) = bytes.as_chunks();
    Vec3::from_array([0, 1, 2].map(|axis| f32::from_le_bytes(numbers[axis])))
}
