//! The three scenes of the thesis, generated in their spirit: Gazebo, Childpark and Garden.
//!
//! | scene | triangles | lights | size, x × y × z | step h of the thesis |
//! |---|---|---|---|---|
//! | `gazebo` | 300 | 3 | 30 × 20 × 40 | 2 |
//! | `childpark` | 27 000 | 2 | 160 × 120 × 140 | 1 |
//! | `garden` | 234 000 | 1 | 20 × 6 × 28 | 0.1 |
//!
//! Triangle counts hold within 2 %, sizes within 10 %. Y is up, lights have no falloff, and every scene has one camera whose square image
//! is filled by geometry (in Childpark all but a few gaps between leaves). The thesis publishes no models: ours have its counts and sizes,
//! but not its shapes. Scenes are bit-identical on every machine.
//!
//! [`LightMeshDefaults::step`](crate::LightMeshDefaults) stays empty so that the step follows the pixels; use the thesis's step to repeat
//! its experiments.

mod childpark;
mod composition;
mod foliage;
mod garden;
mod gazebo;
mod lights;
pub(crate) mod math;
mod options;
mod parts;
mod plants;
mod surfaces;

pub use childpark::childpark;
pub use garden::garden;
pub use gazebo::gazebo;
pub use options::BuiltinOptions;

use crate::{LoadError, Scene};

/// Generates one of the scenes from its options.
type Generator = fn(&BuiltinOptions) -> Scene;

const SCENES: [(&str, Generator); 3] = [("gazebo", gazebo), ("childpark", childpark), ("garden", garden)];

/// Generates the scene specified by `query`: `NAME` or `NAME?lights=N&spread=S`, the text after `builtin:`.
///
/// # Errors
///
/// [`LoadError::UnknownBuiltin`] for an unknown name, [`LoadError::BuiltinParameter`] for an unknown option or an invalid value.
pub(crate) fn open(query: &str) -> Result<Scene, LoadError> {
    let (name, options) = query.split_once('?').unwrap_or((query, ""));
    let generate = SCENES.iter().find(|(known, _)| *known == name).map(|(_, generate)| generate);
    let generate = generate.ok_or_else(|| LoadError::UnknownBuiltin {
        name: name.into(),
        known: SCENES.map(|(known, _)| known.to_owned()).to_vec(),
    })?;
    Ok(generate(&BuiltinOptions::parse(name, options)?))
}
