//! What a device keeps from image to image: geometry, textures, environments, and the template of the light mesh.

use std::sync::{Arc, Weak};

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::Structure;
use lightmesh_layout::scene::{EnvironmentLevel, Scene, Texture};

use crate::prepared::TransmissionParts;

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
    /// The same with the structures for shadow rays, if some surfaces are not opaque.
    pub(super) transmission_parts: Option<TransmissionParts<Scene>>,
    pub(super) structure: Structure,
    /// What the record points to.
    #[expect(dead_code, reason = "only kept")]
    pub(super) buffers: Buffers<R>,
    #[expect(dead_code, reason = "only kept")]
    pub(super) textures: Arc<DeviceTextures<R>>,
}

/// The images of a geometry's materials on a device.
pub(super) struct DeviceTextures<R: Runtime> {
    pub(super) records: Vec<Texture>,
    /// What the records point to.
    #[expect(dead_code, reason = "only kept")]
    pub(super) texels: Buffers<R>,
}

/// An environment on a device: its levels.
pub(super) struct DeviceEnvironment<R: Runtime> {
    pub(super) levels: Buffer<R, EnvironmentLevel>,
    /// Those for light that is gathered, if they are others.
    pub(super) gathered: Option<Buffer<R, EnvironmentLevel>>,
    /// What the levels point to.
    #[expect(dead_code, reason = "only kept")]
    pub(super) texels: Buffers<R>,
}

/// The copies that a device holds of what is on the host, each for as long as that lives there.
pub(super) struct Resident<T, Copy> {
    copies: Vec<(Weak<T>, Arc<Copy>)>,
}

impl<T, Copy> Default for Resident<T, Copy> {
    fn default() -> Resident<T, Copy> {
        Resident { copies: Vec::new() }
    }
}

impl<T, Copy> Resident<T, Copy> {
    /// Frees the copies of what no longer exists, and finds the copy of `original`.
    pub(super) fn find(&mut self, original: &Arc<T>) -> Option<Arc<Copy>> {
        self.copies.retain(|(known, _)| known.strong_count() > 0);
        let (_, copy) = self.copies.iter().find(|(known, _)| known.as_ptr() == Arc::as_ptr(original))?;
        Some(Arc::clone(copy))
    }

    /// Keeps a copy in place of an earlier one.
    pub(super) fn insert(&mut self, original: &Arc<T>, copy: Arc<Copy>) {
        self.copies.retain(|(known, _)| known.as_ptr() != Arc::as_ptr(original));
        self.copies.push((Arc::downgrade(original), copy));
    }
}

/// Buffers that are only kept.
pub(super) type Buffers<R> = Vec<Box<dyn AnyBuffer<R>>>;

/// A buffer of any type.
pub(super) trait AnyBuffer<R>: Send + Sync {}

impl<R: Runtime, T: 'static> AnyBuffer<R> for Buffer<R, T> {}
