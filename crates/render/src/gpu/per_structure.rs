//! Kernels that look up triangles: which module a scene takes, and which kernel of it for its acceleration structure.
//!
//! Tests of what is cut out take registers from loops over triangles, even where nothing is; so do look-ups of instances. Therefore a kernel file
//! with such kernels is compiled twice:
//!
//! * where the tests cost an opaque scene more than 3 % of a stage's time (`DOUBLED`), once without and once with all of it: `<module>` is for
//!   opaque scenes, `<module>_alpha_test` for those with cut-outs or instances;
//! * elsewhere, `<module>` has the tests, behind a condition that is the same for all threads, and `<module>_instanced` is for scenes with instances.
//!
//! What that costs is in `bench/kernels/README.md`.

use lightmesh_kernels::{Kernel, Runtime};
use lightmesh_layout::Structure;

use super::DeviceScene;

/// The modules that exist without and with tests of what is cut out.
const DOUBLED: &[&str] = &["occluder_lists", "pixel_samples", "primary_rays", "short_tests"];

/// The modules that one kernel file is compiled to. Created by [`modules!`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modules {
    pub(crate) plain: &'static str,
    /// For scenes in which triangles are cut out, or that have instances; if doubled.
    pub(crate) alpha_test: &'static str,
    /// For scenes that have instances; if not.
    pub(crate) instanced: &'static str,
}

impl Modules {
    /// The module for `scene`.
    fn of<R: Runtime>(self, scene: &DeviceScene<R>) -> &'static str {
        let is_doubled = DOUBLED.contains(&self.plain);
        match scene.structure {
            Structure::InstancedBvh if !is_doubled => self.instanced,
            _ if is_doubled && scene.alpha_test => self.alpha_test,
            _ => self.plain,
        }
    }
}

/// The modules of a kernel file.
macro_rules! modules {
    ($module:literal) => {
        $crate::gpu::Modules {
            plain: $module,
            alpha_test: concat!($module, "_alpha_test"),
            instanced: concat!($module, "_instanced"),
        }
    };
}

pub(crate) use modules;

/// The kernels that `KERNEL_PER_STRUCTURE` generates from one function, one per structure. Created by [`per_structure!`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerStructure {
    pub(crate) modules: Modules,
    /// In the order of [`Structure`].
    pub(crate) names: [&'static str; 4],
}

impl PerStructure {
    /// The kernel that walks the structure of `scene`.
    pub(crate) fn of<R: Runtime>(self, scene: &DeviceScene<R>) -> Kernel {
        Kernel { module: self.modules.of(scene), name: self.names[scene.structure as usize] }
    }
}

/// A kernel that looks up what rays see, in all modules of a kernel file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerModule {
    pub(crate) modules: Modules,
    pub(crate) name: &'static str,
}

impl PerModule {
    /// The kernel for `scene`.
    pub(crate) fn of<R: Runtime>(self, scene: &DeviceScene<R>) -> Kernel {
        Kernel { module: self.modules.of(scene), name: self.name }
    }
}

/// The kernel `name` of a module and of its other one.
macro_rules! per_module {
    ($module:literal, $name:literal) => {
        $crate::gpu::PerModule { modules: $crate::gpu::modules!($module), name: $name }
    };
}

pub(crate) use per_module;

/// The kernels of a module that `KERNEL_PER_STRUCTURE` generates from the function `name`.
macro_rules! per_structure {
    ($module:literal, $name:literal) => {
        $crate::gpu::PerStructure {
            modules: $crate::gpu::modules!($module),
            names: lightmesh_layout::names_per_structure!($name),
        }
    };
}

pub(crate) use per_structure;
