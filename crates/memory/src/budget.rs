//! What a computation may use of the machine's memory.

use crate::{Bytes, available, ceiling, held};

/// One part in this many of the free memory is left to others, unless a limit was given.
const RESERVE: u64 = 8;

/// The memory that this process may hold: a limit, or what is free less a reserve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Budget {
    limit: Option<u64>,
}

/// An allocation that would exceed the budget.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq, Eq)]
#[error("{} are needed, but only {} are left{}", Bytes(*needed), Bytes(*left), self.of())]
pub struct OverBudget {
    /// Bytes to allocate.
    pub needed: u64,
    /// Bytes that may still be allocated.
    pub left: u64,
    /// The limit, if one was set; otherwise the machine's memory is short.
    pub limit: Option<u64>,
}

impl OverBudget {
    fn of(&self) -> String {
        self.limit.map_or_else(String::new, |limit| format!(" of {}", Bytes(limit)))
    }
}

impl Budget {
    /// At most `limit` bytes for all that the process holds; `None`: what is free, less a reserve.
    pub const fn new(limit: Option<u64>) -> Budget {
        Budget { limit }
    }

    /// Allocations of fewer bytes pass unchecked, as they are not worth asking the system: a million of them would be noticed by the
    /// [allocator](crate::Counting).
    pub const SMALL: u64 = 1 << 20;

    /// The limit that was set.
    pub fn limit(&self) -> Option<u64> {
        self.limit
    }

    /// Bytes that may still be allocated. `None` if there is no limit and the system does not say.
    pub fn left(&self) -> Option<u64> {
        match self.limit {
            // A generous limit does not make the machine larger.
            Some(limit) => {
                let left = ceiling().map_or(limit, |ceiling| ceiling.min(limit)).saturating_sub(held());
                Some(available().map_or(left, |available| available.min(left)))
            }
            None => available().map(|free| free - free / RESERVE),
        }
    }

    /// Whether `needed` bytes may be allocated; to be called before they are.
    ///
    /// # Errors
    /// [`OverBudget`] if they exceed what is left.
    pub fn check(&self, needed: u64) -> Result<(), OverBudget> {
        if needed < Budget::SMALL {
            return Ok(());
        }
        match self.left() {
            Some(left) if needed > left => Err(OverBudget { needed, left, limit: self.limit }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_exceeds_the_limit_is_refused_with_numbers() {
        let budget = Budget::new(Some(1 << 30));
        assert_eq!(budget.check(2 << 20), Ok(()));
        let short = budget.check(1 << 30).unwrap_err();
        assert!((short.left < 1 << 30) && short.needed == 1 << 30 && short.limit == Some(1 << 30), "{short:?}");
        let short = OverBudget { needed: 3 << 30, left: 1 << 19, limit: Some(1 << 30) };
        assert_eq!(short.to_string(), "3.0 GiB are needed, but only 512 KiB are left of 1.0 GiB");
        let short = OverBudget { limit: None, ..short };
        assert_eq!(short.to_string(), "3.0 GiB are needed, but only 512 KiB are left");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_limit_above_the_machines_memory_is_no_promise() {
        let left = Budget::new(Some(u64::MAX)).left().unwrap();
        assert!(left < 1 << 60, "{left}");
        assert!(Budget::default().check(1 << 60).is_err());
    }
}
