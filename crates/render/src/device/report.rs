//! The devices of this machine, and why some of them cannot be used.

use lightmesh_kernels::{Driver, Gpu, Library, Runtime, Version, capability, visible_devices};
use serde::Serialize;

use super::Device;

/// A device that was detected or searched for, and whether it can be used.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct DeviceReport {
    /// `cpu`, `cuda` or `cuda:N`.
    pub device: String,
    /// The vendor's name for it, if the system reports one.
    pub name: String,
    /// Whether images can be rendered on it.
    pub usable: bool,
    /// If not usable, why not and what to do; otherwise further information.
    pub remark: String,
    /// Memory of a CUDA device in bytes.
    pub memory_bytes: Option<u64>,
    /// How much of it is free; known if the device can be used.
    pub free_bytes: Option<u64>,
    /// Compute capability of a CUDA device, such as `9.0`.
    pub compute_capability: Option<String>,
    /// The CUDA version that the driver supports, such as `12.4`.
    pub driver_cuda_version: Option<String>,
}

/// All devices: the CPU, then every CUDA device that the driver reports, or one entry `cuda` that says why there is none. Each
/// CUDA device is initialised briefly, to check that it works and how much memory is free.
pub fn devices() -> Vec<DeviceReport> {
    let cuda = match Library::open() {
        Ok(library) => library.devices.iter().map(|gpu| report(&library, gpu)).collect(),
        Err(why) => {
            vec![DeviceReport { device: "cuda".to_owned(), remark: why.explained(), ..DeviceReport::default() }]
        }
    };
    std::iter::once(cpu()).chain(cuda).collect()
}

/// The CPU.
pub(super) fn cpu() -> DeviceReport {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    DeviceReport {
        device: Device::Cpu.to_string(),
        name: cpu_name(),
        usable: true,
        remark: format!("{threads} threads, {}", simd_name()),
        ..DeviceReport::default()
    }
}

/// A CUDA device that can be used.
pub(super) fn ready(driver: &Driver) -> DeviceReport {
    let free = driver.free_memory();
    let remark = facts(driver.gpu(), free, driver.version(), visible_devices().as_deref());
    DeviceReport { usable: true, remark, free_bytes: free, ..described(driver.gpu(), driver.version()) }
}

/// A CUDA device of which nothing is known but what the driver says of it.
pub(super) fn unopened(gpu: &Gpu, version: Version) -> DeviceReport {
    let remark = facts(gpu, None, version, visible_devices().as_deref());
    DeviceReport { remark, ..described(gpu, version) }
}

fn report(library: &Library, gpu: &Gpu) -> DeviceReport {
    match library.ready(gpu) {
        Ok(driver) => ready(&driver),
        Err(remark) => DeviceReport { remark, ..described(gpu, library.version) },
    }
}

/// What is known about a CUDA device whether it can be used or not.
pub fn described(gpu: &Gpu, version: Version) -> DeviceReport {
    DeviceReport {
        device: Device::Cuda(Some(gpu.number)).to_string(),
        name: gpu.name.clone(),
        memory_bytes: Some(gpu.memory),
        compute_capability: Some(capability(gpu.capability)),
        driver_cuda_version: Some(version.to_string()),
        ..DeviceReport::default()
    }
}

/// The properties of a CUDA device, in one line.
pub fn facts(gpu: &Gpu, free: Option<u64>, version: Version, visible: Option<&str>) -> String {
    let gibibytes = |bytes: u64| format!("{:.1} GiB", bytes as f64 / f64::from(1 << 30));
    let (memory, capability) = (gibibytes(gpu.memory), capability(gpu.capability));
    let free = free.map_or_else(String::new, |free| format!(" ({} free)", gibibytes(free)));
    let visible = visible.map_or_else(String::new, |value| format!(", numbered by CUDA_VISIBLE_DEVICES={value}"));
    format!("{memory}{free}, compute capability {capability}, driver for CUDA {version}{visible}")
}

/// Which of the two versions of the SIMD code runs on this machine.
fn simd_name() -> &'static str {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if fearless_simd::Level::new().as_avx2().is_some() {
        return "AVX2";
    }
    "baseline SIMD"
}

/// The CPU's name, or its architecture if the system does not report one.
pub(crate) fn cpu_name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
