//! The vertices of a PLY file.

use glam::{DVec3, Vec2, Vec3};

use super::{
    header::{Element, Shape},
    rows::Row,
};
use crate::model::colors::linear;

/// Vertices in the file's order; attributes for all of them or for none.
#[derive(Debug, Default)]
pub(super) struct Points {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) colors: Vec<Vec3>,
}

/// The meaning of a row's numbers.
pub(super) struct Layout {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    color: Option<Color>,
}

impl Layout {
    /// `None` if vertices have no position.
    pub(super) fn of(element: &Element) -> Option<Layout> {
        let uv_names = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];
        Some(Layout {
            position: numbers(element, ["x", "y", "z"])?,
            normal: numbers(element, ["nx", "ny", "nz"]),
            uv: uv_names.into_iter().find_map(|names| numbers(element, names)),
            color: Color::of(element),
        })
    }

    /// Adds one vertex.
    pub(super) fn push(&self, row: &Row, points: &mut Points) {
        let vector = |[x, y, z]: [usize; 3]| DVec3::new(row.values[x], row.values[y], row.values[z]);
        points.positions.push(vector(self.position));
        points.normals.extend(self.normal.map(|normal| vector(normal).as_vec3()));
        // In the file v points upwards.
        points.uvs.extend(self.uv.map(|[u, v]| Vec2::new(row.values[u] as f32, (1.0 - row.values[v]) as f32)));
        points.colors.extend(self.color.as_ref().map(|color| color.linear(row)));
    }
}

/// The indices of a row's colour channels.
pub(super) struct Color {
    channels: [usize; 3],
    /// The value of each channel at full intensity.
    full: f64,
}

impl Color {
    pub(super) fn of(element: &Element) -> Option<Color> {
        let names = [["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"], ["r", "g", "b"]];
        let channels = names.into_iter().find_map(|names| numbers(element, names))?;
        let Shape::One(of) = element.properties[channels[0]].shape else { return None };
        Some(Color { channels, full: of.full() })
    }

    /// The row's colour, decoded from sRGB.
    pub(super) fn linear(&self, row: &Row) -> Vec3 {
        linear(Vec3::from_array(self.channels.map(|channel| (row.values[channel] / self.full) as f32)))
    }
}

/// The properties with these names, if all exist and are single numbers.
fn numbers<const COUNT: usize>(element: &Element, names: [&str; COUNT]) -> Option<[usize; COUNT]> {
    let mut found = [0; COUNT];
    for (slot, name) in found.iter_mut().zip(names) {
        *slot = element.property(&[name])?;
        if !matches!(element.properties[*slot].shape, Shape::One(_)) {
            return None;
        }
    }
    Some(found)
}
