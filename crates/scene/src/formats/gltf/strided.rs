//! Elements at equal distances in a buffer, and their conversion to the numbers that a mesh contains.

use bytemuck::AnyBitPattern;

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// A signed byte.
    I8,
    /// A byte.
    U8,
    /// A signed integer of 16 bits.
    I16,
    /// An integer of 16 bits.
    U16,
    /// An integer of 32 bits.
    U32,
    /// A number.
    F32,
}

impl Component {
    /// By its number in the file.
    pub(super) fn new(number: u32) -> Option<Component> {
        Some(match number {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// Whether it can be an index.
    pub(super) fn is_unsigned(self) -> bool {
        matches!(self, Component::U8 | Component::U16 | Component::U32)
    }
}

/// `count` elements, the first at the start of `bytes`, the others `stride` bytes apart; all are within `bytes`.
#[derive(Clone, Copy)]
pub struct Strided<'a> {
    /// What holds them.
    pub bytes: &'a [u8],
    /// How many there are.
    pub count: usize,
    /// Bytes of an element.
    pub size: usize,
    /// Distance in bytes, at least the size of an element.
    pub stride: usize,
    /// What an element consists of.
    pub component: Component,
    /// Integers represent numbers in [0, 1] or [-1, 1].
    pub normalized: bool,
}

impl<'a> Strided<'a> {
    /// The elements in place, if they are contiguous, aligned, and in this machine's byte order.
    pub fn borrowed<T: AnyBitPattern>(&self) -> Option<&'a [T]> {
        let packed = self.stride == size_of::<T>() && cfg!(target_endian = "little");
        if packed { bytemuck::try_cast_slice(&self.bytes[..self.count * self.stride]).ok() } else { None }
    }

    /// Some of its elements, copied next to each other into `packed`.
    pub fn packed<'p>(&self, used: &[u32], packed: &'p mut Vec<u8>) -> Strided<'p> {
        packed.reserve_exact(used.len() * self.size);
        for &at in used {
            packed.extend_from_slice(&self.bytes[at as usize * self.stride..][..self.size]);
        }
        Strided { bytes: packed, count: used.len(), stride: self.size, ..*self }
    }

    /// The elements as vectors of numbers.
    pub fn numbers<const N: usize>(&self) -> Vec<[f32; N]> {
        match self.component {
            Component::I8 => self.scaled(|c: i8| f32::from(c), i8::MAX.into()),
            Component::U8 => self.scaled(|c: u8| f32::from(c), u8::MAX.into()),
            Component::I16 => self.scaled(|c: i16| f32::from(c), i16::MAX.into()),
            Component::U16 => self.scaled(|c: u16| f32::from(c), u16::MAX.into()),
            Component::U32 => self.each(|c: u32| c as f32),
            Component::F32 => self.each(|c: f32| c),
        }
    }

    /// The elements as integers, if that is their type.
    pub fn integers(&self) -> Vec<u32> {
        let elements: Vec<[u32; 1]> = match self.component {
            Component::U8 => self.each(|c: u8| c.into()),
            Component::U16 => self.each(|c: u16| c.into()),
            _ => self.each(|c: u32| c),
        };
        elements.into_iter().flatten().collect()
    }

    fn scaled<T: Stored, const N: usize>(&self, number: impl Fn(T) -> f32, largest: f32) -> Vec<[f32; N]> {
        if self.normalized {
            // A division, not a product with the reciprocal: the largest integer must become 1.
            self.each(|component| (number(component) / largest).max(-1.0))
        } else {
            self.each(number)
        }
    }

    fn each<T: Stored, U, const N: usize>(&self, convert: impl Fn(T) -> U) -> Vec<[U; N]> {
        let element = |bytes: &[u8]| std::array::from_fn(|i| convert(T::read(&bytes[i * size_of::<T>()..])));
        // The last chunk may end with its element.
        self.bytes.chunks(self.stride).take(self.count).map(element).collect()
    }
}

/// A component as stored in a file: little-endian.
trait Stored {
    /// Reads it from the start of `bytes`, which must be long enough.
    fn read(bytes: &[u8]) -> Self;
}

macro_rules! stored {
    ($($component:ty),*) => {$(
        impl Stored for $component {
            #[inline(always)]
            fn read(bytes: &[u8]) -> $component {
                <$component>::from_le_bytes(*bytes.first_chunk().expect("a whole component"))
            }
        }
    )*};
}

stored!(i8, u8, i16, u16, u32, f32);
