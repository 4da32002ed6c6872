//! Images in results: decoded, compared with their references, and laid out. Of an image that several runs have, the first is
//! shown; others are compared with it.

use std::collections::BTreeMap;

use lightmesh::image::{Frame, compare};

use super::document::{Block, Image};
use super::error::PictureError;
use super::numbers;
use super::runs::{Runs, distinct};
use crate::Picture;

/// The first bytes of every PNG file.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// An image that cannot be shown: the run's index, the image's id, and why.
pub(crate) type Fault = (usize, String, PictureError);

/// All images, by id, each of some runs.
pub(crate) struct Gallery<'a> {
    runs: &'a Runs,
    images: BTreeMap<&'a str, Vec<Decoded<'a>>>,
}

struct Decoded<'a> {
    run: usize,
    picture: &'a Picture,
    frame: Frame,
}

impl<'a> Gallery<'a> {
    /// Decodes every image.
    pub(crate) fn new(runs: &'a Runs) -> Result<Gallery<'a>, Fault> {
        let mut images: BTreeMap<&str, Vec<Decoded>> = BTreeMap::new();
        for (run, pictures) in runs.0.iter().map(|run| &run.results.pictures).enumerate() {
            for picture in pictures {
                let frame = decoded(picture).map_err(|reason| (run, picture.id.clone(), reason))?;
                images.entry(&picture.id).or_default().push(Decoded { run, picture, frame });
            }
        }
        Ok(Gallery { runs, images })
    }

    /// Images of an experiment in order, then their differences from their references.
    pub(crate) fn blocks(&self, experiment: &str) -> Result<Vec<Block>, Fault> {
        let all = self.runs.0.iter().flat_map(|run| &run.results.pictures);
        let ids = distinct(all.filter(|picture| picture.experiment == experiment).map(|picture| picture.id.as_str()));
        let (mut shown, mut differences) = (Vec::new(), Vec::new());
        for image in ids.into_iter().filter_map(|id| self.images.get(id)?.first()) {
            let Picture { id, title, reference, png, .. } = image.picture;
            shown.push(Image::picture(experiment, title.clone(), png.clone()));
            if let Some(reference) = reference {
                let fault = |reason| (image.run, id.clone(), reason);
                let missing = || fault(PictureError::NoReference(reference.clone()));
                let other =
                    self.images.get(reference.as_str()).and_then(|all| all.iter().find(|other| other.run == image.run));
                differences.push(image.difference(other.ok_or_else(missing)?, title).map_err(fault)?);
            }
        }
        let blocks = [shown, differences].into_iter().filter(|images| !images.is_empty()).map(Block::Pictures);
        Ok(blocks.collect())
    }

    /// How images that several runs have compare with those of the first run, and those that differ.
    pub(crate) fn between_runs(&self) -> Result<Vec<Block>, Fault> {
        let (mut same, mut other_sizes, mut differing) = (0, 0, Vec::new());
        for (id, images) in &self.images {
            let Some((first, others)) = images.split_first() else { continue };
            for image in others {
                let size = |image: &Decoded| [image.frame.width(), image.frame.height()];
                if size(image) != size(first) {
                    other_sizes += 1;
                } else if image.frame.color() == first.frame.color() {
                    same += 1;
                } else {
                    let label = &self.runs.0[image.run].label;
                    let title = format!("{label}: {}", image.picture.title);
                    let difference = image.difference(first, &title);
                    differing.push(Image::picture(&image.picture.experiment, title, image.picture.png.clone()));
                    differing.push(difference.map_err(|reason| (image.run, (*id).to_owned(), reason))?);
                }
            }
        }
        if same + other_sizes + differing.len() == 0 {
            return Ok(Vec::new());
        }
        let text = format!(
            "Of the common images, {same} are identical, {} differ and are shown here, {other_sizes} have different sizes. Elsewhere \
             images are those of {}, if it has them.",
            differing.len() / 2,
            self.runs.0[0].label
        );
        let differing = (!differing.is_empty()).then_some(Block::Pictures(differing));
        Ok([Block::Text(text)].into_iter().chain(differing).collect())
    }
}

impl Decoded<'_> {
    /// The FLIP map to another image, from black, equal, to yellow, maximum; its title has the errors.
    fn difference(&self, other: &Decoded, title: &str) -> Result<Image, PictureError> {
        let reference = || other.picture.id.clone();
        let comparison = compare(&other.frame, &self.frame)
            .map_err(|reason| PictureError::Compare { reference: reference(), reason })?;
        let [flip, rmse] = [comparison.mean_flip, comparison.rmse].map(numbers::small);
        let by = if other.run == self.run { format!(" from {}", other.picture.title) } else { String::new() };
        let text = format!("{title}: difference{by}, mean FLIP {flip}, RMSE {rmse}");
        let png = comparison.difference.to_small_png()?;
        let image = Image::picture(&self.picture.experiment, format!("{title} difference"), png);
        Ok(Image { title: text, ..image })
    }
}

fn decoded(picture: &Picture) -> Result<Frame, PictureError> {
    if !picture.png.starts_with(SIGNATURE) {
        return Err(PictureError::NotPng);
    }
    Ok(Frame::decode(&picture.png)?)
}
