//! PLY, the Stanford polygon format (Turk 1994): ASCII and binary in both byte orders.
//!
//! Not based on ply-rs, which builds a table of named values from every row, takes a multiple of the file's size in memory, and
//! trusts the counts in headers.
//!
//! - `vertex` with x y z, normals nx ny nz, texture coordinates (s t, u v, texture_u texture_v; v upwards) and colours, which are
//!   treated as sRGB; `face` with vertex_indices or vertex_index; `tristrips`. Elements may come in any order; their other
//!   properties are skipped. Values behind a row of an ASCII file are ignored with a warning, if each row has a line of its own.
//! - A face's colour replaces that of its vertices: vertices are split where faces of different colours meet.
//! - An image named by `comment TextureFile` colours vertices with texture coordinates.

mod error;
mod face;
mod header;
mod rows;
mod vertex;

use std::path::Path;

use glam::{DVec3, Vec3};

use self::{
    error::malformed,
    face::Faces,
    header::{Element, Encoding, Header},
    rows::{Fault, Row, Rows},
    vertex::{Color, Layout, Points},
};
use super::{
    notes::Notes,
    text::{line_of, quoted},
};
use crate::build::draft::Draft;
use crate::build::loaded_mesh::LoadedMesh;
use crate::build::placement::Placement;
use crate::build::quote::{self, list};
use crate::{LoadError, Material, Objects, TextureUse};

/// Names of the list that contains a face's or strip's vertices.
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads a PLY file into `draft`.
pub(crate) fn read(path: &Path, bytes: Vec<u8>, placement: &Placement, draft: &mut Draft) -> Result<(), LoadError> {
    draft.access.check_content(path, &bytes)?;
    let mut notes = Notes::default();
    let header = header::read(path, &bytes, &mut notes)?;
    let rows = Rows::new(&bytes, &header);
    let mut reader = Reader { path, bytes: &bytes, encoding: header.encoding, rows, notes };
    let (points, faces, warnings) = reader.elements(&header)?;
    draft.warnings.extend(reader.notes.warnings(path));
    // From here on its memory is needed for the scene.
    drop(bytes);
    draft.warnings.extend(warnings.into_iter().map(|warning| format!("{}: {warning}", path.display())));
    let material = match placement.material {
        Some(material) => material,
        None => textured(path, &header, &points, draft).unwrap_or_else(|| draft.default_material()),
    };
    draft.begin_object(placement.object_in(path));
    draft.take(mesh(points, faces, material), &placement.transform)
}

/// The material with the file's texture, if it has one.
fn textured(path: &Path, header: &Header, points: &Points, draft: &mut Draft) -> Option<u32> {
    let name = header.texture.as_ref().filter(|_| !points.uvs.is_empty())?;
    let texture = Some(TextureUse::new(draft.texture_file(path, name)?));
    draft.materials.push(Material { ka: Vec3::ONE, kd: Vec3::ONE, texture, ..Material::default() });
    Some(draft.materials.len() as u32 - 1)
}

fn mesh(points: Points, faces: Faces, material: u32) -> LoadedMesh<DVec3> {
    let Points { positions, normals, uvs, colors } = points;
    let materials = vec![material; faces.triangles.len()];
    let triangles = faces.triangles;
    let (groups, objects) = (Vec::new(), Objects::default());
    let mut mesh = LoadedMesh { positions, normals, uvs, colors, triangles, materials, groups, objects };
    match faces.split {
        None => mesh.drop_unused_vertices(),
        Some(split) => {
            let corners = split.into_corners();
            mesh.choose_vertices(corners.iter().map(|&[vertex, ..]| vertex));
            mesh.colors = corners.iter().map(|&[_, color, _]| faces.colors[color as usize]).collect();
        }
    }
    mesh
}

struct Reader<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    encoding: Encoding,
    rows: Rows<'a>,
    notes: Notes,
}

impl Reader<'_> {
    /// Everything that the scene needs, and the names of elements that it does not.
    fn elements(&mut self, header: &Header) -> Result<(Points, Faces, Vec<String>), LoadError> {
        let (mut points, mut faces) = (None, Faces::default());
        let mut waiting = Vec::new();
        let mut others = Vec::new();
        for element in &header.elements {
            self.check_room(element)?;
            match (element.name.as_str(), &points) {
                ("vertex", None) => points = Some(self.vertices(element)?),
                ("face" | "tristrips", Some(points)) => self.faces(element, points, &mut faces)?,
                (name, _) => {
                    // Faces can be triangulated only when their vertices are known.
                    match name {
                        "face" | "tristrips" => waiting.push((self.rows.at, element)),
                        _ if element.count > 0 => {
                            others.push(format!("{} ({})", quote::name(&element.name), element.count))
                        }
                        _ => {}
                    }
                    self.each_row(element, None, |_, _| Ok(()))?;
                }
            }
        }
        let Some(points) = points else {
            return Err(self.refuse("the file has no element `vertex`".to_owned()));
        };
        for (at, element) in waiting {
            self.rows.at = at;
            self.faces(element, &points, &mut faces)?;
        }
        let mut warnings: Vec<String> = faces.cutter.warning().into_iter().collect();
        if faces.left_out > 0 {
            warnings.push(format!("{} faces with fewer than three corners were ignored", faces.left_out));
        }
        if !others.is_empty() {
            warnings.push(format!("unknown elements were ignored: {}", list(others.iter().map(String::as_str))));
        }
        Ok((points, faces, warnings))
    }

    /// Stops reading before a count that the file cannot fulfil causes an allocation.
    fn check_room(&self, element: &Element) -> Result<(), LoadError> {
        let (room, count, name) = (self.rows.room(element), element.count, quote::name(&element.name));
        if count > room {
            let problem = format!(
                "the header declares {count} of element `{name}`, but the rest of the file has room for only {room}"
            );
            return Err(self.refuse(problem));
        }
        Ok(())
    }

    fn vertices(&mut self, element: &Element) -> Result<Points, LoadError> {
        let Some(layout) = Layout::of(element) else {
            return Err(self.refuse("element `vertex` lacks one of the properties x, y and z".to_owned()));
        };
        if element.count >= u64::from(u32::MAX) {
            return Err(LoadError::TooLarge { path: self.path.to_owned() });
        }
        let mut points = Points::default();
        self.each_row(element, None, |_, row| {
            layout.push(row, &mut points);
            Ok(())
        })?;
        Ok(points)
    }

    fn faces(&mut self, element: &Element, points: &Points, faces: &mut Faces) -> Result<(), LoadError> {
        let Some(list) = element.property(&INDICES) else {
            let problem = format!("element `{}` has no list vertex_indices or vertex_index", element.name);
            return if element.count > 0 { Err(self.refuse(problem)) } else { Ok(()) };
        };
        let (color, count) = (Color::of(element), points.positions.len());
        self.each_row(element, Some(list), |number, row| {
            let pushed = match element.name.as_str() {
                "tristrips" => faces.push_strips(row, count),
                _ => faces.push(row, color.as_ref(), &points.positions),
            };
            pushed.map_err(|index| {
                format!(
                    "row {number} of element `{}` refers to vertex {index}, but there are only {count}, counted from 0",
                    element.name
                )
            })
        })
    }

    /// Passes each row of an element to `take`, with its number counted from 1. If that fails, the error is located at the row's
    /// line.
    fn each_row(
        &mut self,
        element: &Element,
        list: Option<usize>,
        mut take: impl FnMut(u64, &Row) -> Result<(), String>,
    ) -> Result<(), LoadError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = Row::default();
        // Faces before their vertices are read twice.
        let is_waiting = list.is_none() && matches!(element.name.as_str(), "face" | "tristrips");
        for number in 1..=element.count {
            let read = self.rows.read(element, list, &mut row).map_err(|fault| {
                let place = format!("row {number} of {} of element `{}`", element.count, quote::name(&element.name));
                match fault {
                    Fault::Ended => format!("the file ends within {place}"),
                    Fault::NoNumber(word) => format!("`{word}` in {place} is not a number"),
                    Fault::NoCount(count) => format!("{place} has a list of {count} items"),
                }
            });
            read.and_then(|()| take(number, &row)).map_err(|problem| self.refuse(problem))?;
            if let Some(word) = self.rows.surplus()
                && !is_waiting
            {
                let first = || (line_of(self.bytes, self.rows.at.saturating_sub(1)), quoted(word));
                self.notes.add("is more than the header says of a row, and ignored", first);
            }
        }
        Ok(())
    }

    /// The error for a problem at the current position: in ASCII files, its line is known.
    fn refuse(&self, problem: String) -> LoadError {
        // The last byte that was read, not the line feed after it.
        let line = (self.encoding == Encoding::Ascii).then(|| line_of(self.bytes, self.rows.at.saturating_sub(1)));
        malformed(self.path, line, problem, "export it again, or copy it again if it is truncated")
    }
}
