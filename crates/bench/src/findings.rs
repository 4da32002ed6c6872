//! Results collected while a suite runs.

use std::fmt;
use std::rc::Rc;

use lightmesh::image::{EncodeError, Frame};

use crate::{Picture, Row};

/// Rows, images and notes so far.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// One row per measurement.
    pub rows: Vec<Row>,
    /// Images that belong to the rows.
    pub pictures: Vec<Picture>,
    /// What was omitted and why; a sentence each.
    pub notes: Vec<String>,
    /// Devices that were used, as in `cuda:0`.
    pub devices: Vec<String>,
    /// Who is told of new rows.
    pub(crate) keeper: Keeper,
}

/// Somebody who is told when there are new rows.
#[derive(Clone, Default)]
pub(crate) struct Keeper(pub(crate) Option<Tell>);

/// Gets everything so far.
pub(crate) type Tell = Rc<dyn Fn(&Findings)>;

impl fmt::Debug for Keeper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "somebody" } else { "nobody" })
    }
}

impl Findings {
    /// Adds rows.
    pub fn add(&mut self, rows: impl IntoIterator<Item = Row>) {
        self.rows.extend(rows);
        if let Some(tell) = self.keeper.0.clone() {
            tell(self);
        }
    }
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
