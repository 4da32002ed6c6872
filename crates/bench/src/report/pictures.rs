//! Pictures among results: unpacked, held against their references, and laid out.

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lightmesh::image::{Frame, compare};

use super::assets::Assets;
use super::document::{Block, Pair, Shot};
use super::error::PictureError;
use super::runs::{Run, distinct};
use crate::Picture;

/// The first bytes of every PNG file.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// With so many pictures an experiment shows all of them in a row first.
const ROW: usize = 3;

/// Pictures of all runs, ready to be shown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gallery {
    /// By run and id.
    shots: BTreeMap<(usize, String), Unpacked>,
}

#[derive(Clone, Debug)]
struct Unpacked {
    shot: Shot,
    frame: Frame,
}

/// A picture that cannot be shown: the run's index, the picture's id, and why.
pub(crate) type Fault = (usize, String, PictureError);

impl Gallery {
    /// Unpacks every picture.
    pub(crate) fn new(runs: &[Run], assets: &mut Assets) -> Result<Gallery, Fault> {
        let mut gallery = Gallery::default();
        for (index, run) in runs.iter().enumerate() {
            for picture in &run.results.pictures {
                let (frame, png) = unpack(picture).map_err(|reason| (index, picture.id.clone(), reason))?;
                let several = runs.len() > 1;
                let title = if several { format!("{}: {}", run.label, picture.title) } else { picture.title.clone() };
                let name =
                    format!("{} {} {}", if several { &run.label } else { "" }, picture.experiment, picture.title);
                let shot = shot(&name, title, &frame, png, assets);
                gallery.shots.insert((index, picture.id.clone()), Unpacked { shot, frame });
            }
        }
        Ok(gallery)
    }

    /// Blocks for the pictures of an experiment: all in a row where they are many, then each against its reference.
    pub(crate) fn blocks(&self, runs: &[Run], experiment: &str, assets: &mut Assets) -> Result<Vec<Block>, Fault> {
        let mut blocks = Vec::new();
        for (index, run) in runs.iter().enumerate() {
            let pictures: Vec<&Picture> =
                run.results.pictures.iter().filter(|picture| picture.experiment == experiment).collect();
            let shown = self.in_a_row(index, &pictures);
            if !shown.is_empty() {
                blocks.push(Block::Strip(shown));
            }
            for picture in pictures {
                let Some(reference) = &picture.reference else { continue };
                let pair = self.pair((index, &picture.id), (index, reference), assets);
                blocks.push(pair.map_err(|reason| (index, picture.id.clone(), reason))?);
            }
        }
        Ok(blocks)
    }

    /// Pictures that are to be shown without a reference: all where they are many, else those that no pair shows.
    fn in_a_row(&self, index: usize, pictures: &[&Picture]) -> Vec<Shot> {
        let references: BTreeSet<&str> = pictures.iter().filter_map(|picture| picture.reference.as_deref()).collect();
        let paired = |picture: &Picture| picture.reference.is_some() || references.contains(picture.id.as_str());
        let many = pictures.len() >= ROW;
        let own = |id: &str| pictures.iter().any(|picture| picture.id == id);
        // References that lie among the pictures of another experiment come first.
        let others = references.iter().filter(|id| many && !own(id)).map(|id| (*id).to_owned());
        let ids = pictures.iter().filter(|picture| many || !paired(picture)).map(|picture| picture.id.clone());
        others.chain(ids).filter_map(|id| Some(self.shots.get(&(index, id))?.shot.clone())).collect()
    }

    /// Pictures that two runs have both, where they differ, and how many do not.
    pub(crate) fn between_runs(&self, runs: &[Run], assets: &mut Assets) -> Result<(Vec<Block>, usize), Fault> {
        let (mut blocks, mut same) = (Vec::new(), 0);
        for id in distinct(self.shots.keys().map(|(_, id)| id)) {
            let having: Vec<usize> =
                (0..runs.len()).filter(|&run| self.shots.contains_key(&(run, id.clone()))).collect();
            let Some((&first, others)) = having.split_first() else { continue };
            for &other in others {
                let frame = |run| self.shots.get(&(run, id.clone())).map(|unpacked| &unpacked.frame);
                if frame(first) == frame(other) {
                    same += 1;
                } else {
                    let pair = self.pair((other, id), (first, id), assets);
                    blocks.push(pair.map_err(|reason| (other, id.clone(), reason))?);
                }
            }
        }
        Ok((blocks, same))
    }

    fn pair(&self, test: (usize, &str), reference: (usize, &str), assets: &mut Assets) -> Result<Block, PictureError> {
        let missing = || PictureError::NoReference(reference.1.to_owned());
        let get = |(run, id): (usize, &str)| self.shots.get(&(run, id.to_owned())).ok_or_else(missing);
        let (test, other) = (get(test)?, get(reference)?);
        let comparison = compare(&other.frame, &test.frame)
            .map_err(|reason| PictureError::Compare { reference: reference.1.to_owned(), reason })?;
        let png = comparison.difference.to_png()?;
        let name = format!("{} difference", test.shot.file.trim_start_matches("pictures/").trim_end_matches(".png"));
        let title = "Difference (FLIP): black is equal, yellow as different as can be".to_owned();
        Ok(Block::Pair(Box::new(Pair {
            picture: test.shot.clone(),
            reference: other.shot.clone(),
            difference: shot(&name, title, &comparison.difference, png, assets),
            mean_flip: comparison.mean_flip,
            rmse: comparison.rmse,
        })))
    }
}

fn shot(name: &str, title: String, frame: &Frame, png: Vec<u8>, assets: &mut Assets) -> Shot {
    let size = [frame.width(), frame.height()];
    Shot { file: assets.add_picture(name, size, png), size, title }
}

fn unpack(picture: &Picture) -> Result<(Frame, Vec<u8>), PictureError> {
    let png = STANDARD.decode(&picture.png).map_err(PictureError::Base64)?;
    if !png.starts_with(SIGNATURE) {
        return Err(PictureError::NotPng);
    }
    Ok((Frame::decode(&png)?, png))
}
