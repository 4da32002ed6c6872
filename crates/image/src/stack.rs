//! Frames one below the other, as one.

use rayon::prelude::*;

use crate::{Frame, FrameParts, Layers, Matte, Rank, Window};

/// Values that a task copies.
const TASK: usize = 1 << 16;

impl Frame {
    /// One frame of parts of an image, from its top to its bottom: each begins in the row where the one before it ends. `None` if there are none, or
    /// they do not fit: of another width or image, with other planes, or not one below the other.
    pub fn stacked(parts: Vec<Frame>) -> Option<Frame> {
        let Window { first: [left, top], whole } = parts.first()?.window();
        let (width, mut height) = (parts.first()?.width(), 0);
        for part in &parts {
            let first = [left, top.checked_add_unsigned(height)?];
            if part.window() != (Window { first, whole }) || part.width() != width {
                return None;
            }
            height = height.checked_add(part.height())?;
        }
        let (mut colors, mut alphas, mut layers) = (Vec::new(), Vec::new(), Vec::new());
        for part in parts {
            let FrameParts { color, alpha, layers: planes, .. } = part.into_parts();
            colors.push(color);
            alphas.push(alpha);
            layers.push(planes);
        }
        let mut all = Frame::new(width, height, joined(colors)).ok()?.with_window([left, top], whole);
        if let Some(alphas) = all_or_none(alphas)? {
            all = all.with_alpha(joined(alphas)).ok()?;
        }
        match all_or_none(layers)? {
            Some(layers) => all.with_layers(Layers::stacked(layers)?).ok(),
            None => Some(all),
        }
    }
}

impl Layers {
    fn stacked(mut parts: Vec<Layers>) -> Option<Layers> {
        Some(Layers {
            depth: joined(each(&mut parts, |part| &mut part.depth)),
            normal: joined(each(&mut parts, |part| &mut part.normal)),
            position: joined(each(&mut parts, |part| &mut part.position)),
            visibility: planes(each(&mut parts, |part| &mut part.visibility))?,
            used: joined(each(&mut parts, |part| &mut part.used)),
            lights: planes(each(&mut parts, |part| &mut part.lights))?,
            rest: joined(each(&mut parts, |part| &mut part.rest)),
            object: Matte::stacked(each(&mut parts, |part| &mut part.object))?,
            material: Matte::stacked(each(&mut parts, |part| &mut part.material))?,
        })
    }
}

impl Matte {
    fn stacked(mut parts: Vec<Matte>) -> Option<Matte> {
        let names = std::mem::take(&mut parts.first_mut()?.names);
        if parts.iter().skip(1).any(|part| part.names != names) {
            return None;
        }
        let ranks = transposed(each(&mut parts, |part| &mut part.ranks))?;
        let rank = |mut parts: Vec<Rank>| Rank {
            number: joined(each(&mut parts, |part| &mut part.number)),
            share: joined(each(&mut parts, |part| &mut part.share)),
        };
        let nearest = joined(each(&mut parts, |part| &mut part.nearest));
        Some(Matte { names, nearest, ranks: ranks.into_iter().map(rank).collect() })
    }
}

/// Takes something out of each part.
fn each<P, T: Default>(parts: &mut [P], of: impl Fn(&mut P) -> &mut T) -> Vec<T> {
    parts.iter_mut().map(|part| std::mem::take(of(part))).collect()
}

/// What all have, or `Some(None)` if none has it.
fn all_or_none<T>(parts: Vec<Option<T>>) -> Option<Option<Vec<T>>> {
    if parts.iter().all(Option::is_none) { Some(None) } else { Some(Some(parts.into_iter().collect::<Option<_>>()?)) }
}

/// Planes of which each part has as many.
fn planes<T: Copy + Default + Send + Sync>(parts: Vec<Vec<Vec<T>>>) -> Option<Vec<Vec<T>>> {
    Some(transposed(parts)?.into_iter().map(joined).collect())
}

/// From parts that have as many things each to things that have parts.
fn transposed<T>(parts: Vec<Vec<T>>) -> Option<Vec<Vec<T>>> {
    let count = parts.first()?.len();
    let mut things: Vec<Vec<T>> = (0..count).map(|_| Vec::new()).collect();
    for part in parts {
        (part.len() == count).then_some(())?;
        things.iter_mut().zip(part).for_each(|(thing, part)| thing.push(part));
    }
    Some(things)
}

/// One after the other; by all threads, since the memory of large pictures is touched for the first time.
fn joined<T: Copy + Default + Send + Sync>(mut parts: Vec<Vec<T>>) -> Vec<T> {
    if parts.len() == 1 {
        return parts.remove(0);
    }
    let mut all = vec![T::default(); parts.iter().map(Vec::len).sum()];
    let mut rest = &mut *all;
    let mut tasks = Vec::new();
    for part in &parts {
        let (own, others) = rest.split_at_mut(part.len());
        tasks.extend(own.chunks_mut(TASK).zip(part.chunks(TASK)));
        rest = others;
    }
    tasks.into_par_iter().for_each(|(to, from)| to.copy_from_slice(from));
    all
}
