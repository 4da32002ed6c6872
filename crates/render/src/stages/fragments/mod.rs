//! Fragments: what is shaded of the pixels that are not shared.
//!
//! In: the samples of pixels, and the radiance of those that are shared. Out: three lists of rays, shared fragments, single samples and
//! mirror samples.
//!
//! 1. A shared pixel is *split* if a neighbour on the same surface differs so much in radiance that sharing may be seen: at the
//!    edge of a hard shadow or at a highlight.
//! 2. The samples of each pixel that is not shared are parted by surface. Each part is a shared fragment, shaded at the first of its
//!    samples. But the samples of a split pixel, and of surfaces that let rays through, are single. *Mirror samples* are not shaded: where
//!    shared pixels and fragments mirror, each sample shows what is in the mirror, or every second one in faint mirrors.
//! 3. The radiance of these pixels so far is discarded.

pub(crate) mod cpu;
pub(crate) mod cuda;
