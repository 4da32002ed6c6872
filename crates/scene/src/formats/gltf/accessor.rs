//! Reads accessors: every range is checked against its buffer first, so that a damaged file is an error, never a panic, and no
//! memory is allocated before the bytes are known to exist. Data that is stored in the required form is borrowed from the file.

use std::{borrow::Cow, path::Path};

use bytemuck::AnyBitPattern;

use super::{
    buffers::Buffers,
    container::malformed,
    document::{Accessor, Document, Sparse},
    strided::{Component, Strided},
};
use crate::LoadError;
use crate::build::quote::quote;

/// Which elements of an accessor are read: those with these indices, ascending and in range, or all. A small part of a large
/// accessor that many share is thus no more work than its size.
pub(super) type Used<'u> = Option<&'u [u32]>;

/// Accessors and the data they refer to.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'a> {
    pub(super) path: &'a Path,
    pub(super) document: &'a Document<'a>,
    pub(super) buffers: &'a Buffers<'a>,
}

/// An accessor whose bytes are known to exist.
struct Elements<'a> {
    kind: &'a str,
    component: Component,
    count: usize,
    /// `None`: zeros.
    base: Option<Strided<'a>>,
    /// Which elements are replaced, and by what.
    sparse: Option<(Strided<'a>, Strided<'a>)>,
}

impl<'a> Accessors<'a> {
    /// Number of elements, once they are known to exist.
    pub(super) fn count(&self, index: u32) -> Result<usize, LoadError> {
        Ok(self.elements(index)?.count)
    }

    /// Vectors of `N` numbers; integers are mapped to [0, 1] or [-1, 1] if the accessor is normalized. Of the elements only those
    /// that are [`Used`].
    pub(super) fn vectors<const N: usize>(&self, index: u32, used: Used) -> Result<Cow<'a, [[f32; N]]>, LoadError>
    where
        [f32; N]: AnyBitPattern,
    {
        self.numbers_of(index, &self.elements(index)?, used)
    }

    /// The same of integers that are always mapped.
    fn shares<const N: usize>(&self, index: u32, used: Used) -> Result<Cow<'a, [[f32; N]]>, LoadError>
    where
        [f32; N]: AnyBitPattern,
    {
        let mut elements = self.elements(index)?;
        let stored = elements.base.iter_mut().chain(elements.sparse.as_mut().map(|(_, values)| values));
        stored.for_each(|stored| stored.normalized = true);
        self.numbers_of(index, &elements, used)
    }

    fn numbers_of<const N: usize>(
        &self,
        index: u32,
        elements: &Elements<'a>,
        used: Used,
    ) -> Result<Cow<'a, [[f32; N]]>, LoadError>
    where
        [f32; N]: AnyBitPattern,
    {
        if dimensions(elements.kind) != Some(N) {
            return Err(self.broken(index, &format!("has type {} where VEC{N} is expected", quote(elements.kind))));
        }
        let is_float = elements.component == Component::F32;
        self.read(index, elements, used, [0.0; N], is_float, |elements| elements.numbers())
    }

    /// Whether integers that must be normalized are not.
    pub(super) fn is_raw(&self, index: u32) -> Result<bool, LoadError> {
        let elements = self.elements(index)?;
        let stored = elements.base.iter().chain(elements.sparse.as_ref().map(|(_, values)| values));
        Ok(elements.component != Component::F32 && stored.into_iter().any(|stored| !stored.normalized))
    }

    /// Colours with or without alpha, which is left out. Clamped to [0, 1], as glTF requires; NaN counts as 0. Integers are mapped to this range
    /// whether the accessor is normalized, as it has to be, or not.
    pub(super) fn colors(&self, index: u32, used: Used) -> Result<Cow<'a, [[f32; 3]]>, LoadError> {
        let mut colors = if self.elements(index)?.kind == "VEC4" {
            self.shares(index, used)?.iter().map(|&[r, g, b, _]| [r, g, b]).collect()
        } else {
            self.shares(index, used)?
        };
        if colors.as_flattened().iter().any(|channel| !(0.0..=1.0).contains(channel)) {
            for channel in colors.to_mut().as_flattened_mut() {
                #[allow(clippy::manual_clamp, reason = "`clamp` would keep NaN")]
                let clamped = channel.max(0.0).min(1.0);
                *channel = clamped;
            }
        }
        Ok(colors)
    }

    /// The alpha of vertex colours, from 0 to 1; none if they have no alpha, or one that is 1 everywhere.
    pub(super) fn opacities(&self, index: u32, used: Used) -> Result<Vec<f32>, LoadError> {
        if self.elements(index)?.kind != "VEC4" {
            return Ok(Vec::new());
        }
        // NaN counts as 0.
        let opacity = |&[.., alpha]: &[f32; 4]| if alpha > 0.0 { alpha.min(1.0) } else { 0.0 };
        let opacities: Vec<f32> = self.shares::<4>(index, used)?.iter().map(opacity).collect();
        Ok(if opacities.iter().all(|&opacity| opacity == 1.0) { Vec::new() } else { opacities })
    }

    /// Vertex indices.
    pub(super) fn indices(&self, index: u32) -> Result<Cow<'a, [u32]>, LoadError> {
        let elements = self.elements(index)?;
        if elements.kind != "SCALAR" || !elements.component.is_unsigned() {
            return Err(self.broken(index, "does not contain unsigned integers, but is used for indices"));
        }
        self.read(index, &elements, None, 0, elements.component == Component::U32, |elements| elements.integers())
    }

    /// The elements that are used, borrowed if those are all, the file stores them `as_is` and nothing replaces them.
    fn read<T: AnyBitPattern>(
        &self,
        index: u32,
        elements: &Elements<'a>,
        used: Used,
        zero: T,
        as_is: bool,
        convert: impl Fn(&Strided) -> Vec<T>,
    ) -> Result<Cow<'a, [T]>, LoadError> {
        let used = used.filter(|_| elements.count > 0);
        let mut all = match (&elements.base, used) {
            (Some(base), Some(used)) => convert(&base.packed(used, &mut Vec::new())).into(),
            (Some(base), None) if as_is => base.borrowed().map_or_else(|| convert(base).into(), Cow::Borrowed),
            (Some(base), None) => convert(base).into(),
            (None, _) => vec![zero; used.map_or(elements.count, <[u32]>::len)].into(),
        };
        if let Some((indices, values)) = &elements.sparse {
            let all = all.to_mut();
            for (at, value) in indices.integers().into_iter().zip(convert(values)) {
                if at as usize >= elements.count {
                    let problem = format!("has {} elements, but its sparse part replaces number {at}", elements.count);
                    return Err(self.broken(index, &problem));
                }
                let place = used.map_or(Ok(at as usize), |used| used.binary_search(&at));
                if let Ok(place) = place {
                    all[place] = value;
                }
            }
        }
        Ok(all)
    }

    fn elements(&self, index: u32) -> Result<Elements<'a>, LoadError> {
        let accessor = self
            .document
            .accessors
            .get(index as usize)
            .ok_or_else(|| malformed(self.path, format!("accessor {index} is referenced, but does not exist")))?;
        let component = self.component(index, accessor.component_type)?;
        let dimensions = dimensions(&accessor.kind).ok_or_else(|| {
            self.broken(index, &format!("has type {}, which is not valid here", quote(&accessor.kind)))
        })?;
        let range = |view, range, dimensions, component| {
            self.range(index, view, range, dimensions, component)
                .map(|found| Strided { normalized: accessor.normalized, ..found })
        };
        let sparse = match accessor.sparse.as_deref() {
            Some(Sparse { count, .. }) if *count > accessor.count => {
                let problem = format!("has {} elements, but its sparse part replaces {count}", accessor.count);
                return Err(self.broken(index, &problem));
            }
            Some(Sparse { count, indices, values }) => {
                let kind = self.component(index, indices.component_type)?;
                if !kind.is_unsigned() {
                    return Err(self.broken(index, "has a sparse part whose indices are not unsigned integers"));
                }
                let indices = range(indices.buffer_view, (indices.byte_offset, *count), 1, kind)?;
                let values = range(values.buffer_view, (values.byte_offset, *count), dimensions, component)?;
                Some((indices, values))
            }
            None => None,
        };
        let view = accessor.buffer_view;
        let base =
            view.map(|view| range(view, (accessor.byte_offset, accessor.count), dimensions, component)).transpose()?;
        let count = match &base {
            Some(base) => base.count,
            None => self.count_of_zeros(index, accessor)?,
        };
        Ok(Elements { kind: &accessor.kind, component, count, base, sparse })
    }

    fn component(&self, index: u32, number: u32) -> Result<Component, LoadError> {
        Component::new(number).ok_or_else(|| self.broken(index, &format!("has the component type {number}")))
    }

    /// Elements without a buffer view are zeros. There may be as many as the buffers have bytes: nothing in the file could
    /// distinguish more of them.
    fn count_of_zeros(&self, index: u32, accessor: &Accessor) -> Result<usize, LoadError> {
        match usize::try_from(accessor.count) {
            Ok(count) if count <= self.buffers.bytes_read() => Ok(count),
            _ => Err(self.broken(index, &format!("has {} elements, but no buffer view", accessor.count))),
        }
    }

    /// `count` elements starting `offset` bytes into a view.
    fn range(
        &self,
        index: u32,
        view: u32,
        (offset, count): (u64, u64),
        dimensions: usize,
        component: Component,
    ) -> Result<Strided<'a>, LoadError> {
        let (bytes, stride) = self.buffers.view(view)?;
        let size = (dimensions * component.size()) as u64;
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(self.broken(index, &format!("has elements of {size} bytes, {stride} bytes apart")));
        }
        let last = count.saturating_sub(1).checked_mul(stride);
        let end = last.and_then(|last| last.checked_add(size)?.checked_add(offset));
        if count > 0 && end.is_none_or(|end| end > bytes.len() as u64) {
            let length = bytes.len();
            let problem = format!("reaches beyond its buffer view of {length} bytes with {count} elements");
            return Err(self.broken(index, &problem));
        }
        // The offset is in range if there are elements. With only one element, any stride is allowed.
        let bytes = if count == 0 { &[] } else { &bytes[offset as usize..] };
        let stride = usize::try_from(stride).unwrap_or(usize::MAX);
        Ok(Strided { bytes, count: count as usize, size: size as usize, stride, component, normalized: false })
    }

    fn broken(&self, index: u32, problem: &str) -> LoadError {
        malformed(self.path, format!("accessor {index} {problem}"))
    }
}

/// Number of components per element; `None` for the smaller matrices, which nothing has.
fn dimensions(kind: &str) -> Option<usize> {
    Some(match kind {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}
