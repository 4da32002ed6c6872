//! Reads accessors: every range is checked against its buffer first, so that a damaged file is an error, never a panic.

use std::path::Path;

use gltf::{
    Accessor,
    accessor::{DataType, Dimensions, Item, Iter},
    buffer::View,
};

use super::container::malformed;
use crate::LoadError;

/// Buffers and the name of the file that they belong to.
#[derive(Clone, Copy)]
pub(super) struct Accessors<'a> {
    pub(super) path: &'a Path,
    pub(super) buffers: &'a [Vec<u8>],
}

/// A component as a number; integers are mapped to [0, 1] or [-1, 1] where the accessor says "normalized".
trait Component: Item + Copy + Into<f64> {
    const LARGEST: f64;
}

impl Component for f32 {
    const LARGEST: f64 = 1.0;
}
impl Component for i8 {
    const LARGEST: f64 = i8::MAX as f64;
}
impl Component for u8 {
    const LARGEST: f64 = u8::MAX as f64;
}
impl Component for i16 {
    const LARGEST: f64 = i16::MAX as f64;
}
impl Component for u16 {
    const LARGEST: f64 = u16::MAX as f64;
}
impl Component for u32 {
    const LARGEST: f64 = u32::MAX as f64;
}

impl<'a> Accessors<'a> {
    /// Three-component vectors: positions and normals.
    pub(super) fn triples(&self, accessor: &Accessor) -> Result<Vec<[f64; 3]>, LoadError> {
        self.vectors(accessor, Dimensions::Vec3)
    }

    /// Two-component vectors: texture coordinates.
    pub(super) fn pairs(&self, accessor: &Accessor) -> Result<Vec<[f64; 2]>, LoadError> {
        self.vectors(accessor, Dimensions::Vec2)
    }

    /// Vertex indices.
    pub(super) fn indices(&self, accessor: &Accessor) -> Result<Vec<u32>, LoadError> {
        self.expect(accessor, Dimensions::Scalar)?;
        match accessor.data_type() {
            DataType::U8 => Ok(self.items::<u8>(accessor)?.into_iter().map(u32::from).collect()),
            DataType::U16 => Ok(self.items::<u16>(accessor)?.into_iter().map(u32::from).collect()),
            DataType::U32 => self.items(accessor),
            _ => Err(self.broken(accessor, "holds no unsigned integers, but indices are asked of it")),
        }
    }

    fn vectors<const N: usize>(&self, accessor: &Accessor, dimensions: Dimensions) -> Result<Vec<[f64; N]>, LoadError>
    where
        [f32; N]: Item,
        [i8; N]: Item,
        [u8; N]: Item,
        [i16; N]: Item,
        [u16; N]: Item,
        [u32; N]: Item,
    {
        self.expect(accessor, dimensions)?;
        match accessor.data_type() {
            DataType::F32 => self.numbers::<f32, N>(accessor),
            DataType::I8 => self.numbers::<i8, N>(accessor),
            DataType::U8 => self.numbers::<u8, N>(accessor),
            DataType::I16 => self.numbers::<i16, N>(accessor),
            DataType::U16 => self.numbers::<u16, N>(accessor),
            DataType::U32 => self.numbers::<u32, N>(accessor),
        }
    }

    fn numbers<T: Component, const N: usize>(&self, accessor: &Accessor) -> Result<Vec<[f64; N]>, LoadError>
    where
        [T; N]: Item,
    {
        let scale = if accessor.normalized() { T::LARGEST.recip() } else { 1.0 };
        let number = |component: T| (component.into() * scale).max(if accessor.normalized() { -1.0 } else { f64::MIN });
        Ok(self.items::<[T; N]>(accessor)?.into_iter().map(|item| item.map(number)).collect())
    }

    fn items<T: Item>(&self, accessor: &Accessor) -> Result<Vec<T>, LoadError> {
        self.check(accessor)?;
        if accessor.count() == 0 {
            return Ok(Vec::new());
        }
        let items = Iter::new(accessor.clone(), |buffer| self.buffers.get(buffer.index()).map(Vec::as_slice))
            .ok_or_else(|| self.broken(accessor, "cannot be read"))?;
        Ok(items.collect())
    }

    fn expect(&self, accessor: &Accessor, dimensions: Dimensions) -> Result<(), LoadError> {
        if accessor.dimensions() == dimensions {
            Ok(())
        } else {
            let problem = format!("holds {:?} where {dimensions:?} is expected", accessor.dimensions());
            Err(self.broken(accessor, &problem))
        }
    }

    /// Every byte that reading will touch lies in its view, and every view in its buffer.
    fn check(&self, accessor: &Accessor) -> Result<(), LoadError> {
        let size = accessor.size();
        match accessor.view() {
            Some(view) => self.check_range(accessor, &view, accessor.offset(), accessor.count(), size)?,
            // glTF means zeros here, which are no shape; and nothing bounds how many.
            None => return Err(self.broken(accessor, "has no buffer view")),
        }
        if let Some(sparse) = accessor.sparse() {
            if sparse.count() == 0 {
                return Err(self.broken(accessor, "has a sparse part without items"));
            }
            let (indices, values) = (sparse.indices(), sparse.values());
            let index_size = indices.index_type().size();
            self.check_range(accessor, &indices.view(), indices.offset(), sparse.count(), index_size)?;
            self.check_range(accessor, &values.view(), values.offset(), sparse.count(), size)?;
        }
        Ok(())
    }

    fn check_range(
        &self,
        accessor: &Accessor,
        view: &View,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<(), LoadError> {
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(self.broken(accessor, &format!("has items of {size} bytes, {stride} bytes apart")));
        }
        let end = count.saturating_sub(1).checked_mul(stride).and_then(|n| n.checked_add(size)?.checked_add(offset));
        let view_end = view.offset().checked_add(view.length());
        let buffer = self.buffers.get(view.buffer().index()).map_or(0, Vec::len);
        let fits = end.is_some_and(|end| end <= view.length()) && view_end.is_some_and(|end| end <= buffer);
        if fits || count == 0 { Ok(()) } else { Err(self.broken(accessor, "reaches beyond its buffer")) }
    }

    fn broken(&self, accessor: &Accessor, problem: &str) -> LoadError {
        malformed(self.path, format!("accessor {} {problem}", accessor.index()))
    }
}
