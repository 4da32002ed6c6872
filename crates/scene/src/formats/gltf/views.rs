//! Cameras and lights of all nodes. Data that many nodes may share is processed once: a long text must not be multiplied.

use std::path::Path;

use super::{
    cameras, cameras::Lens, container::malformed, document::Document, extras, extras::LightExtras, left_out::LeftOut,
    lights, nodes::Placed, rigged::Rigged,
};
use crate::build::draft::Draft;
use crate::model::animation::views::{Carried, Motion, numbered};
use crate::{Camera, Light, LoadError};

/// Maximum length of a name in characters; longer ones are cut.
const LONGEST_NAME: usize = 200;

/// The cameras and lights of a document.
pub(super) struct Views<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    /// By camera, once a node has used it.
    lenses: Vec<Option<Lens>>,
    /// By light, once a node has used it.
    extras: Vec<Option<LightExtras>>,
}

impl<'a> Views<'a> {
    pub(super) fn new(path: &'a Path, document: &'a Document<'a>) -> Views<'a> {
        Views {
            path,
            document,
            lenses: vec![None; document.cameras.len()],
            extras: vec![None; document.extensions.lights_punctual.lights.len()],
        }
    }

    /// Adds those of all nodes.
    pub(super) fn add(
        &mut self,
        all: &[Placed],
        rigged: &Rigged,
        left_out: &mut LeftOut,
        draft: &mut Draft,
    ) -> Result<(), LoadError> {
        for placed in all {
            if let Some(camera) = placed.node.camera {
                self.add_camera(placed, camera, rigged.mover(placed.index), draft)?;
            }
            if let Some(light) = placed.light() {
                self.add_light(placed, light, rigged.mover(placed.index), left_out, draft)?;
            }
        }
        Ok(())
    }

    fn add_camera(
        &mut self,
        placed: &Placed,
        index: u32,
        mover: Option<u32>,
        draft: &mut Draft,
    ) -> Result<(), LoadError> {
        let camera = self.document.cameras.get(index as usize).ok_or_else(|| self.missing("camera", index))?;
        let slot = &mut self.lenses[index as usize];
        let lens = match *slot {
            Some(known) => known,
            None => *slot.insert(cameras::lens(self.path, index, camera)?),
        };
        let own = cameras::camera(name(camera.name.as_deref(), placed), lens);
        let camera = own.carried(&placed.transform).ok_or_else(|| flat(self.path, placed))?;
        let motion = mover.map(|node| numbered(&mut draft.animation.cameras, Motion::Node(node, own.into())));
        let camera = Camera { motion, ..camera };
        draft.cameras.push((camera, placed.transform.w_axis.truncate()));
        Ok(())
    }

    fn add_light(
        &mut self,
        placed: &Placed,
        index: u32,
        mover: Option<u32>,
        left_out: &mut LeftOut,
        draft: &mut Draft,
    ) -> Result<(), LoadError> {
        let lights = &self.document.extensions.lights_punctual.lights;
        let light = lights.get(index as usize).ok_or_else(|| self.missing("light", index))?;
        let slot = &mut self.extras[index as usize];
        if slot.is_none() {
            let own: Option<LightExtras> = extras::read(self.path, &format!("light {index}"), light.extras)?;
            *slot = Some(own.unwrap_or_default());
        }
        let own = slot.as_ref().expect("just filled");
        let Some(found) = lights::read(self.path, index, light, own)? else {
            left_out.unknown_lights += 1;
            return Ok(());
        };
        let transform = if own.aimed { placed.unturned() } else { placed.transform };
        let carried = found.carried(&transform).ok_or_else(|| match own.shape {
            Some(_) => malformed(self.path, format!("extras.lightmesh of light {index} does not give it a valid size")),
            None => flat(self.path, placed),
        })?;
        // Where it moves, it turns with its node.
        let turned = placed.transform.inverse() * transform;
        let in_node = if own.aimed { found.carried(&turned).unwrap_or(found) } else { found };
        let motion = mover.map(|node| numbered(&mut draft.animation.lights, Motion::Node(node, in_node.into())));
        let named = Light { name: name(light.name.as_deref(), placed), motion, ..carried };
        draft.lights.push((named, placed.transform.w_axis.truncate()));
        Ok(())
    }

    fn missing(&self, what: &str, index: u32) -> LoadError {
        malformed(self.path, format!("there is no {what} {index}, but it is referenced"))
    }
}

/// The name of a camera or light, else that of its node.
fn name(own: Option<&str>, placed: &Placed) -> String {
    let name = own.filter(|name| !name.is_empty()).or(placed.node.name.as_deref());
    name.unwrap_or_default().chars().take(LONGEST_NAME).collect()
}

/// The error for a node without an orientation.
fn flat(path: &Path, placed: &Placed) -> LoadError {
    let node = placed.index;
    malformed(path, format!("node {node} has a camera or light but no orientation (a scale of 0)"))
}
