//! `EXT_lights_image_based`: six pictures of what surrounds a scene, the faces of a cube, become a panorama. Their prefiltered levels
//! and irradiance coefficients are not needed: both are computed.

use std::path::Path;

use glam::{Quat, Vec3};

use super::{
    buffers::Buffers,
    document::{Document, ImageBasedLight},
    nodes,
    uri::{self, Uri},
};
use crate::build::draft::Draft;
use crate::build::textures::decode::{Undecodable, decode};
use crate::model::colors::linear;
use crate::{Environment, LoadError, Surroundings, Texture, Up};

/// The columns of a panorama for each texel of a face's side.
const COLUMNS: u32 = 4;
/// Bytes of a texel of the panorama and its means.
const BYTES: u64 = 12 + 16;

/// What surrounds the scene that is shown. What cannot be used is a warning.
pub(super) fn read(path: &Path, document: &Document, buffers: &Buffers, draft: &mut Draft) -> Result<(), LoadError> {
    let scene = nodes::scene_index(document).and_then(|index| document.scenes.get(index));
    let Some(reference) = scene.and_then(|scene| scene.extensions.as_ref()?.environment.as_ref()) else {
        return Ok(());
    };
    let light = document.extensions.image_based.lights.get(reference.light as usize);
    let found = match light {
        Some(light) => surroundings(path, document, buffers, light, draft),
        None => Err(Unusable::Odd(format!("there is no light {}", reference.light))),
    };
    match found {
        Ok(surroundings) => draft.surroundings = Some(surroundings),
        Err(Unusable::Odd(reason)) => {
            draft.warnings.push(format!("{}: its environment cannot be used ({reason})", path.display()));
        }
        Err(Unusable::Load(error)) => return Err(error),
    }
    Ok(())
}

/// Why an environment cannot be used.
enum Unusable {
    /// Something is wrong with it, worded to be put in brackets.
    Odd(String),
    /// There is not enough memory.
    Load(LoadError),
}

fn surroundings(
    path: &Path,
    document: &Document,
    buffers: &Buffers,
    light: &ImageBasedLight,
    draft: &mut Draft,
) -> Result<Surroundings, Unusable> {
    let odd = |reason: &str| Unusable::Odd(reason.to_owned());
    let [x, y, z, w] = light.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let rotation = Quat::from_xyzw(x as f32, y as f32, z as f32, w as f32);
    let intensity = light.intensity.unwrap_or(1.0) as f32;
    if !(rotation.length_squared() > 0.0 && rotation.is_finite() && intensity >= 0.0 && intensity.is_finite()) {
        return Err(odd("its rotation or its intensity is no number that can be used"));
    }
    let images = light.specular_images.first().ok_or_else(|| odd("it has no pictures"))?;
    let mut faces = Vec::with_capacity(6);
    for &image in images.iter() {
        faces.push(face(path, document, buffers, image, draft)?);
    }
    let side = faces.first().map_or(0, |face: &Texture| face.size[0]);
    let Ok(faces) = <[Texture; 6]>::try_from(faces) else { return Err(odd("a cube has six faces")) };
    if faces.iter().any(|face| face.size != [side; 2]) {
        return Err(odd("its faces are not squares of the same size"));
    }
    let size = [COLUMNS * side, COLUMNS / 2 * side];
    let texels = u64::from(size[0]) * u64::from(size[1]);
    draft.access.budget.check(BYTES * texels).map_err(|short| {
        let what = format!("an environment of {}x{} texels", size[0], size[1]);
        Unusable::Load(LoadError::Memory { path: path.to_owned(), what, short })
    })?;
    let cube = Cube { faces: &faces, side };
    let back = rotation.normalize().conjugate();
    let seen = |direction| intensity * cube.at(back * direction);
    Ok(Environment::seen("environment", size, Up::Y, seen).find_sun().into())
}

/// The picture of a face.
fn face(
    path: &Path,
    document: &Document,
    buffers: &Buffers,
    index: u32,
    draft: &mut Draft,
) -> Result<Texture, Unusable> {
    let odd = |reason: String| Unusable::Odd(format!("image {index}: {reason}"));
    let image = document.images.get(index as usize).ok_or_else(|| odd("it is not there".to_owned()))?;
    let read;
    let bytes = match (image.buffer_view, image.uri.as_deref().map(Uri::new)) {
        (Some(view), _) => buffers.view(view).map_err(|error| odd(error.to_string()))?.0,
        (None, Some(Uri::Data(data))) => {
            read = uri::decode(data).ok_or_else(|| odd("its data is invalid".to_owned()))?;
            &read
        }
        (None, Some(Uri::File(name))) => {
            read = draft.read_nearby(path, &name).map_err(|error| odd(error.to_string()))?.1;
            &read
        }
        (None, None) => return Err(odd("it has no data".to_owned())),
    };
    let name = format!("image {index}");
    decode(&name, bytes, draft.access.budget).map_err(|error| match error {
        Undecodable::Odd(reason) => odd(reason),
        Undecodable::TooLarge { size: [width, height], short } => {
            let what = format!("a texture of {width}x{height} texels");
            Unusable::Load(LoadError::Memory { path: path.to_owned(), what, short })
        }
    })
}

/// Six squares with `side` texels along each edge: +X, −X, +Y, −Y, +Z and −Z, as they are seen from the middle.
struct Cube<'a> {
    faces: &'a [Texture; 6],
    side: u32,
}

impl Cube<'_> {
    /// What is seen along a direction: the four nearest texels of a face, interpolated.
    fn at(&self, d: Vec3) -> Vec3 {
        let size = d.abs();
        // The face, the way to it, and what is to its right and down.
        let (face, far, right, down) = if size.x >= size.y && size.x >= size.z {
            if d.x > 0.0 { (0, d.x, d.z, -d.y) } else { (1, -d.x, -d.z, -d.y) }
        } else if size.y >= size.z {
            if d.y > 0.0 { (2, d.y, -d.x, d.z) } else { (3, -d.y, -d.x, -d.z) }
        } else if d.z > 0.0 {
            (4, d.z, -d.x, -d.y)
        } else {
            (5, -d.z, d.x, -d.y)
        };
        let place = |aside: f32| {
            let texels = (0.5 + 0.5 * aside / far) * self.side as f32 - 0.5;
            let first = texels.floor();
            let index = |at: f32| at.clamp(0.0, self.side as f32 - 1.0) as u32;
            ([index(first), index(first + 1.0)], texels - first)
        };
        let (columns, x) = place(right);
        let (rows, y) = place(down);
        let texels = &self.faces[face].texels;
        let [upper, lower] = rows.map(|row| {
            let [a, b] = columns.map(|column| radiance(texels[(row * self.side + column) as usize]));
            a.lerp(b, x)
        });
        upper.lerp(lower, y)
    }
}

/// Colours are divided by alpha (RGBD), so that they can be brighter than 1; pictures without alpha are what they show.
fn radiance([red, green, blue, divisor]: [u8; 4]) -> Vec3 {
    linear([red, green, blue].map(|code| f32::from(code) / 255.0).into()) * (255.0 / f32::from(divisor.max(1)))
}
