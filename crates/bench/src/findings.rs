//! Results collected while a suite runs.

use lightmesh::image::{EncodeError, Frame};

use crate::{Picture, Row};

/// Rows, images and notes so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// One row per measurement.
    pub rows: Vec<Row>,
    /// Images that belong to the rows.
    pub pictures: Vec<Picture>,
    /// What was omitted and why; a sentence each.
    pub notes: Vec<String>,
    /// Devices that were used, as in `cuda:0`.
    pub devices: Vec<String>,
}

impl Picture {
    /// Encodes a frame as 8-bit sRGB. Its id is derived from experiment and title, which must be the same in every run.
    ///
    /// # Errors
    /// [`EncodeError`] if the frame is too large for a PNG file.
    pub fn new(experiment: &str, title: &str, frame: &Frame) -> Result<Picture, EncodeError> {
        Ok(Picture {
            id: format!("{experiment}: {title}"),
            experiment: experiment.to_owned(),
            title: title.to_owned(),
            reference: None,
            file: String::new(),
            png: frame.to_png()?,
        })
    }

    /// The same image, to be compared with another.
    pub fn against(self, reference: &Picture) -> Picture {
        Picture { reference: Some(reference.id.clone()), ..self }
    }
}
