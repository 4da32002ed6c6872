//! Kernels that exist once per acceleration structure.

use lightmesh_layout::Structure;

use crate::cuda::Kernel;

/// The kernels that `KERNEL_PER_STRUCTURE` generates from one function, one per structure. Created by [`per_structure!`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerStructure {
    pub(crate) module: &'static str,
    /// In the order of [`Structure`].
    pub(crate) names: [&'static str; 3],
}

impl PerStructure {
    /// The kernel that walks `structure`.
    pub(crate) fn of(self, structure: Structure) -> Kernel {
        Kernel { module: self.module, name: self.names[structure as usize] }
    }
}

/// The kernels of a module that `KERNEL_PER_STRUCTURE` generates from the function `name`.
macro_rules! per_structure {
    ($module:literal, $name:literal) => {
        $crate::gpu::PerStructure { module: $module, names: lightmesh_layout::names_per_structure!($name) }
    };
}

pub(crate) use per_structure;
