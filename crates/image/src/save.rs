//! Saving a [`Frame`]: the extension determines the format, and a file is written completely or not at all.
//!
//! Images are written to a temporary file next to the target and renamed over it, so an interrupted program leaves the previous
//! file intact. Several of them can appear together: see [`Frame::ready`]. [`check_writable`] detects problems before
//! any time is spent on rendering.

use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use lightmesh_files::{Output, Ready};

#[cfg(feature = "bmp")]
use crate::bmp;
#[cfg(feature = "exr")]
use crate::exr;
#[cfg(feature = "jpeg")]
use crate::jpg;
#[cfg(feature = "png")]
use crate::png;
use crate::{BitDepth, EncodeError, Format, Frame, SaveError, SaveOptions, Transfer};

/// Fails if `format` has fewer bits than requested, or no alpha.
fn check_storable(format: Format, options: &SaveOptions, has_alpha: bool) -> Result<(), EncodeError> {
    let is_plain = matches!(format, Format::Bmp | Format::Jpg);
    match (is_plain, has_alpha, options.display.bit_depth) {
        (true, true, _) => Err(EncodeError::Alpha { format }),
        (true, _, BitDepth::Sixteen) => Err(EncodeError::BitDepth { format }),
        _ => Ok(()),
    }
}

impl Frame {
    /// Saves the colours as bmp, png, exr or jpg, according to the extension of `path`; 8-bit formats use the sRGB curve.
    ///
    /// # Errors
    /// [`SaveError`]; the target is then unchanged.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.save_with(path, Transfer::Srgb)
    }

    /// As [`Frame::save`], with a given transfer function for 8-bit formats. An exr is always linear.
    ///
    /// # Errors
    /// [`SaveError`]; the target is then unchanged.
    pub fn save_with(&self, path: impl AsRef<Path>, transfer: Transfer) -> Result<(), SaveError> {
        publish(self.ready(path, transfer)?)
    }

    /// As [`Frame::save_with`], but the file appears only when it is published, together with others.
    ///
    /// # Errors
    /// [`SaveError`]; the target is then unchanged.
    pub fn ready(&self, path: impl AsRef<Path>, transfer: Transfer) -> Result<Ready, SaveError> {
        self.ready_with(path, &transfer.into())
    }

    /// As [`Frame::ready`], with all options.
    ///
    /// # Errors
    /// [`SaveError`]; the target is then unchanged.
    pub fn ready_with(&self, path: impl AsRef<Path>, options: &SaveOptions) -> Result<Ready, SaveError> {
        let path = path.as_ref();
        known_format(path, options)?;
        self.ready_to(Output::to(path)?, options)
    }

    /// As [`Frame::ready_with`], to an output that is already open, such as standard output. Its format is that of the
    /// options, or by the extension of its path.
    ///
    /// # Errors
    /// [`SaveError`]; nothing is written then.
    pub fn ready_to(&self, output: Output, options: &SaveOptions) -> Result<Ready, SaveError> {
        let format = known_format(output.path(), options)?;
        self.written(output, format, |output| self.write(format, options, output))
    }

    /// The bytes of a file of this format.
    ///
    /// # Errors
    /// [`EncodeError`] if the format cannot store the image so.
    pub fn encode(&self, format: Format, options: &SaveOptions) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        self.write(format, options, &mut bytes)?;
        Ok(bytes.into_inner())
    }

    fn write(
        &self,
        format: Format,
        options: &SaveOptions,
        output: &mut (impl Write + Seek),
    ) -> Result<(), EncodeError> {
        check_storable(format, options, self.alpha().is_some())?;
        match format {
            #[cfg(feature = "bmp")]
            Format::Bmp => bmp::write(self, &options.display, output),
            #[cfg(feature = "png")]
            Format::Png => png::write(self, &options.display, output),
            #[cfg(feature = "exr")]
            Format::Exr => exr::write(self, options, output),
            #[cfg(feature = "jpeg")]
            Format::Jpg => jpg::write(self, &options.display, output),
            #[allow(unreachable_patterns, reason = "unless all features are on")]
            other => Err(EncodeError::NotBuilt { format: other, feature: other.feature() }),
        }
    }

    #[cfg(feature = "png")]
    /// A PNG file of the colours, with the sRGB curve.
    ///
    /// # Errors
    /// [`EncodeError::TooLarge`] if a side is longer than 2147483647 pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        png::write(self, &crate::Display::default(), &mut bytes)?;
        Ok(bytes)
    }

    #[cfg(feature = "png")]
    /// The same, but smaller: with a palette if 256 colours suffice, as in difference images.
    ///
    /// # Errors
    /// As [`Frame::to_png`].
    pub fn to_small_png(&self) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::new();
        if png::write_indexed(self, &mut bytes)? { Ok(bytes) } else { self.to_png() }
    }

    #[cfg(feature = "exr")]
    /// Saves colours and layers as one multilayer exr of 32-bit floats with the channels `R G B` (linear), `Z` (distance
    /// along the ray), `A` if the frame has alpha, `N.X N.Y N.Z`, `P.X P.Y P.Z`, `V.0 V.1 …` (one per light) and `M` (light points used).
    ///
    /// # Errors
    /// [`SaveError::NoLayers`], [`SaveError::LayersNeedExr`], or as [`Frame::save`].
    pub fn save_layers(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        publish(self.ready_layers(path)?)
    }

    #[cfg(feature = "exr")]
    /// As [`Frame::save_layers`], but the file appears only when it is published, together with others.
    ///
    /// # Errors
    /// As [`Frame::save_layers`].
    pub fn ready_layers(&self, path: impl AsRef<Path>) -> Result<Ready, SaveError> {
        self.ready_layers_with(path, &SaveOptions::default())
    }

    #[cfg(feature = "exr")]
    /// As [`Frame::ready_layers`], with all options.
    ///
    /// # Errors
    /// As [`Frame::save_layers`].
    pub fn ready_layers_with(&self, path: impl AsRef<Path>, options: &SaveOptions) -> Result<Ready, SaveError> {
        let path = path.as_ref();
        if known_format(path, &SaveOptions::default())? != Format::Exr {
            return Err(SaveError::LayersNeedExr { path: path.to_owned() });
        }
        self.ready_layers_to(Output::to(path)?, options)
    }

    #[cfg(feature = "exr")]
    /// As [`Frame::ready_layers_with`], to an output that is already open, such as standard output.
    ///
    /// # Errors
    /// [`SaveError::NoLayers`] or [`SaveError::Write`].
    pub fn ready_layers_to(&self, output: Output, options: &SaveOptions) -> Result<Ready, SaveError> {
        let layers = self.layers().ok_or_else(|| SaveError::NoLayers { path: output.path().to_owned() })?;
        self.written(output, Format::Exr, |output| exr::write_layers(self, layers, options, output))
    }

    #[cfg(feature = "exr")]
    /// Writes values of the pixels, instead of colours, as an exr of 32-bit floats: a channel of each name.
    ///
    /// # Errors
    /// As [`Frame::save`].
    ///
    /// # Panics
    /// If a channel has not as many values as there are pixels.
    pub fn ready_values_to(
        &self,
        output: Output,
        channels: &[(&str, &[f32])],
        options: &SaveOptions,
    ) -> Result<Ready, SaveError> {
        assert!(channels.iter().all(|(_, values)| values.len() == self.color().len()), "a value for each pixel");
        self.written(output, Format::Exr, |output| exr::write_values(self, channels, options, output))
    }

    #[cfg(feature = "exr")]
    /// The bytes that [`Frame::save_layers`] would write.
    ///
    /// # Errors
    /// [`EncodeError::NoLayers`] if the frame has none.
    pub fn encode_layers(&self) -> Result<Vec<u8>, EncodeError> {
        self.encode_layers_with(&SaveOptions::default())
    }

    #[cfg(feature = "exr")]
    /// As [`Frame::encode_layers`], with all options.
    ///
    /// # Errors
    /// As [`Frame::encode_layers`].
    pub fn encode_layers_with(&self, options: &SaveOptions) -> Result<Vec<u8>, EncodeError> {
        let layers = self.layers().ok_or(EncodeError::NoLayers)?;
        let mut output = std::io::Cursor::new(Vec::new());
        exr::write_layers(self, layers, options, &mut output)?;
        Ok(output.into_inner())
    }

    #[cfg(feature = "exr")]
    /// The bytes that [`Frame::ready_values_to`] would write.
    ///
    /// # Errors
    /// [`EncodeError`] if the format cannot store the image.
    ///
    /// # Panics
    /// As [`Frame::ready_values_to`].
    pub fn encode_values(&self, channels: &[(&str, &[f32])], options: &SaveOptions) -> Result<Vec<u8>, EncodeError> {
        assert!(channels.iter().all(|(_, values)| values.len() == self.color().len()), "a value for each pixel");
        let mut output = std::io::Cursor::new(Vec::new());
        exr::write_values(self, channels, options, &mut output)?;
        Ok(output.into_inner())
    }

    /// Calls `write` to fill an output.
    fn written(
        &self,
        mut file: Output,
        format: Format,
        write: impl FnOnce(&mut BufWriter<&mut Output>) -> Result<(), EncodeError>,
    ) -> Result<Ready, SaveError> {
        let path = file.path().to_owned();
        let failed = |error| match error {
            EncodeError::TooLarge { limit } => {
                let (width, height) = (self.width(), self.height());
                SaveError::TooLarge { path: path.clone(), format, width, height, limit }
            }
            EncodeError::BitDepth { format } => SaveError::BitDepth { path: path.clone(), format },
            EncodeError::Alpha { format } => SaveError::Alpha { path: path.clone(), format },
            EncodeError::NotBuilt { format, .. } => SaveError::NotBuilt { path: path.clone(), format },
            EncodeError::NoLayers => SaveError::NoLayers { path: path.clone() },
            EncodeError::Io(reason) => SaveError::Write { path: path.clone(), reason },
        };
        let mut output = BufWriter::new(&mut file);
        write(&mut output).map_err(failed)?;
        output.flush().map_err(|reason| failed(reason.into()))?;
        drop(output);
        file.ready().map_err(|reason| failed(reason.into()))
    }
}

fn publish(file: Ready) -> Result<(), SaveError> {
    Ok(lightmesh_files::publish([file])?)
}

/// Checks that an image could be saved to `path`, without touching an existing one: the extension is known, the target is not a
/// directory, and a file can be created next to it (one is created and removed again).
///
/// # Errors
/// The [`SaveError`] that [`Frame::save`] would return.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), SaveError> {
    let path = path.as_ref();
    known_format(path, &SaveOptions::default())?;
    Ok(lightmesh_files::check_writable(path)?)
}

/// Checks that the format of an image at `path` is known, and can store an image of this size with these options, and
/// with alpha if it is to be transparent. Does not look at what is there.
///
/// # Errors
/// The [`SaveError`] that [`Frame::ready_with`] would return.
pub fn check_image(
    path: impl AsRef<Path>,
    options: &SaveOptions,
    [width, height]: [u32; 2],
    has_alpha: bool,
) -> Result<(), SaveError> {
    let path = path.as_ref();
    let format = known_format(path, options)?;
    if let Some(limit) = format.exceeded_limit(width, height) {
        return Err(SaveError::TooLarge { path: path.to_owned(), format, width, height, limit });
    }
    check_options(path, options, has_alpha)
}

/// Checks that the format of `path` supports images of this size.
///
/// # Errors
/// [`SaveError::TooLarge`] or [`SaveError::UnknownExtension`], as [`Frame::save`] would return.
pub fn check_size(path: impl AsRef<Path>, width: u32, height: u32) -> Result<(), SaveError> {
    check_image(path, &SaveOptions::default(), [width, height], false)
}

/// Checks that the format of `path` can store an image with these options, and with alpha if it is to be transparent.
///
/// # Errors
/// [`SaveError::BitDepth`], [`SaveError::Alpha`] or [`SaveError::UnknownExtension`], as [`Frame::ready_with`] would return.
pub fn check_options(path: impl AsRef<Path>, options: &SaveOptions, has_alpha: bool) -> Result<(), SaveError> {
    let path = path.as_ref();
    let format = known_format(path, options)?;
    check_storable(format, options, has_alpha).map_err(|error| match error {
        EncodeError::Alpha { .. } => SaveError::Alpha { path: path.to_owned(), format },
        _ => SaveError::BitDepth { path: path.to_owned(), format },
    })
}

fn known_format(path: &Path, options: &SaveOptions) -> Result<Format, SaveError> {
    let format = options.format_of(path).ok_or_else(|| SaveError::UnknownExtension { path: path.to_owned() })?;
    if format.is_built() { Ok(format) } else { Err(SaveError::NotBuilt { path: path.to_owned(), format }) }
}
