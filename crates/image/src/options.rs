//! [`SaveOptions`]: everything about how a frame becomes a file.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::{Display, Format, Transfer};

/// How a frame is saved.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SaveOptions {
    /// The format; `None`: by the extension of the path.
    pub format: Option<Format>,
    /// For bmp, png and jpg.
    pub display: Display,
    /// For exr.
    pub exr: ExrOptions,
    /// What exr files say about the image.
    pub description: Description,
}

impl SaveOptions {
    /// Sets the format, whatever the extension of the path; `None`: by the extension.
    pub fn with_format(self, format: impl Into<Option<Format>>) -> Self {
        Self { format: format.into(), ..self }
    }

    /// The format of an image at `path`; `None` if that is unknown.
    pub fn format_of(&self, path: &Path) -> Option<Format> {
        self.format.or_else(|| Format::from_path(path))
    }

    /// Sets how bmp, png and jpg files show colours.
    pub fn with_display(self, display: Display) -> Self {
        Self { display, ..self }
    }

    /// Sets how exr files store values.
    pub fn with_exr(self, exr: ExrOptions) -> Self {
        Self { exr, ..self }
    }

    /// Sets what exr files say about the image.
    pub fn with_description(self, description: Description) -> Self {
        Self { description, ..self }
    }
}

impl From<Transfer> for SaveOptions {
    fn from(transfer: Transfer) -> Self {
        Self::default().with_display(Display::default().with_transfer(transfer))
    }
}

/// How exr files store values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct ExrOptions {
    /// Numbers of colours, alpha, normals and visibility. Depth, positions and counts, which halves are too coarse for, are always floats,
    /// as are mattes; ids are whole numbers.
    pub samples: ExrSamples,
    /// How blocks are compressed; nothing is lost in any case.
    pub compression: ExrCompression,
    /// How layers are divided.
    pub parts: ExrParts,
}

impl ExrOptions {
    /// Sets the kind of numbers.
    pub fn with_samples(self, samples: ExrSamples) -> Self {
        Self { samples, ..self }
    }

    /// Sets the compression.
    pub fn with_compression(self, compression: ExrCompression) -> Self {
        Self { compression, ..self }
    }

    /// Sets how layers are divided.
    pub fn with_parts(self, parts: ExrParts) -> Self {
        Self { parts, ..self }
    }
}

/// Names of the variants of an option, and its parser.
macro_rules! words {
    ($type:ident, $what:literal, $($variant:ident $name:literal $help:literal),+) => {
        impl $type {
            /// All of them, in the order used by messages.
            pub const ALL: &'static [$type] = &[$($type::$variant),+];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self { $($type::$variant => $name),+ }
            }

            /// A short description of its purpose.
            pub fn help(self) -> &'static str {
                match self { $($type::$variant => $help),+ }
            }
        }

        impl fmt::Display for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.name())
            }
        }

        impl FromStr for $type {
            type Err = UnknownWord;

            fn from_str(name: &str) -> Result<$type, UnknownWord> {
                let found = $type::ALL.iter().find(|word| word.name() == name);
                let known = || $type::ALL.iter().map(|word| word.name()).collect::<Vec<_>>().join(", ");
                found.copied().ok_or_else(|| UnknownWord { what: $what, name: name.to_owned(), known: known() })
            }
        }
    };
}

/// A word that is not the name of an option.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} `{name}`; available: {known}")]
pub struct UnknownWord {
    what: &'static str,
    name: String,
    known: String,
}

/// Numbers of an exr file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ExrSamples {
    /// 32 bits: exactly what was rendered.
    #[default]
    Float,
    /// 16 bits: 11 of precision up to 65504, to which larger values are lowered.
    Half,
}

words!(
    Format, "image format",
    Bmp "bmp" "8 bits, not compressed",
    Png "png" "8 or 16 bits",
    Exr "exr" "Linear floats",
    Jpg "jpg" "8 bits, lossy"
);

words!(
    ExrSamples, "kind of numbers",
    Float "float" "32 bits, exactly as rendered",
    Half "half" "16 bits: half the size, 3 digits; depth, positions, counts and mattes stay float"
);

/// Lossless compression of exr files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ExrCompression {
    /// Deflate in blocks of 16 rows.
    #[default]
    Zip,
    /// Deflate by row: for programs that read few rows at a time.
    Zips,
    /// Wavelets: small files of noisy images.
    Piz,
    /// Run lengths: fast.
    Rle,
    /// Nothing is compressed.
    None,
}

words!(
    ExrCompression, "compression",
    Zip "zip" "Deflate in blocks of 16 rows",
    Zips "zips" "Deflate by row, for programs that read few rows at a time",
    Piz "piz" "Wavelets, for noisy images",
    Rle "rle" "Run lengths: fast",
    None "none" "No compression"
);

/// The parts of an exr file with layers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ExrParts {
    /// One part with all channels, which every program reads.
    #[default]
    Single,
    /// A part for each kind of layer, of which programs read only what they need.
    Multi,
}

words!(
    ExrParts, "number of parts",
    Single "single" "One part with all channels, which every program reads",
    Multi "multi" "One part for each kind of layer: programs read only what they need"
);

/// What an exr file says about in the format's standard attributes.
///
/// Matrices multiply row vectors from the right, as in OpenEXR: (x, y, z, 1) · M, in row-major order.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Description {
    /// The program, `software`.
    pub software: Option<String>,
    /// The scene's name, `lightmesh:scene`.
    pub scene: Option<String>,
    /// Settings as text, `comments`.
    pub settings: Option<String>,
    /// `worldToCamera`: to x to the right, y up, −z into the image.
    pub world_to_camera: Option<[f32; 16]>,
    /// `worldToNDC`: to x and y from −1 at the left and bottom edge to 1 at the right and top edge.
    pub world_to_ndc: Option<[f32; 16]>,
}

impl Description {
    /// Sets the program's name and version.
    pub fn with_software(self, software: impl Into<String>) -> Self {
        Self { software: Some(software.into()), ..self }
    }

    /// Sets the scene's name.
    pub fn with_scene(self, scene: impl Into<String>) -> Self {
        Self { scene: Some(scene.into()), ..self }
    }

    /// Sets the text of the settings.
    pub fn with_settings(self, settings: impl Into<String>) -> Self {
        Self { settings: Some(settings.into()), ..self }
    }

    /// Sets the matrices of the camera.
    pub fn with_camera(self, world_to_camera: [f32; 16], world_to_ndc: [f32; 16]) -> Self {
        Self { world_to_camera: Some(world_to_camera), world_to_ndc: Some(world_to_ndc), ..self }
    }
}
