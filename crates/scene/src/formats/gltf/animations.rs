//! Animations: keys of the places of nodes and of the weights of morph targets (glTF 2.0, 3.11).
//!
//! A file may have several animations: motions of one thing, of which one is shown at a time, or of several things, which go together.
//! So all are played that move nothing that one before them moves, or the one that is asked for.

use std::{
    collections::{BTreeMap, HashMap, HashSet},
    sync::Arc,
};

use super::{
    accessor::Accessors,
    container::malformed,
    document::{Animation, AnimationSampler, Channel},
    left_out::LeftOut,
};
use crate::LoadError;
use crate::build::quote::quote;
use crate::model::animation::track::{Interpolation, Kind, Track};

/// The motion of a node.
#[derive(Default)]
pub(super) struct NodeTracks {
    pub(super) translation: Option<Arc<Track>>,
    pub(super) rotation: Option<Arc<Track>>,
    pub(super) scale: Option<Arc<Track>>,
    /// Weights of the morph targets of its mesh.
    pub(super) weights: Option<Arc<Track>>,
}

/// The animations of a file that are played.
#[derive(Default)]
pub(super) struct Played {
    /// By node.
    pub(super) tracks: HashMap<u32, NodeTracks>,
    pub(super) names: Vec<String>,
    /// Names of those that are not played.
    pub(super) others: Vec<String>,
    /// Time of the last key, seconds.
    pub(super) duration: f64,
}

/// What a channel moves of a node.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
}

impl Path {
    fn new(name: &str) -> Option<Path> {
        Some(match name {
            "translation" => Path::Translation,
            "rotation" => Path::Rotation,
            "scale" => Path::Scale,
            "weights" => Path::Weights,
            _ => return None,
        })
    }
}

/// Reads the animations that are played: the one with the name `wanted`, or all that go together.
pub(super) fn read(accessors: &Accessors, wanted: Option<&str>, left_out: &mut LeftOut) -> Result<Played, LoadError> {
    let mut played = Played::default();
    let mut taken: HashSet<(u32, Path)> = HashSet::new();
    for (index, animation) in accessors.document.animations.iter().enumerate() {
        let name = animation.name.as_deref().filter(|name| !name.is_empty());
        let name = name.map_or_else(|| format!("animation {index}"), str::to_owned);
        let exists = |&(node, _): &(u32, Path)| (node as usize) < accessors.document.nodes.len();
        let (targets, lost): (Vec<_>, Vec<_>) = animation.channels.iter().filter_map(target).partition(exists);
        let is_played = match wanted {
            Some(wanted) => name == wanted && played.names.is_empty(),
            None => !targets.iter().any(|target| taken.contains(target)),
        };
        if !is_played {
            played.others.push(name);
            continue;
        }
        left_out.unknown_channels += animation.channels.len() - targets.len() - lost.len();
        lost.iter().for_each(|&(node, _)| left_out.lost_channels.add(node as usize, None));
        taken.extend(targets);
        played.names.push(name);
        Reader { accessors, animation, index, known: BTreeMap::new() }.read(&mut played, left_out)?;
    }
    Ok(played)
}

fn target(channel: &Channel) -> Option<(u32, Path)> {
    Some((channel.target.node?, Path::new(&channel.target.path)?))
}

/// Reads one animation.
struct Reader<'a, 'd> {
    accessors: &'a Accessors<'d>,
    animation: &'a Animation<'d>,
    index: usize,
    /// Tracks by sampler, and whether they are read as rotations.
    known: BTreeMap<(u32, usize), Option<Arc<Track>>>,
}

impl Reader<'_, '_> {
    fn read(mut self, played: &mut Played, left_out: &mut LeftOut) -> Result<(), LoadError> {
        let nodes = &self.accessors.document.nodes;
        for channel in &*self.animation.channels {
            let Some((node, path)) = target(channel) else { continue };
            let Some(moved) = nodes.get(node as usize) else { continue };
            let Some(track) = self.track(channel.sampler, path)? else {
                left_out.undefined_keys.add(node as usize, moved.name.as_deref());
                continue;
            };
            played.duration = played.duration.max(track.end());
            let tracks = played.tracks.entry(node).or_default();
            let slot = match path {
                Path::Translation => &mut tracks.translation,
                Path::Rotation => &mut tracks.rotation,
                Path::Scale => &mut tracks.scale,
                Path::Weights => &mut tracks.weights,
            };
            *slot = Some(track);
        }
        Ok(())
    }

    /// The keys of a sampler, which several channels may share; `None` if some are no numbers.
    fn track(&mut self, sampler: u32, path: Path) -> Result<Option<Arc<Track>>, LoadError> {
        let kind = |width: usize| if path == Path::Rotation { Kind::Rotations } else { Kind::Numbers(width) };
        let of_path = match path {
            Path::Translation | Path::Scale => 3,
            Path::Rotation => 4,
            Path::Weights => 1,
        };
        if let Some(known) = self.known.get(&(sampler, of_path)) {
            return Ok(known.clone());
        }
        let keys = self.animation.samplers.get(sampler as usize);
        let keys = keys.ok_or_else(|| self.damaged(sampler, "does not exist, but is referenced"))?;
        let AnimationSampler { input, output, interpolation } = keys;
        let times: Vec<f64> =
            self.accessors.vectors::<1>(*input, None)?.iter().map(|&[time]| f64::from(time)).collect();
        let values: Vec<f64> = match of_path {
            3 => doubles(&self.accessors.vectors::<3>(*output, None)?),
            4 => doubles(&self.accessors.vectors::<4>(*output, None)?),
            _ => doubles(&self.accessors.vectors::<1>(*output, None)?),
        };
        let interpolation = interpolation.as_deref().unwrap_or("LINEAR");
        let parts = if interpolation == "CUBICSPLINE" { 3 } else { 1 };
        // There are as many weights at a key as the mesh has targets.
        let width = if path == Path::Weights { values.len() / (parts * times.len().max(1)) } else { of_path };
        if width == 0 || values.len() != parts * width * times.len() {
            return Err(self.damaged(sampler, "does not have one value for each key"));
        }
        if !values.iter().all(|value| value.is_finite()) {
            self.known.insert((sampler, of_path), None);
            return Ok(None);
        }
        let kind = kind(width);
        let track = match interpolation {
            "CUBICSPLINE" => Track::with_slopes(kind, times, &values),
            "LINEAR" => Track::new(kind, times, values, Interpolation::Linear),
            "STEP" => Track::new(kind, times, values, Interpolation::Step),
            other => return Err(self.damaged(sampler, &format!("has the interpolation `{}`", quote(other)))),
        };
        let track = Some(Arc::new(track.map_err(|problem| self.damaged(sampler, problem))?));
        self.known.insert((sampler, of_path), track.clone());
        Ok(track)
    }

    fn damaged(&self, sampler: u32, problem: &str) -> LoadError {
        malformed(self.accessors.path, format!("sampler {sampler} of animation {} {problem}", self.index))
    }
}

fn doubles<const N: usize>(values: &[[f32; N]]) -> Vec<f64> {
    values.as_flattened().iter().map(|&value| f64::from(value)).collect()
}
