//! NVIDIA's driver library: whether it is installed, its version, and the devices it reports.
//!
//! The library is loaded on first use, so that the same program starts on systems without it. cudarc looks up each symbol at
//! its first call, and panics if one is missing; so nothing beyond [`FIRST`] is called before the driver's version is known to
//! be new enough.

use cudarc::driver::sys::CUdevice_attribute_enum as Attribute;
use cudarc::driver::sys::{self, CUresult};
use cudarc::driver::{DriverError, result};

use super::fault::describe;
use super::ptx::Needs;
use crate::gpu::{Gpu, Version, capability, visible_devices};

/// The functions called before the version is known. All of them are in every driver since CUDA 6.0 (2014).
const FIRST: [&str; 4] = ["cuInit", "cuDriverGetVersion", "cuGetErrorName", "cuGetErrorString"];

/// Why CUDA cannot be used at all.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unavailable {
    /// NVIDIA has no driver for this operating system.
    #[error("CUDA is not available for {0}")]
    NoPlatform(&'static str),
    /// The driver is not installed.
    #[error("NVIDIA's driver is not installed")]
    NoLibrary {
        /// The file that was searched for.
        library: &'static str,
        /// The first branch that is sufficient.
        needed: u32,
    },
    /// Another library has this name, or the driver is very old.
    #[error("the CUDA library that was found lacks {symbol}: install NVIDIA's driver, version {needed} or newer")]
    NotADriver {
        /// The missing function.
        symbol: &'static str,
        /// The first branch that is sufficient.
        needed: u32,
    },
    /// The driver does not support the kernels' PTX version.
    #[error(
        "the driver supports CUDA {version}, but CUDA {} is needed: install NVIDIA's driver {} or newer",
        needs.cuda,
        needs.driver
    )]
    TooOld {
        /// The CUDA version it supports.
        version: Version,
        /// The requirements.
        needs: Needs,
    },
    /// The user has hidden all devices.
    #[error("CUDA_VISIBLE_DEVICES is \"{0}\" and hides every device: unset it, or set it to the devices to use")]
    Hidden(String),
    /// The driver reports no device.
    #[error("the driver finds no CUDA device: check whether `nvidia-smi` lists one")]
    NoDevice,
    /// Any other error, as described by the driver.
    #[error("the driver does not start ({0}): check whether `nvidia-smi` works; after a driver update, reboot")]
    Failed(String),
}

impl Unavailable {
    /// Why, and what to do. A machine without a driver is an ordinary one, so that the short message says no more.
    pub fn explained(&self) -> String {
        match self {
            Unavailable::NoLibrary { library, needed } => format!(
                "{self} ({library} was not found): install version {needed} or newer; a container must be started with \
                 access to the GPUs"
            ),
            other => other.to_string(),
        }
    }

    /// Whether the machine may have no CUDA device at all, so that there is nothing to mend.
    pub fn is_ordinary(&self) -> bool {
        match self {
            Unavailable::NoPlatform(_) => true,
            Unavailable::NoLibrary { .. } => !has_nvidia_card(),
            _ => false,
        }
    }
}

/// Whether the system lists a graphics card of NVIDIA's. Known on Linux only.
fn has_nvidia_card() -> bool {
    const NVIDIA: &str = "0x10de";
    /// Display controllers, in the upper byte of the class.
    const DISPLAY: &str = "0x03";
    let cards = std::fs::read_dir("/sys/bus/pci/devices").into_iter().flatten().flatten();
    let starts =
        |path: std::path::PathBuf, start| std::fs::read_to_string(path).is_ok_and(|text| text.starts_with(start));
    cards.map(|card| card.path()).any(|card| starts(card.join("vendor"), NVIDIA) && starts(card.join("class"), DISPLAY))
}

/// The initialised driver, with the devices it reports.
#[derive(Clone, Debug)]
pub struct Library {
    /// The CUDA version it supports.
    pub version: Version,
    /// At least one.
    pub devices: Vec<Gpu>,
}

impl Library {
    /// Initialises the driver and lists its devices.
    pub fn open() -> Result<Library, Unavailable> {
        let needs = Needs::of_kernels();
        present(needs)?;
        let version = version().map_err(|error| Unavailable::Failed(describe(error)))?;
        if version < needs.cuda {
            return Err(Unavailable::TooOld { version, needs });
        }
        let devices = result::init().and_then(|()| devices());
        match devices {
            Ok(devices) if !devices.is_empty() => Ok(Library { version, devices }),
            Ok(_) | Err(DriverError(CUresult::CUDA_ERROR_NO_DEVICE)) => {
                Err(visible_devices().map_or(Unavailable::NoDevice, Unavailable::Hidden))
            }
            Err(error) => Err(Unavailable::Failed(describe(error))),
        }
    }
}

impl Gpu {
    /// Why the kernels cannot run on this device; `None` if they can.
    pub fn refusal(&self, needs: Needs) -> Option<String> {
        let [has, wants] = [self.capability, needs.capability].map(capability);
        (self.capability < needs.capability).then(|| {
            format!("compute capability {has}, but {wants} is needed (GeForce RTX 20, Quadro RTX, T4 or newer)")
        })
    }
}

/// Checks that the library is installed and has the functions of [`FIRST`].
fn present(needs: Needs) -> Result<(), Unavailable> {
    if cfg!(target_vendor = "apple") {
        return Err(Unavailable::NoPlatform(std::env::consts::OS));
    }
    let needed = needs.driver;
    // SAFETY: loads the library by its own name; running its initialisers is the purpose of loading a driver.
    if !unsafe { sys::is_culib_present() } {
        let library = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };
        return Err(Unavailable::NoLibrary { library, needed });
    }
    // SAFETY: the library is installed, so this does not panic; the symbols are looked up, not called.
    let library = unsafe { sys::culib() };
    let missing = FIRST.iter().find(|symbol| {
        // SAFETY: any function may be viewed as a pointer of this type.
        unsafe { library.get::<unsafe extern "C" fn()>(symbol.as_bytes()) }.is_err()
    });
    missing.map_or(Ok(()), |&symbol| Err(Unavailable::NotADriver { symbol, needed }))
}

/// The CUDA version that the driver supports. May be called before the driver is initialised.
fn version() -> Result<Version, DriverError> {
    let mut code = 0;
    // SAFETY: writes one number.
    unsafe { sys::cuDriverGetVersion(&mut code) }.result()?;
    Ok(Version::from_code(code))
}

fn devices() -> Result<Vec<Gpu>, DriverError> {
    let count = u32::try_from(result::device::get_count()?).unwrap_or(0);
    (0..count).map(device).collect()
}

fn device(number: u32) -> Result<Gpu, DriverError> {
    let handle = result::device::get(number as i32)?;
    let attribute = |attribute| {
        // SAFETY: the driver returned this device.
        unsafe { result::device::get_attribute(handle, attribute) }
    };
    let major = attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)?;
    let minor = attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)?;
    let pools = attribute(Attribute::CU_DEVICE_ATTRIBUTE_MEMORY_POOLS_SUPPORTED)?;
    // SAFETY: as above.
    let memory = unsafe { result::device::total_mem(handle) }? as u64;
    Ok(Gpu {
        number,
        name: result::device::get_name(handle)?,
        capability: (major * 10 + minor) as u32,
        memory,
        pools: pools != 0,
        handle,
    })
}
