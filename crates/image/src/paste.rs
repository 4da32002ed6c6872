//! Frames that are put together of parts.

use rayon::prelude::*;

use crate::{Frame, Layers, Matte, Rank, Window};

/// Values that a task copies at least.
const TASK: usize = 1 << 14;

impl Frame {
    /// A black frame of `size` pixels from column and row `first` on of the image that `part` is of, with the planes that this has. `None` if it would have no
    /// pixel, or more than can be addressed.
    pub fn around(part: &Frame, first: [i32; 2], size: [u32; 2]) -> Option<Frame> {
        let pixels = crate::frame::pixel_count(size[0], size[1])?;
        let frame = Frame::new(size[0], size[1], vec![[0.0; 3]; pixels]).ok()?.with_window(first, part.window().whole);
        let frame = if part.alpha().is_some() { frame.with_alpha(vec![0.0; pixels]).ok()? } else { frame };
        match part.layers() {
            Some(layers) => frame.with_layers(layers.blank(pixels)).ok(),
            None => Some(frame),
        }
    }

    /// Copies `size` pixels from column and row `first` of the image on out of another frame of it, by all threads. `false` if one of them does not have all
    /// of these, or they have other planes.
    #[must_use]
    pub fn put(&mut self, part: &Frame, first: [i32; 2], size: [u32; 2]) -> bool {
        let (Some(to), Some(from)) = (self.corner(first, size), part.corner(first, size)) else { return false };
        let fits = self.window().whole == part.window().whole && self.alpha().is_some() == part.alpha().is_some();
        let widths = [self.width(), part.width()].map(|width| width as usize);
        let paste = Paste { corners: [to, from], widths, size: size.map(|pixels| pixels as usize) };
        let layers = match (&mut self.layers, &part.layers) {
            (Some(to), Some(from)) if fits => to.put(from, &paste),
            (None, None) => fits,
            _ => false,
        };
        if layers {
            paste.plane(&mut self.color, &part.color);
            if let (Some(to), Some(from)) = (&mut self.alpha, &part.alpha) {
                paste.plane(to, from);
            }
        }
        layers
    }

    /// Where a rectangle of the whole image begins in the frame; `None` if the frame does not have all of it, or it has no pixel.
    pub(crate) fn corner(&self, first: [i32; 2], size: [u32; 2]) -> Option<[usize; 2]> {
        let Window { first: start, .. } = self.window();
        let own = [self.width(), self.height()];
        let within = |axis: usize| {
            let offset = u32::try_from(i64::from(first[axis]) - i64::from(start[axis])).ok()?;
            let is_within = size[axis] > 0 && u64::from(offset) + u64::from(size[axis]) <= u64::from(own[axis]);
            is_within.then_some(offset as usize)
        };
        Some([within(0)?, within(1)?])
    }
}

impl Layers {
    /// The same planes for so many pixels, of zeros.
    fn blank(&self, pixels: usize) -> Layers {
        Layers {
            depth: vec![0.0; pixels],
            normal: vec![[0.0; 3]; pixels],
            position: vec![[0.0; 3]; pixels],
            visibility: vec![vec![0.0; pixels]; self.visibility.len()],
            used: vec![0; pixels],
            lights: vec![vec![[0.0; 3]; pixels]; self.lights.len()],
            rest: if self.rest.is_empty() { Vec::new() } else { vec![[0.0; 3]; pixels] },
            object: self.object.blank(pixels),
            material: self.material.blank(pixels),
        }
    }

    fn put(&mut self, part: &Layers, paste: &Paste) -> bool {
        let counts = |layers: &Layers| (layers.visibility.len(), layers.lights.len(), layers.rest.is_empty());
        let fits = counts(self) == counts(part) && self.object.fits(&part.object) && self.material.fits(&part.material);
        if !fits {
            return false;
        }
        paste.plane(&mut self.depth, &part.depth);
        paste.plane(&mut self.normal, &part.normal);
        paste.plane(&mut self.position, &part.position);
        paste.planes(&mut self.visibility, &part.visibility);
        paste.plane(&mut self.used, &part.used);
        paste.planes(&mut self.lights, &part.lights);
        paste.plane(&mut self.rest, &part.rest);
        self.object.put(&part.object, paste);
        self.material.put(&part.material, paste);
        true
    }
}

impl Matte {
    fn blank(&self, pixels: usize) -> Matte {
        if self.is_empty() {
            return self.clone();
        }
        let names = self.names.clone();
        let nearest = if self.nearest.is_empty() { Vec::new() } else { vec![0; pixels] };
        Matte { nearest, ..Matte::nothing(names, self.ranks.len(), pixels) }
    }

    fn fits(&self, part: &Matte) -> bool {
        let counts = |matte: &Matte| (matte.nearest.is_empty(), matte.ranks.len());
        counts(self) == counts(part) && self.names == part.names
    }

    fn put(&mut self, part: &Matte, paste: &Paste) {
        paste.plane(&mut self.nearest, &part.nearest);
        for (Rank { number, share }, part) in self.ranks.iter_mut().zip(&part.ranks) {
            paste.plane(number, &part.number);
            paste.plane(share, &part.share);
        }
    }
}

/// A rectangle that is copied to a plane from another one.
struct Paste {
    /// Where it begins in each of them.
    corners: [[usize; 2]; 2],
    /// The width of each.
    widths: [usize; 2],
    size: [usize; 2],
}

impl Paste {
    /// Planes that are not kept are empty.
    fn plane<T: Copy + Send + Sync>(&self, to: &mut [T], from: &[T]) {
        if from.is_empty() {
            return;
        }
        let ([to_width, from_width], [columns, rows]) = (self.widths, self.size);
        let [[to_x, to_y], [from_x, from_y]] = self.corners;
        let to = to[to_y * to_width..(to_y + rows) * to_width].par_chunks_exact_mut(to_width);
        let from = from[from_y * from_width..(from_y + rows) * from_width].par_chunks_exact(from_width);
        // Memory that is touched for the first time takes longer than the copy.
        to.zip(from)
            .with_min_len(TASK.div_ceil(columns))
            .for_each(|(to, from)| to[to_x..to_x + columns].copy_from_slice(&from[from_x..from_x + columns]));
    }

    fn planes<T: Copy + Send + Sync>(&self, to: &mut [Vec<T>], from: &[Vec<T>]) {
        to.iter_mut().zip(from).for_each(|(to, from)| self.plane(to, from));
    }
}
