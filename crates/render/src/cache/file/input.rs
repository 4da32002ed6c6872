//! Content of a mesh file that is read, number by number. Memory is taken as numbers appear, whatever counts say.

use std::io::Read;

use glam::Vec3;
use lightmesh_memory::{Budget, OverBudget};

use super::fault::MeshFault;

/// Numbers that are read at once.
const AT_ONCE: usize = 1 << 16;

/// What is not compressed as it should be.
const UNPACKED: MeshFault = MeshFault::Damaged("it cannot be decompressed");

/// Content that is read, and the memory for it.
pub(super) struct Input<R> {
    pub(super) inner: R,
    pub(super) budget: Budget,
    /// Bytes of requests that were each too small to be checked.
    pub(super) unchecked: u64,
}

impl<R: Read> Input<R> {
    pub(super) fn bytes<const N: usize>(&mut self) -> Result<[u8; N], MeshFault> {
        let mut bytes = [0; N];
        self.inner.read_exact(&mut bytes).map_err(|_| UNPACKED)?;
        Ok(bytes)
    }

    pub(super) fn int(&mut self) -> Result<u32, MeshFault> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub(super) fn long(&mut self) -> Result<u64, MeshFault> {
        self.bytes().map(u64::from_le_bytes)
    }

    pub(super) fn float(&mut self) -> Result<f32, MeshFault> {
        self.bytes().map(f32::from_le_bytes)
    }

    pub(super) fn vector(&mut self) -> Result<Vec3, MeshFault> {
        Ok(Vec3::new(self.float()?, self.float()?, self.float()?))
    }

    /// `count` numbers of `N` bytes each.
    pub(super) fn numbers<const N: usize, T>(
        &mut self,
        count: u64,
        number: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, MeshFault> {
        let mut numbers = Vec::new();
        let mut bytes = vec![0; N * AT_ONCE.min(count as usize)];
        let mut left = count;
        while left > 0 {
            let some = left.min(AT_ONCE as u64) as usize;
            let bytes = &mut bytes[..N * some];
            self.inner.read_exact(bytes).map_err(|_| UNPACKED)?;
            self.hold(&numbers, some)?;
            numbers.extend(bytes.as_chunks::<N>().0.iter().map(|&bytes| number(bytes)));
            left -= some as u64;
        }
        Ok(numbers)
    }

    /// Asks for memory for `more` values: growing takes twice as much as there is, while it is moved.
    pub(super) fn hold<T>(&mut self, values: &Vec<T>, more: usize) -> Result<(), MeshFault> {
        if values.len() + more > values.capacity() {
            // A budget lets small requests pass; a thousand of them are not small.
            self.unchecked += (2 * (values.len() + more) * size_of::<T>()) as u64;
            short(self.unchecked, self.budget)?;
            if self.unchecked >= Budget::SMALL {
                self.unchecked = 0;
            }
        }
        Ok(())
    }

    /// The difference between two keys that ascend.
    pub(super) fn difference(&mut self) -> Result<u64, MeshFault> {
        let mut value = 0;
        for shift in (0..u64::BITS).step_by(7) {
            let [byte] = self.bytes()?;
            let digits = u64::from(byte & 0x7f);
            if digits << shift >> shift != digits {
                break;
            }
            value |= digits << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(MeshFault::Damaged("its keys are not in order"))
    }
}

/// What does not fit.
fn short(needed: u64, budget: Budget) -> Result<(), MeshFault> {
    budget.check(needed).map_err(|short: OverBudget| MeshFault::Memory(short))
}
