//! Pictures among results: unpacked, held against their references, and laid out.

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lightmesh::image::{Frame, compare};

use super::assets::Assets;
use super::document::{Block, Pair, Shot};
use super::error::PictureError;
use super::likeness::{Likeness, Trace};
use super::runs::{Run, distinct};
use crate::Picture;

/// The first bytes of every PNG file.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// With so many pictures an experiment shows all of them in a row first.
const ROW: usize = 3;

/// Pictures of all runs, ready to be shown. Of those that are alike in several runs the first stands for all.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gallery {
    /// By run and id; those alone that stand for themselves.
    shots: BTreeMap<(usize, String), Unpacked>,
    /// Where another run has the same picture, or nearly, how it compares with it.
    alike: BTreeMap<(usize, String), (usize, Likeness)>,
}

#[derive(Clone, Debug)]
struct Unpacked {
    shot: Shot,
    frame: Frame,
}

/// A picture that stands for itself: its run's index, what it is, its pixels and its file.
type Candidate<'a> = (usize, &'a Picture, Frame, Vec<u8>);

/// A picture that cannot be shown: the run's index, the picture's id, and why.
pub(crate) type Fault = (usize, String, PictureError);

/// Pictures that several runs have, each held against the first run's.
#[derive(Clone, Debug, Default)]
pub(crate) struct Common {
    /// How many are the same in every pixel.
    pub(crate) same: usize,
    /// Titles and traces of those that are nearly so.
    pub(crate) alike: Vec<(String, Trace)>,
    /// Those that differ.
    pub(crate) different: Vec<Block>,
    /// How many have other sizes.
    pub(crate) other_sizes: usize,
}

impl Gallery {
    /// Unpacks every picture; keeps those that stand for themselves.
    pub(crate) fn new(runs: &[Run], assets: &mut Assets) -> Result<Gallery, Fault> {
        let mut gallery = Gallery::default();
        let mut frames: BTreeMap<&str, Vec<Candidate>> = BTreeMap::new();
        for (index, run) in runs.iter().enumerate() {
            for picture in &run.results.pictures {
                let fault = |reason| (index, picture.id.clone(), reason);
                let (frame, png) = unpack(picture).map_err(fault)?;
                let shown = frames.entry(&picture.id).or_default();
                match first_alike(&frame, shown).map_err(fault)? {
                    Some(other) => drop(gallery.alike.insert((index, picture.id.clone()), other)),
                    None => shown.push((index, picture, frame, png)),
                }
            }
        }
        for shown in frames.into_values() {
            let several = shown.len() > 1;
            for (index, picture, frame, png) in shown {
                let label = &runs[index].label;
                let title = if several { format!("{label}: {}", picture.title) } else { picture.title.clone() };
                let name = format!("{} {} {}", if several { label } else { "" }, picture.experiment, picture.title);
                let shot = shot(&name, title, &frame, png, assets);
                gallery.shots.insert((index, picture.id.clone()), Unpacked { shot, frame });
            }
        }
        Ok(gallery)
    }

    /// The run whose picture is shown for that of `run`.
    fn shown_for(&self, run: usize, id: &str) -> usize {
        self.alike.get(&(run, id.to_owned())).map_or(run, |(first, _)| *first)
    }

    /// Blocks for the pictures of an experiment: whose they are, all in a row where they are many, then each against its reference.
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

    /// Whose pictures an experiment shows, and which other runs made the same; `None` for a single run.
    fn credits(&self, runs: &[Run], experiment: &str) -> Option<String> {
        let mut having = runs
            .iter()
            .enumerate()
            .filter(|(_, run)| runs.len() > 1 && of_experiment(run, experiment).next().is_some());
        let (_, first) = having.next()?;
        let mut text = format!("Pictures of {}.", first.label);
        for (index, run) in having {
            let likeness =
                |picture: &Picture| self.alike.get(&(index, picture.id.clone())).map(|(_, likeness)| *likeness);
            let all: Vec<Option<Likeness>> = of_experiment(run, experiment).map(likeness).collect();
            let same = all.iter().filter(|likeness| **likeness == Some(Likeness::Same)).count();
            let own = all.iter().filter(|likeness| likeness.is_none()).count();
            let parts = [
                (same, "the same in every pixel"),
                (all.len() - same - own, "so but for traces"),
                (own, "shown after them"),
            ];
            let said = |(count, what): &(usize, &str)| {
                (*count > 0).then(|| format!("{count} {} {what}", if *count == 1 { "is" } else { "are" }))
            };
            let parts: Vec<String> = parts.iter().filter_map(said).collect();
            text += &format!(" Of those of {} {}.", run.label, parts.join(", "));
        }
        Some(text)
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
        let place = |id: String| (self.shown_for(index, &id), id);
        others.chain(ids).filter_map(|id| Some(self.shots.get(&place(id))?.shot.clone())).collect()
    }

    /// Pictures that several runs have, and how they compare.
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

/// Of the pictures that are shown, the first that may stand for `frame`, by its run.
fn first_alike(frame: &Frame, shown: &[Candidate]) -> Result<Option<(usize, Likeness)>, PictureError> {
    for (run, picture, other, _) in shown {
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

fn unpack(picture: &Picture) -> Result<(Frame, Vec<u8>), PictureError> {
    let png = STANDARD.decode(&picture.png).map_err(PictureError::Base64)?;
    if !png.starts_with(SIGNATURE) {
        return Err(PictureError::NotPng);
    }
    Ok((Frame::decode(&png)?, png))
}
