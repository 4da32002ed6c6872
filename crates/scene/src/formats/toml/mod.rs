//! The scene file: TOML, parsed by serde into [`schema`], then checked and added to a draft.
//!
//! Every error, syntactic or semantic, names the line and the key.

mod cameras;
mod check;
mod lights;
mod materials;
mod motion;
mod motion_schema;
mod one_or_many;
mod parts;
mod publish;
pub(crate) mod schema;
mod sky;
pub(crate) mod spanned;
pub(crate) mod values;

use std::path::Path;

use check::{Source, syntax_error};
use schema::{AmbientEntry, LightMeshEntry, SceneFile, WeightName};
use values::Number;

use crate::build::draft::Draft;
use crate::build::error::Place;
use crate::{LightMeshDefaults, LoadError, Weight};

/// Reads a scene file into `draft`.
pub(crate) fn read(path: &Path, bytes: &[u8], draft: &mut Draft) -> Result<(), LoadError> {
    let text = std::str::from_utf8(bytes).map_err(|error| LoadError::Syntax {
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
    let names = materials::read(source, &file.material, draft)?;
    parts::read(source, file, &names, draft)?;
    for camera in &file.camera {
        let found = cameras::read(source, camera)?;
        let found = motion::camera(source, camera, found, draft)?;
        draft.cameras.push(found);
    }
    cameras::warn_of_two_angles(source, &file.camera, &mut draft.warnings);
    for light in &file.light {
        let found = lights::read(source, light)?;
        let found = motion::light(source, light, found, draft)?;
        draft.lights.push(found);
    }
    if let Some(ambient) = &file.ambient {
        read_ambient(source, ambient, draft)?;
    }
    match (&file.sky, &file.environment) {
        (Some(sky), Some(_)) => {
            return Err(source.refuse("sky", sky, "is given with an environment", "remove one of them"));
        }
        (Some(sky), None) => draft.surroundings = Some(sky::read(source, sky)?),
        (None, Some(environment)) => draft.surroundings = Some(sky::panorama(source, environment, draft)?),
        (None, None) => {}
    }
    if let Some(light_mesh) = &file.lightmesh {
        draft.light_mesh = read_light_mesh(source, light_mesh)?;
    }
    Ok(())
}

fn read_ambient(source: &Source, entry: &AmbientEntry, draft: &mut Draft) -> Result<(), LoadError> {
    draft.ambient = entry.intensity.as_ref().map(|color| source.color("intensity", color)).transpose()?;
    draft.background = entry.background.as_ref().map(|color| source.color("background", color)).transpose()?;
    Ok(())
}

fn read_light_mesh(source: &Source, entry: &LightMeshEntry) -> Result<LightMeshDefaults, LoadError> {
    let positive = |key, value: &Option<Number>| -> Result<Option<f32>, LoadError> {
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
