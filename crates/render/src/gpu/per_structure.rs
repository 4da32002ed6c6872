//! Kernels that exist once per acceleration structure.

#[cfg(doc)]
use lightmesh_layout::Structure;

use super::DeviceScene;
use crate::cuda::{Kernel, Runtime};

/// The kernels that `KERNEL_PER_STRUCTURE` generates from one function, one per structure. Created by [`per_structure!`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerStructure {
    pub(crate) module: &'static str,
    /// The same for scenes in which triangles are cut out, or that have instances.
    pub(crate) cut_out_module: &'static str,
    /// In the order of [`Structure`].
    pub(crate) names: [&'static str; 4],
}

impl PerStructure {
    /// The kernel that walks the structure of `scene`.
    pub(crate) fn of<R: Runtime>(self, scene: &DeviceScene<R>) -> Kernel {
        let module = if scene.cut_out { self.cut_out_module } else { self.module };
        Kernel { module, name: self.names[scene.structure as usize] }
    }
}

/// A kernel that looks up what rays see, in both modules.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerModule {
    pub(crate) module: &'static str,
    pub(crate) cut_out_module: &'static str,
    pub(crate) name: &'static str,
}

impl PerModule {
    /// The kernel for `scene`.
    pub(crate) fn of<R: Runtime>(self, scene: &DeviceScene<R>) -> Kernel {
        let PerModule { module, cut_out_module, name } = self;
        Kernel { module: if scene.cut_out { cut_out_module } else { module }, name }
    }
}

/// The kernel `name` of a module and of that for scenes in which triangles are cut out, or that have instances.
macro_rules! per_module {
    ($module:literal, $name:literal) => {
        $crate::gpu::PerModule { module: $module, cut_out_module: concat!($module, "_cut_out"), name: $name }
    };
}

pub(crate) use per_module;

/// The kernels of a module that `KERNEL_PER_STRUCTURE` generates from the function `name`.
macro_rules! per_structure {
    ($module:literal, $name:literal) => {
        $crate::gpu::PerStructure {
            module: $module,
            cut_out_module: concat!($module, "_cut_out"),
            names: lightmesh_layout::names_per_structure!($name),
        }
    };
}

pub(crate) use per_structure;
