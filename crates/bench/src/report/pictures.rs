//! Images in results: decoded, compared with their references, and laid out.

use std::collections::{BTreeMap, BTreeSet};

use lightmesh::image::{Frame, compare};

use super::assets::Assets;
use super::document::{Block, Pair, Shot};
use super::error::PictureError;
use super::likeness::{Likeness, Trace};
use super::runs::{Run, distinct};
use crate::Picture;

/// The first bytes of every PNG file.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// From this number of images on, an experiment first shows all of them in a row.
const ROW: usize = 3;

/// Images of all runs, ready to be shown. Of images that are alike in several runs, only the first is shown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gallery {
    /// By run and id; only those that are shown.
    shots: BTreeMap<(usize, String), Unpacked>,
    /// Images that are not shown: the run whose image is shown instead, and the difference.
    alike: BTreeMap<(usize, String), (usize, Likeness)>,
}

#[derive(Clone, Debug)]
struct Unpacked {
    shot: Shot,
    frame: Frame,
}

/// An image that is shown: its run's index, the result, and its pixels.
type Candidate<'a> = (usize, &'a Picture, Frame);

/// An image that cannot be shown: the run's index, the image's id, and why.
pub(crate) type Fault = (usize, String, PictureError);

/// Images that several runs have, each compared with that of the first run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Common {
    /// Number of identical images.
    pub(crate) same: usize,
    /// Titles and differences of those that are nearly identical.
    pub(crate) alike: Vec<(String, Trace)>,
    /// Those that differ.
    pub(crate) different: Vec<Block>,
    /// Number of images with different sizes.
    pub(crate) other_sizes: usize,
}

impl Gallery {
    /// Decodes every image; keeps those that are shown.
    pub(crate) fn new(runs: &[Run], assets: &mut Assets) -> Result<Gallery, Fault> {
        let mut gallery = Gallery::default();
        let mut frames: BTreeMap<&str, Vec<Candidate>> = BTreeMap::new();
        for (index, run) in runs.iter().enumerate() {
            for picture in &run.results.pictures {
                let fault = |reason| (index, picture.id.clone(), reason);
                let frame = unpack(picture).map_err(fault)?;
                let shown = frames.entry(&picture.id).or_default();
                match first_alike(&frame, shown).map_err(fault)? {
                    Some(other) => drop(gallery.alike.insert((index, picture.id.clone()), other)),
                    None => shown.push((index, picture, frame)),
                }
            }
        }
        for shown in frames.into_values() {
            let several = shown.len() > 1;
            for (index, picture, frame) in shown {
                let label = &runs[index].label;
                let title = if several { format!("{label}: {}", picture.title) } else { picture.title.clone() };
                let name = format!("{} {} {}", if several { label } else { "" }, picture.experiment, picture.title);
                let shot = shot(&name, title, &frame, picture.png.clone(), assets);
                gallery.shots.insert((index, picture.id.clone()), Unpacked { shot, frame });
            }
        }
        Ok(gallery)
    }

    /// The run whose image is shown for that of `run`.
    fn shown_for(&self, run: usize, id: &str) -> usize {
        self.alike.get(&(run, id.to_owned())).map_or(run, |(first, _)| *first)
    }

    /// Blocks for the images of an experiment: their origin, all in a row if there are many, then each with its reference.
    pub(crate) fn blocks(&self, runs: &[Run], experiment: &str, assets: &mut Assets) -> Result<Vec<Block>, Fault> {
        let mut blocks: Vec<Block> = self.credits(runs, experiment).map(Block::Text).into_iter().collect();
        for (index, run) in runs.iter().enumerate() {
            let own = |id: &str| self.shown_for(index, id) == index;
            let pictures: Vec<&Picture> = of_experiment(run, experiment)
                .filter(|picture| own(&picture.id) || picture.reference.as_deref().is_some_and(own))
                .collect();
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

    /// The run whose images are shown, and how those of other runs compare; `None` for a single run.
    fn credits(&self, runs: &[Run], experiment: &str) -> Option<String> {
        let mut having = runs
            .iter()
            .enumerate()
            .filter(|(_, run)| runs.len() > 1 && of_experiment(run, experiment).next().is_some());
        let (_, first) = having.next()?;
        let mut text = format!("Images of {}.", first.label);
        for (index, run) in having {
            let likeness =
                |picture: &Picture| self.alike.get(&(index, picture.id.clone())).map(|(_, likeness)| *likeness);
            let all: Vec<Option<Likeness>> = of_experiment(run, experiment).map(likeness).collect();
            let same = all.iter().filter(|likeness| **likeness == Some(Likeness::Same)).count();
            let own = all.iter().filter(|likeness| likeness.is_none()).count();
            let parts = [(same, "identical"), (all.len() - same - own, "nearly identical"), (own, "shown below")];
            let said = |(count, what): &(usize, &str)| {
                (*count > 0).then(|| format!("{count} {} {what}", if *count == 1 { "is" } else { "are" }))
            };
            let parts: Vec<String> = parts.iter().filter_map(said).collect();
            text += &format!(" Of the images of {}, {}.", run.label, parts.join(", "));
        }
        Some(text)
    }

    /// Images to show without a reference: all if there are many, otherwise those that are not in a pair.
    fn in_a_row(&self, index: usize, pictures: &[&Picture]) -> Vec<Shot> {
        let references: BTreeSet<&str> = pictures.iter().filter_map(|picture| picture.reference.as_deref()).collect();
        let paired = |picture: &Picture| picture.reference.is_some() || references.contains(picture.id.as_str());
        let many = pictures.len() >= ROW;
        let own = |id: &str| pictures.iter().any(|picture| picture.id == id);
        // References from other experiments come first.
        let others = references.iter().filter(|id| many && !own(id)).map(|id| (*id).to_owned());
        let ids = pictures.iter().filter(|picture| many || !paired(picture)).map(|picture| picture.id.clone());
        let place = |id: String| (self.shown_for(index, &id), id);
        others.chain(ids).filter_map(|id| Some(self.shots.get(&place(id))?.shot.clone())).collect()
    }

    /// Images that several runs have, and how they compare.
    pub(crate) fn between_runs(&self, runs: &[Run], assets: &mut Assets) -> Result<Common, Fault> {
        let mut common = Common::default();
        for ((index, id), (_, likeness)) in &self.alike {
            match likeness {
                Likeness::Alike(trace) => {
                    let title = runs[*index].results.pictures.iter().find(|picture| picture.id == *id);
                    let title = title.map(|picture| picture.title.as_str()).unwrap_or_default();
                    common.alike.push((format!("{}: {title}", runs[*index].label), *trace));
                }
                _ => common.same += 1,
            }
        }
        for id in distinct(self.shots.keys().map(|(_, id)| id)) {
            let mut shown = (0..runs.len()).filter_map(|run| Some((run, self.shots.get(&(run, id.clone()))?)));
            let Some((first, reference)) = shown.next() else { continue };
            for (other, picture) in shown {
                if picture.shot.size != reference.shot.size {
                    common.other_sizes += 1;
                    continue;
                }
                let pair = self.pair((other, id), (first, id), assets);
                common.different.push(pair.map_err(|reason| (other, id.clone(), reason))?);
            }
        }
        Ok(common)
    }

    fn pair(&self, test: (usize, &str), reference: (usize, &str), assets: &mut Assets) -> Result<Block, PictureError> {
        let missing = || PictureError::NoReference(reference.1.to_owned());
        let get =
            |(run, id): (usize, &str)| self.shots.get(&(self.shown_for(run, id), id.to_owned())).ok_or_else(missing);
        let (test, other) = (get(test)?, get(reference)?);
        let comparison = compare(&other.frame, &test.frame)
            .map_err(|reason| PictureError::Compare { reference: reference.1.to_owned(), reason })?;
        let png = comparison.difference.to_small_png()?;
        let name = format!("{} difference", test.shot.file.trim_start_matches("pictures/").trim_end_matches(".png"));
        let title = "Difference (FLIP): from black, equal, to yellow, maximum".to_owned();
        Ok(Block::Pair(Box::new(Pair {
            picture: test.shot.clone(),
            reference: other.shot.clone(),
            difference: shot(&name, title, &comparison.difference, png, assets),
            mean_flip: comparison.mean_flip,
            rmse: comparison.rmse,
        })))
    }
}

/// The first of the images shown that may represent `frame`, with its run.
fn first_alike(frame: &Frame, shown: &[Candidate]) -> Result<Option<(usize, Likeness)>, PictureError> {
    for (run, picture, other) in shown {
        let likeness = Likeness::of(frame, other)
            .map_err(|reason| PictureError::Compare { reference: picture.id.clone(), reason })?;
        if likeness.one_for_both() {
            return Ok(Some((*run, likeness)));
        }
    }
    Ok(None)
}

fn of_experiment<'a>(run: &'a Run, experiment: &str) -> impl Iterator<Item = &'a Picture> {
    run.results.pictures.iter().filter(move |picture| picture.experiment == experiment)
}

fn shot(name: &str, title: String, frame: &Frame, png: Vec<u8>, assets: &mut Assets) -> Shot {
    let size = [frame.width(), frame.height()];
    Shot { file: assets.add_picture(name, size, png), size, title }
}

fn unpack(picture: &Picture) -> Result<Frame, PictureError> {
    if !picture.png.starts_with(SIGNATURE) {
        return Err(PictureError::NotPng);
    }
    Ok(Frame::decode(&picture.png)?)
}
