//! NVIDIA's compilers, fetched with pip.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The pinned packages, in pip's format.
const REQUIREMENTS: &str = "xtask/cuda-tools.txt";

/// The compilers.
pub(super) struct Tools {
    /// NVRTC, the compiler from CUDA C++ to PTX.
    pub(super) nvrtc: PathBuf,
    /// Its version: major and minor.
    pub(super) nvrtc_version: (i32, i32),
    /// The assembler from PTX to machine code.
    pub(super) ptxas: PathBuf,
    /// Its pinned version.
    pub(super) ptxas_version: String,
}

/// The pinned versions.
pub(super) struct Versions {
    pub(super) nvrtc: String,
    pub(super) ptxas: String,
}

/// Reads the pinned versions; nothing is installed.
pub(super) fn versions() -> Result<Versions, Box<dyn Error>> {
    let requirements = requirements()?;
    Ok(Versions {
        nvrtc: pinned(&requirements, "nvidia-cuda-nvrtc-cu12")?,
        ptxas: pinned(&requirements, "nvidia-cuda-nvcc-cu12")?,
    })
}

fn requirements() -> Result<String, String> {
    fs::read_to_string(REQUIREMENTS).map_err(|error| format!("cannot read {REQUIREMENTS}: {error}"))
}

/// Returns the pinned compilers; installs them into `folder` if they are missing.
pub(super) fn install(folder: &Path) -> Result<Tools, Box<dyn Error>> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Err("the pinned CUDA compilers run on x86-64 Linux; build the kernels there".into());
    }
    let requirements = requirements()?;
    let stamp = folder.join("installed.txt");
    if fs::read_to_string(&stamp).ok().as_ref() != Some(&requirements) {
        fetch(folder)?;
        fs::write(&stamp, &requirements)?;
    }
    let nvrtc_version = pinned(&requirements, "nvidia-cuda-nvrtc-cu12")?;
    let mut parts = nvrtc_version.split('.').map(str::parse);
    let (Some(Ok(major)), Some(Ok(minor))) = (parts.next(), parts.next()) else {
        return Err(format!("{REQUIREMENTS}: '{nvrtc_version}' is not a version").into());
    };
    Ok(Tools {
        nvrtc: fs::canonicalize(folder.join(format!("nvidia/cuda_nvrtc/lib/libnvrtc.so.{major}")))?,
        nvrtc_version: (major, minor),
        ptxas: fs::canonicalize(folder.join("nvidia/cuda_nvcc/bin/ptxas"))?,
        ptxas_version: pinned(&requirements, "nvidia-cuda-nvcc-cu12")?,
    })
}

/// The version of a package.
fn pinned(requirements: &str, package: &str) -> Result<String, String> {
    let version =
        |line: &str| Some(line.strip_prefix(package)?.strip_prefix("==")?.split_whitespace().next()?.to_owned());
    requirements.lines().find_map(version).ok_or_else(|| format!("{REQUIREMENTS} does not pin {package}"))
}

/// Runs pip to fetch the wheels, check their hashes and unpack them.
fn fetch(folder: &Path) -> Result<(), Box<dyn Error>> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    let output = Command::new("python3")
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile", "--no-deps"])
        .args(["--only-binary", ":all:", "--require-hashes", "--requirement", REQUIREMENTS, "--target"])
        .arg(folder)
        .output()
        .map_err(|error| format!("cannot run python3, whose pip fetches the CUDA compilers: {error}"))?;
    if !output.status.success() {
        return Err(
            format!("pip cannot fetch the CUDA compilers: {}", String::from_utf8_lossy(&output.stderr).trim()).into()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_the_requirements() {
        let requirements = "# some==1.0\nsome-tool==1.2.3 --hash=sha256:00\nsome==12.0.76\n";
        assert_eq!(pinned(requirements, "some").as_deref(), Ok("12.0.76"));
        assert_eq!(pinned(requirements, "some-tool").as_deref(), Ok("1.2.3"));
        assert!(pinned(requirements, "other").is_err());
    }
}
