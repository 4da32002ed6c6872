//! The orientation of nodes.

use std::path::Path;

use glam::DVec3;

use super::{container::malformed, nodes::Placed};
use crate::{LoadError, formats::toml::unit};

/// Directions of nodes of one file.
pub(super) struct Axes<'a> {
    pub(super) path: &'a Path,
}

impl Axes<'_> {
    /// −Z of the node in the world; unit length.
    pub(super) fn forward(&self, placed: &Placed) -> Result<DVec3, LoadError> {
        unit(-placed.transform.z_axis.truncate()).ok_or_else(|| self.flat(placed))
    }

    /// +Y of the node in the world; unit length.
    pub(super) fn up(&self, placed: &Placed) -> Result<DVec3, LoadError> {
        unit(placed.transform.y_axis.truncate()).ok_or_else(|| self.flat(placed))
    }

    /// The error for a node without these directions.
    pub(super) fn flat(&self, placed: &Placed) -> LoadError {
        let node = placed.index;
        malformed(self.path, format!("node {node} has a camera or light but no orientation (a scale of 0)"))
    }
}
