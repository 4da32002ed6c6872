//! Which object each triangle belongs to.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// The object of triangles that nobody named.
pub const UNNAMED: &str = "unnamed";

/// What tells an object from all others: its name, and of those that may share one, such as nodes of a file, a number.
///
/// ```
/// use lightmesh_scene::ObjectKey;
///
/// let chairs = [1, 2].map(|number| ObjectKey::numbered("chair", number));
/// assert!(chairs[0] != chairs[1] && chairs[0].name() == chairs[1].name());
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct ObjectKey {
    name: Arc<str>,
    /// 0: it is known by its name alone.
    number: u32,
}

impl ObjectKey {
    /// One of the objects that may share this name, by its number among all of these, from 1 on.
    pub fn numbered(name: &str, number: u32) -> ObjectKey {
        ObjectKey { number, ..name.into() }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// The object that is known by its name alone; an empty one is [`UNNAMED`].
impl From<&str> for ObjectKey {
    fn from(name: &str) -> ObjectKey {
        ObjectKey { name: if name.is_empty() { UNNAMED } else { name }.into(), number: 0 }
    }
}

impl From<&ObjectKey> for ObjectKey {
    fn from(key: &ObjectKey) -> ObjectKey {
        key.clone()
    }
}

impl From<String> for ObjectKey {
    fn from(name: String) -> ObjectKey {
        name.as_str().into()
    }
}

/// The objects of a mesh. Triangles that follow each other mostly belong to one object: runs of them are stored. Objects that are begun by the same
/// name are one; those with [keys](ObjectKey) of their own may share a name.
///
/// ```
/// use lightmesh_scene::Objects;
///
/// let mut objects = Objects::default();
/// objects.begin(0, "floor");
/// objects.begin(2, "box");
/// assert_eq!([0, 1, 2, 9].map(|triangle| objects.name(objects.of(triangle))), ["floor", "floor", "box", "box"]);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Objects {
    keys: Vec<ObjectKey>,
    numbers: HashMap<ObjectKey, u32>,
    /// The first triangle of each run, ascending; that of the first run is 0.
    starts: Vec<u32>,
    /// The object of each run.
    objects: Vec<u32>,
}

impl Objects {
    /// Triangles from number `first` on belong to this object, for example one of a name. Runs begin in the order of triangles: a `first` below the
    /// last one counts as that.
    pub fn begin(&mut self, first: usize, object: impl Into<ObjectKey>) {
        // Triangles are numbered in 32 bits.
        let first = u32::try_from(first).unwrap_or(u32::MAX).max(self.starts.last().copied().unwrap_or(0));
        if self.starts.is_empty() && first > 0 {
            self.begin(0, UNNAMED);
        }
        let object = self.number(object);
        if self.starts.last() == Some(&first) {
            self.starts.pop();
            self.objects.pop();
        }
        if self.objects.last() != Some(&object) {
            self.starts.push(first);
            self.objects.push(object);
        }
    }

    /// The number of an object; a new one if it is new.
    pub(crate) fn number(&mut self, object: impl Into<ObjectKey>) -> u32 {
        let (key, added) = (object.into(), self.keys.len() as u32);
        if let Some(&known) = self.numbers.get(&key) {
            return known;
        }
        self.keys.push(key.clone());
        self.numbers.insert(key, added);
        added
    }

    /// The number of a triangle's object.
    #[inline]
    pub fn of(&self, triangle: u32) -> u32 {
        let run = self.starts.partition_point(|&start| start <= triangle);
        run.checked_sub(1).map_or(0, |run| self.objects[run])
    }

    /// Number of objects, at least one: all triangles belong to some.
    pub fn count(&self) -> usize {
        self.keys.len().max(1)
    }

    /// The name of an object by number.
    pub fn name(&self, object: u32) -> &str {
        self.keys.get(object as usize).map_or(UNNAMED, ObjectKey::name)
    }

    /// What tells an object from all others, by number.
    pub(crate) fn key(&self, object: u32) -> ObjectKey {
        self.keys.get(object as usize).map_or_else(|| UNNAMED.into(), ObjectKey::clone)
    }

    /// All names by number; some may be the same.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        (0..self.count()).map(|object| self.name(object as u32))
    }

    /// The runs: the first triangle of each, ascending from 0, and its object. None if nothing was named.
    pub fn runs(&self) -> (&[u32], &[u32]) {
        (&self.starts, &self.objects)
    }

    /// The triangles below `end` in runs, each with its object; one run if nothing was named.
    pub fn ranges(&self, end: u32) -> impl Iterator<Item = (Range<u32>, u32)> {
        let next = self.starts.iter().skip(1).copied().chain([u32::MAX]);
        let runs = self.starts.iter().zip(next).zip(&self.objects);
        let named = runs.map(move |((&start, next), &object)| (start..next.min(end), object));
        let unnamed = self.starts.is_empty().then_some((0..end, 0));
        named.chain(unnamed).filter(|(run, _)| !run.is_empty())
    }

    /// Continues with the objects of another mesh, whose triangles are added from number `first` on: `place` says where each of its triangles
    /// is among those that are added.
    pub(crate) fn append(&mut self, first: usize, other: &Objects, place: impl Fn(u32) -> usize) {
        for (&start, &object) in other.starts.iter().zip(&other.objects) {
            self.begin(first + place(start), other.key(object));
        }
    }

    /// Without some triangles: those after them move up.
    pub(crate) fn without(&self, triangles: Range<u32>) -> Objects {
        let mut rest = Objects::default();
        let place = |start: u32| start.min(triangles.start) + start.saturating_sub(triangles.end.max(triangles.start));
        for (&start, &object) in self.starts.iter().zip(&self.objects) {
            rest.begin(place(start) as usize, self.key(object));
        }
        rest
    }
}
