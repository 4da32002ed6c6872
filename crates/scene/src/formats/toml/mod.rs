//! The scene file: TOML, read through serde into [`schema`] and checked from there into a draft.
//!
//! Every error, of grammar or of sense, names the line and the key.

mod cameras;
mod check;
mod lights;
mod one_or_many;
mod parts;
pub(crate) mod schema;
#[cfg(test)]
mod tests;

use std::path::Path;

pub(crate) use cameras::upright;
pub(crate) use check::unit;
use check::{Source, syntax_error};
use schema::{AmbientEntry, LightMeshEntry, MaterialEntry, SceneFile, WeightName};
use toml::Spanned;

use crate::{LightMeshDefaults, LoadError, Material, Weight, draft::Draft, error::Place, open::read_bytes};

/// Reads a scene file into `draft`.
pub(crate) fn read(path: &Path, draft: &mut Draft) -> Result<(), LoadError> {
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| LoadError::Syntax {
        place: Place::line(path, 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count()).into(),
        problem: "the text is not UTF-8".to_owned(),
        remedy: "save it as UTF-8".to_owned(),
    })?;
    let source = Source { path, text };
    let file: SceneFile = toml::from_str(text).map_err(|error| syntax_error(&source, &error))?;
    convert(&source, &file, draft)
}

fn convert(source: &Source, file: &SceneFile, draft: &mut Draft) -> Result<(), LoadError> {
    if let Some(origin) = &file.origin {
        draft.prefer_origin(source.vector("origin", origin)?);
    }
    let names = read_materials(source, &file.material, draft)?;
    parts::read(source, file, &names, draft)?;
    for camera in &file.camera {
        let camera = cameras::read(source, camera, &mut draft.warnings)?;
        draft.cameras.push(camera);
    }
    for light in &file.light {
        draft.lights.push(lights::read(source, light)?);
    }
    if let Some(ambient) = &file.ambient {
        read_ambient(source, ambient, draft)?;
    }
    if let Some(light_mesh) = &file.lightmesh {
        draft.light_mesh = read_light_mesh(source, light_mesh)?;
    }
    Ok(())
}

/// Adds the file's materials and returns their names, in the order of their indices.
fn read_materials(
    source: &Source,
    entries: &[Spanned<MaterialEntry>],
    draft: &mut Draft,
) -> Result<Vec<String>, LoadError> {
    let mut names: Vec<String> = Vec::new();
    for entry in entries.iter().map(Spanned::get_ref) {
        if names.contains(entry.name.get_ref()) {
            let remedy = "give every material a name of its own";
            return Err(source.refuse("name", &entry.name, "is used by an earlier material", remedy));
        }
        names.push(entry.name.get_ref().clone());
        draft.materials.push(read_material(source, entry)?);
    }
    Ok(names)
}

fn read_material(source: &Source, entry: &MaterialEntry) -> Result<Material, LoadError> {
    let default = Material::default();
    let kd = entry.kd.as_ref().map_or(Ok(default.kd), |kd| source.color("kd", kd))?;
    let shininess = match &entry.shininess {
        Some(shininess) => source.positive("shininess", shininess)? as f32,
        None => default.shininess,
    };
    Ok(Material {
        name: entry.name.get_ref().clone(),
        ka: entry.ka.as_ref().map_or(Ok(kd), |ka| source.color("ka", ka))?,
        kd,
        ks: entry.ks.as_ref().map_or(Ok(default.ks), |ks| source.color("ks", ks))?,
        shininess,
        emission: entry.emission.as_ref().map_or(Ok(default.emission), |color| source.color("emission", color))?,
        ..default
    })
}

fn read_ambient(source: &Source, entry: &AmbientEntry, draft: &mut Draft) -> Result<(), LoadError> {
    draft.ambient = entry.intensity.as_ref().map(|color| source.color("intensity", color)).transpose()?;
    draft.background = entry.background.as_ref().map(|color| source.color("background", color)).transpose()?;
    Ok(())
}

fn read_light_mesh(source: &Source, entry: &LightMeshEntry) -> Result<LightMeshDefaults, LoadError> {
    let positive = |key, value: &Option<schema::Number>| -> Result<Option<f32>, LoadError> {
        value.as_ref().map(|value| source.positive(key, value).map(|number| number as f32)).transpose()
    };
    Ok(LightMeshDefaults {
        step: positive("step", &entry.step)?,
        radius: positive("radius", &entry.radius)?,
        weight: entry.weight.map(Weight::from),
    })
}

impl From<WeightName> for Weight {
    fn from(name: WeightName) -> Weight {
        match name {
            WeightName::Constant => Weight::Constant,
            WeightName::Quadratic => Weight::Quadratic,
            WeightName::Smooth => Weight::Smooth,
        }
    }
}
