//! The key of a cached column: everything that determines what light points see of one light.

use lightmesh_scene::{Light, LightKind};

use crate::render_context::Sampling;
use crate::sampling::body;

/// What determines the values of a column, apart from the light's index, which is the column's.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnKey {
    /// The shape of the light.
    pub kind: LightKind,
    /// Whether it is an emissive ball, which hides none of its light.
    pub glows: bool,
    /// Samples and seed, for an area light.
    pub sampling: Option<(u32, u64)>,
}

impl ColumnKey {
    pub(crate) fn of(light: &Light, sampling: &Sampling) -> ColumnKey {
        let sampling = light.has_size().then_some((sampling.samples, sampling.seed));
        ColumnKey { kind: light.kind.clone(), glows: body(light) > 0.0, sampling }
    }

    /// The shape of the light.
    pub(crate) fn kind(&self) -> &LightKind {
        &self.kind
    }

    /// Number of rays from each light point.
    pub(crate) fn samples(&self) -> u32 {
        self.sampling.map_or(1, |(samples, _)| samples)
    }

    /// Whether values are shares rather than bits.
    pub(crate) fn is_share(&self) -> bool {
        self.sampling.is_some()
    }
}
