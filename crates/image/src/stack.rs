//! Frames one below the other, as one.

use crate::{Frame, Layers, Matte};

impl Frame {
    /// One frame of parts of an image, from its top to its bottom: each begins in the row where the one before it ends. `None` if there are none, or
    /// they do not fit: of another width or image, with other planes, or not one below the other.
    pub fn stacked(parts: Vec<Frame>) -> Option<Frame> {
        let mut parts = parts.into_iter();
        let mut all = parts.next()?;
        for part in parts {
            all.append(part)?;
        }
        Some(all)
    }

    fn append(&mut self, below: Frame) -> Option<()> {
        let ([left, top], [x, y]) = (self.window.first, below.window.first);
        let follows = x == left && i64::from(y) == i64::from(top) + i64::from(self.height);
        if !follows || self.width != below.width || self.window.whole != below.window.whole {
            return None;
        }
        match (&mut self.alpha, below.alpha) {
            (Some(alpha), Some(more)) => alpha.extend(more),
            (None, None) => {}
            _ => return None,
        }
        match (&mut self.layers, below.layers) {
            (Some(layers), Some(more)) => layers.append(more)?,
            (None, None) => {}
            _ => return None,
        }
        self.height = self.height.checked_add(below.height)?;
        self.color.extend(below.color);
        Some(())
    }
}

impl Layers {
    fn append(&mut self, below: Layers) -> Option<()> {
        let Layers { depth, normal, position, visibility, used, lights, rest, object, material } = below;
        self.depth.extend(depth);
        self.normal.extend(normal);
        self.position.extend(position);
        self.used.extend(used);
        self.rest.extend(rest);
        append_each(&mut self.visibility, visibility, |all, more| Some(all.extend(more)))?;
        append_each(&mut self.lights, lights, |all, more| Some(all.extend(more)))?;
        self.object.append(object)?;
        self.material.append(material)
    }
}

impl Matte {
    fn append(&mut self, below: Matte) -> Option<()> {
        if self.names != below.names {
            return None;
        }
        self.nearest.extend(below.nearest);
        append_each(&mut self.ranks, below.ranks, |all, more| {
            all.number.extend(more.number);
            Some(all.share.extend(more.share))
        })
    }
}

/// Appends each of as many things to one of others.
fn append_each<T>(all: &mut [T], more: Vec<T>, append: impl Fn(&mut T, T) -> Option<()>) -> Option<()> {
    (all.len() == more.len()).then_some(())?;
    all.iter_mut().zip(more).try_for_each(|(all, more)| append(all, more))
}
