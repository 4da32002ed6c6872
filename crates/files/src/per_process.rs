//! What a process that was forked does not share with its parent.
//!
//! A child has its parent's memory and none of its threads: a lock that one of these held in the moment of the fork is never released, and threads that
//! work is handed to are not there.

use std::mem;
use std::process;
use std::sync::OnceLock;

/// What each process has for itself: a child neither uses nor drops what its parent made.
///
/// ```
/// use std::convert::Infallible;
/// use std::sync::Mutex;
///
/// use lightmesh_files::PerProcess;
///
/// let list = PerProcess::new(Mutex::new(vec![1]));
/// let Ok(own) = list.get_or_make(|| Ok::<_, Infallible>(Mutex::default()));
/// assert_eq!(*own.lock().unwrap(), [1]);
/// ```
#[derive(Debug)]
pub struct PerProcess<T> {
    process: u32,
    /// `None` only while it is dropped.
    value: Option<T>,
    /// That of a child, in the memory of the child.
    child: OnceLock<Box<PerProcess<T>>>,
}

impl<T> PerProcess<T> {
    /// That of this process.
    pub fn new(value: T) -> PerProcess<T> {
        PerProcess { process: process::id(), value: Some(value), child: OnceLock::new() }
    }

    /// That of this process, if it is the one which made the first.
    pub fn own(&self) -> Option<&T> {
        self.value.as_ref().filter(|_| self.process == process::id())
    }

    /// That of this process, made if it has none yet.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get_or_make<E>(&self, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
        if let Some(own) = self.own() {
            return Ok(own);
        }
        if let Some(child) = self.child.get() {
            return child.get_or_make(make);
        }
        // Made before the lock is taken, which is thus held for a moment only.
        let made = Box::new(PerProcess::new(make()?));
        let kept = self.child.get_or_init(|| made);
        Ok(kept.own().expect("it was made by this process"))
    }
}

impl<T> Drop for PerProcess<T> {
    fn drop(&mut self) {
        if self.process != process::id() {
            // Its threads and devices are the parent's, and so are files that it would remove.
            mem::forget(self.value.take());
        }
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::sync::Arc;

    use super::*;

    /// As it is in a child, whose id is another one.
    fn inherited(value: &Arc<str>) -> PerProcess<Arc<str>> {
        PerProcess { process: 0, value: Some(Arc::clone(value)), child: OnceLock::new() }
    }

    #[test]
    fn a_child_makes_its_own_once() {
        let parents: Arc<str> = "parent".into();
        let value = inherited(&parents);
        assert_eq!(value.own(), None);
        let made = |text: &str| value.get_or_make(|| Ok::<_, Infallible>(text.into())).map(|own| own.to_string());
        assert_eq!([made("first"), made("second")], [Ok("first".to_owned()), Ok("first".to_owned())]);
        // A child of the child.
        let grandchild = PerProcess { process: 0, value: Some("grandparent".into()), child: OnceLock::new() };
        grandchild.child.set(Box::new(inherited(&parents))).unwrap();
        let own = grandchild.get_or_make(|| Ok::<Arc<str>, Infallible>("own".into())).unwrap();
        assert_eq!(&**own, "own");
    }

    #[test]
    fn what_cannot_be_made_is_asked_for_again() {
        let value = inherited(&"parent".into());
        assert_eq!(value.get_or_make(|| Err("no")), Err("no"));
        assert_eq!(value.get_or_make(|| Ok::<_, &str>("own".into())).unwrap(), &Arc::from("own"));
    }

    #[test]
    fn a_child_drops_only_its_own() {
        let (parents, own): (Arc<str>, Arc<str>) = ("parent".into(), "own".into());
        let value = inherited(&parents);
        value.get_or_make(|| Ok::<_, Infallible>(Arc::clone(&own))).unwrap();
        drop(value);
        assert_eq!((Arc::strong_count(&parents), Arc::strong_count(&own)), (2, 1));
        drop(PerProcess::new(Arc::clone(&own)));
        assert_eq!(Arc::strong_count(&own), 1);
    }
}
