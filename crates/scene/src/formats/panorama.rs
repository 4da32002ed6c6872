//! Panoramas from files: Radiance HDR and OpenEXR, through the `image` crate. Files are untrusted: sizes are checked before memory is
//! allocated for them.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, guess_format};
use lightmesh_files::{Portion, ReadError, read};
use lightmesh_memory::{Budget, OverBudget};

use crate::build::textures::decode::checked_texels;
use crate::{Environment, Up};

/// The longest side, in texels.
const MAX_SIDE: u32 = 32768;
/// Bytes of a texel: three floats, and four of its means; or while it is decoded, which is more, four floats twice.
const BYTES_PER_TEXEL: u64 = 32;
/// No texel of a compressed file takes less than this: run lengths in HDR files, and deflate.
const MAX_TEXELS_PER_BYTE: u64 = 1032;
/// Radiances above this are errors of cameras and programs.
const BRIGHTEST: f32 = 1e9;

/// Why a file is no environment.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The file system returned an error.
    #[error("cannot read the environment ({cause}), {}; check that it exists and is readable", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        cause: std::io::Error,
    },
    /// It is a folder, a device or a pipe.
    #[error("the environment is no regular file, {}; give an .hdr or .exr image", path.display())]
    NoFile {
        /// The file.
        path: PathBuf,
    },
    /// It is not an image that can be used.
    #[error("the environment cannot be used ({problem}), {}; give an equirectangular .hdr or .exr image, twice as wide as high", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// It does not fit into memory.
    #[error("there is not enough memory for {what}: {short}, {}; give a smaller image, or raise the memory limit", path.display())]
    Memory {
        /// The file.
        path: PathBuf,
        /// What would be held: the file itself, or its texels.
        what: String,
        /// How much memory is missing.
        short: OverBudget,
    },
}

impl Environment {
    /// The panorama in a file, which may be anywhere, with the [sun](Environment::find_sun) and
    /// [other lights](Environment::find_lights) apart.
    ///
    /// # Errors
    /// [`EnvironmentError`]
    pub fn open(path: &Path, up: Up, budget: Budget) -> Result<Environment, EnvironmentError> {
        let bytes = read(path, Portion { budget, ..Portion::ALL }).map_err(|error| match error {
            ReadError::System(cause) => EnvironmentError::Read { path: path.to_owned(), cause },
            ReadError::Memory(short) => {
                EnvironmentError::Memory { path: path.to_owned(), what: "the file".to_owned(), short }
            }
            _ => EnvironmentError::NoFile { path: path.to_owned() },
        })?;
        Environment::decode(path, &bytes, up, budget)
    }

    /// The same from the content of the file at `path`.
    ///
    /// # Errors
    /// [`EnvironmentError::Malformed`] and [`EnvironmentError::Memory`].
    pub(crate) fn decode(path: &Path, bytes: &[u8], up: Up, budget: Budget) -> Result<Environment, EnvironmentError> {
        let malformed = |problem: String| EnvironmentError::Malformed { path: path.to_owned(), problem };
        let format = match guess_format(bytes) {
            Ok(format @ (ImageFormat::Hdr | ImageFormat::OpenExr)) => format,
            _ => return Err(malformed("it is neither a Radiance HDR nor an OpenEXR image".to_owned())),
        };
        let damaged = |error: image::ImageError| malformed(format!("its data are damaged or not supported: {error}"));
        let mut decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder().map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        let texels = checked_texels([width, height], MAX_SIDE, MAX_TEXELS_PER_BYTE, bytes).map_err(malformed)?;
        let what = || format!("an environment of {width}x{height} texels");
        let memory = |short| EnvironmentError::Memory { path: path.to_owned(), what: what(), short };
        budget.check(BYTES_PER_TEXEL * texels).map_err(memory)?;
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(BYTES_PER_TEXEL * texels + (16 << 20));
        decoder.set_limits(limits).map_err(damaged)?;
        let picture = DynamicImage::from_decoder(decoder).map_err(damaged)?.into_rgb32f();
        // What is negative, infinite or undefined is an error of a camera or a program, and no light.
        let usable = |value: f32| if value > 0.0 { value.min(BRIGHTEST) } else { 0.0 };
        let texels = picture.into_raw().as_chunks::<3>().0.iter().map(|texel| texel.map(usable)).collect();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(Environment::new(name, [width, height], texels, up).find_sun().find_lights())
    }
}
