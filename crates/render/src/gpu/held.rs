//! What a device keeps from image to image: geometry, and the template of the light mesh.

use std::sync::{Arc, Weak};

use lightmesh_layout::Structure;
use lightmesh_layout::scene::Scene;

use crate::cuda::{Buffer, Runtime};
use crate::prepared::PreparedGeometry;

/// A template on a device.
pub(super) struct DeviceTemplate<R: Runtime> {
    pub(super) radius: f32,
    pub(super) lines: u32,
    pub(super) offsets: Buffer<R, u32>,
    pub(super) rows: Buffer<R, u32>,
}

/// Geometry on a device, with the structure that rays traverse.
pub(crate) struct DeviceGeometry<R: Runtime> {
    /// The part of the record that describes geometry.
    pub(super) record: Scene,
    pub(super) structure: Structure,
    /// What the record points to.
    #[expect(dead_code, reason = "only kept")]
    pub(super) buffers: Buffers<R>,
}

/// The copies of geometry that a device holds, each for as long as the prepared geometry lives.
pub(super) struct Resident<R: Runtime> {
    copies: Vec<(Weak<PreparedGeometry>, Arc<DeviceGeometry<R>>)>,
}

impl<R: Runtime> Default for Resident<R> {
    fn default() -> Resident<R> {
        Resident { copies: Vec::new() }
    }
}

impl<R: Runtime> Resident<R> {
    /// Frees the copies of geometry that no longer exists, and finds the copy of `geometry`.
    pub(super) fn find(&mut self, geometry: &Arc<PreparedGeometry>) -> Option<Arc<DeviceGeometry<R>>> {
        self.copies.retain(|(known, _)| known.strong_count() > 0);
        let (_, copy) = self.copies.iter().find(|(known, _)| known.as_ptr() == Arc::as_ptr(geometry))?;
        Some(Arc::clone(copy))
    }

    /// Keeps a copy in place of an earlier one.
    pub(super) fn keep(&mut self, geometry: &Arc<PreparedGeometry>, copy: Arc<DeviceGeometry<R>>) {
        self.copies.retain(|(known, _)| known.as_ptr() != Arc::as_ptr(geometry));
        self.copies.push((Arc::downgrade(geometry), copy));
    }
}

/// Buffers that are only kept.
pub(super) type Buffers<R> = Vec<Box<dyn Held<R>>>;

/// A buffer of any type.
pub(super) trait Held<R>: Send + Sync {}

impl<R: Runtime, T: 'static> Held<R> for Buffer<R, T> {}
