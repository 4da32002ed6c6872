//! A draft becomes a scene.

use super::Draft;
use crate::build::quote::quote;
use crate::build::sanitize::{clamp_reflectance, drop_invalid_positions, keep_finite, too_long, unseen};
use crate::build::textures::missing_uvs::untextured;
use crate::optics::lamps::lamps;
use crate::{Camera, Geometry, Lights, LoadError, Scene};

impl Draft {
    /// Chooses the local frame and transforms everything to it.
    ///
    /// # Errors
    ///
    /// [`LoadError::Warnings`] if the options are strict and there are warnings.
    pub fn finish(mut self) -> Result<Scene, LoadError> {
        if let Some(error) = self.too_large {
            return Err(error);
        }
        if let Some(name) = self.animation_name.filter(|name| !self.animation.names.contains(name)) {
            let known = self.animation.others.iter().map(|other| quote(other)).collect();
            return Err(LoadError::UnknownAnimation { path: self.path, name: quote(&name), known });
        }
        if self.unusable_triangles > 0 {
            self.warnings.push(format!(
                "{} triangles with infinite, undefined or far too large coordinates were ignored",
                self.unusable_triangles
            ));
        }
        self.warnings.extend(drop_invalid_positions(&mut self.cameras, "cameras"));
        self.warnings.extend(drop_invalid_positions(&mut self.lights, "lights"));
        self.warnings.extend(keep_finite(&mut self.materials));
        let adding = clamp_reflectance(&mut self.materials);
        self.warnings.extend(adding.map(|warning| format!("{}: {warning}", self.path.display())));
        self.warnings.extend(self.texture_files.warning(&self.path));
        if self.builder.is_empty() {
            self.warnings.push("the scene has no triangles".to_owned());
        }
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let own = self.builder.triangle_count();
        self.without_uvs.extend(self.shapes_without_uvs.iter().map(|shape| own + shape.start..own + shape.end));
        let (origin, mut mesh) = self.builder.finish();
        for warning in [unseen(&self.materials, &mesh.materials), too_long(&mesh)].into_iter().flatten() {
            self.warnings.push(format!("{}: {warning}", self.path.display()));
        }
        self.warnings.extend(untextured(&mut mesh, &mut self.materials, &self.without_uvs));
        let warnings = self.warnings.into_list();
        if self.strict && !warnings.is_empty() {
            return Err(LoadError::Warnings { path: self.path, warnings });
        }
        let mut geometry = Geometry { origin, mesh, materials: self.materials, textures: self.textures.into() };
        let mut animation = self.animation;
        animation.note_lamps(&geometry);
        let lamps = lamps(&mut geometry);
        let cameras = self.cameras.into_iter();
        let cameras = cameras.map(|(camera, world)| Camera { position: geometry.to_local(world), ..camera }).collect();
        let lights = self.lights.into_iter();
        let list = lights.map(|(light, world)| light.at(geometry.to_local(world))).collect();
        let mut lights = Lights { list, ambient: self.ambient, background: self.background, ..Lights::default() };
        // What else the file says of lights, it means.
        if let Some(surroundings) = self.surroundings {
            lights.add(surroundings);
        }
        lights.list.extend(lamps);
        Ok(Scene {
            name,
            geometry: geometry.into(),
            lights,
            cameras,
            light_mesh: self.light_mesh,
            empties: self.empties,
            files: self.files.into_iter().collect(),
            warnings,
            smooth_normals: self.smooth_normals,
            animation: (!animation.is_still()).then(|| animation.into()),
        })
    }
}
