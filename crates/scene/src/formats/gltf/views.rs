//! Cameras and lights of all nodes. Data that many nodes may share is processed once: a long text must not be multiplied.

use std::path::Path;

use super::{
    axes::Axes, cameras, container::malformed, document::Document, extras, extras::LightExtras, left_out::LeftOut,
    lights, nodes::Placed, rigged::Rigged,
};
use glam::DMat4;

use crate::{LoadError, Projection, animation::views::Motion, draft::Draft};

/// Maximum length of a name in characters; longer ones are cut.
const LONGEST_NAME: usize = 200;

/// The cameras and lights of a document.
pub(super) struct Views<'a> {
    axes: Axes<'a>,
    document: &'a Document<'a>,
    /// By camera, once a node has used it.
    projections: Vec<Option<Projection>>,
    /// By light, once a node has used it.
    extras: Vec<Option<LightExtras>>,
}

impl<'a> Views<'a> {
    pub(super) fn new(path: &'a Path, document: &'a Document<'a>) -> Views<'a> {
        Views {
            axes: Axes { path },
            document,
            projections: vec![None; document.cameras.len()],
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
        let slot = &mut self.projections[index as usize];
        let projection = match *slot {
            Some(known) => known,
            None => *slot.insert(cameras::projection(self.axes.path, index, camera)?),
        };
        let name = name(camera.name.as_deref(), placed);
        let mut camera = cameras::placed(&self.axes, placed, name, projection)?;
        if let Some(node) = mover {
            let own = cameras::placed(&self.axes, &unplaced(placed), String::new(), projection)?;
            camera.motion = Some(draft.animation.cameras.len() as u32);
            draft.animation.cameras.push(Motion::Node(node, own.into()));
        }
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
            let own: Option<LightExtras> = extras::read(self.axes.path, &format!("light {index}"), light.extras)?;
            *slot = Some(own.unwrap_or_default());
        }
        let own = slot.as_ref().expect("just filled");
        match lights::placed(&self.axes, placed, index, light, own)? {
            Some(found) => {
                let mut named = crate::Light { name: name(light.name.as_deref(), placed), ..found };
                if let Some((node, own)) = mover.zip(lights::placed(&self.axes, &unplaced(placed), index, light, own)?)
                {
                    named.motion = Some(draft.animation.lights.len() as u32);
                    draft.animation.lights.push(Motion::Node(node, own.into()));
                }
                draft.lights.push((named, placed.transform.w_axis.truncate()));
            }
            None => left_out.unknown_lights += 1,
        }
        Ok(())
    }

    fn missing(&self, what: &str, index: u32) -> LoadError {
        malformed(self.axes.path, format!("there is no {what} {index}, but it is referenced"))
    }
}

/// A node in its own coordinates.
fn unplaced<'a>(placed: &Placed<'a>) -> Placed<'a> {
    Placed { transform: DMat4::IDENTITY, ..*placed }
}

/// The name of a camera or light, else that of its node.
fn name(own: Option<&str>, placed: &Placed) -> String {
    let name = own.filter(|name| !name.is_empty()).or(placed.node.name.as_deref());
    name.unwrap_or_default().chars().take(LONGEST_NAME).collect()
}
