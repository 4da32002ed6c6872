//! What a suite gathers while it runs.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use lightmesh::image::{EncodeError, Frame};

use crate::{Picture, Row};

/// Rows, pictures and notes so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// One row for each thing that was measured.
    pub rows: Vec<Row>,
    /// Pictures that go with the rows.
    pub pictures: Vec<Picture>,
    /// What was left out and why; a sentence each.
    pub notes: Vec<String>,
    /// Devices that were used, as in `cuda:0`.
    pub devices: Vec<String>,
}

impl Picture {
    /// Packs a frame in 8 bits, sRGB. Its id is made from experiment and title, which must be the same in every run.
    ///
    /// # Errors
    /// [`EncodeError`] where the frame is too large for a PNG file.
    pub fn new(experiment: &str, title: &str, frame: &Frame) -> Result<Picture, EncodeError> {
        Ok(Picture {
            id: format!("{experiment}: {title}"),
            experiment: experiment.to_owned(),
            title: title.to_owned(),
            reference: None,
            png: STANDARD.encode(frame.to_png()?),
        })
    }

    /// The same picture, to be held against another.
    pub fn against(self, reference: &Picture) -> Picture {
        Picture { reference: Some(reference.id.clone()), ..self }
    }
}
