//! The lines of an OBJ file, one by one: points, and triangles made of vertices.

use std::{collections::HashMap, path::Path};

use glam::{DVec3, Vec2, Vec3};

use super::{face, lines::Lines, malformed};
use crate::{
    LoadError,
    formats::{
        polygon::Cutter,
        text::{decoded, number, quoted, split_word, words},
        vertices::{Corner, Vertices},
    },
};

/// Maximum number of values read from a position: three coordinates and a colour.
const MOST_NUMBERS: usize = 6;

/// Maximum length of an unknown statement in a warning, in bytes.
const NAMED: usize = 20;

/// The problem with a line, and the remedy.
pub(super) struct Fault(pub(super) String, pub(super) &'static str);

/// The data that faces refer to, in the file's order.
#[derive(Default)]
pub(super) struct Points {
    pub(super) positions: Vec<DVec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// By position, as in the file; empty if no position has one, NaN for those without one.
    pub(super) colors: Vec<Vec3>,
}

/// The content of a file.
pub(super) struct Content {
    pub(super) points: Points,
    /// By vertex: indices of position, texture coordinate and normal.
    pub(super) corners: Vec<Corner>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// By triangle: index into `materials`.
    pub(super) material_of_triangle: Vec<u32>,
    /// Names in the order of their first use; the empty one means none.
    pub(super) materials: Vec<String>,
    /// The names in `mtllib` lines.
    pub(super) libraries: Vec<String>,
    pub(super) warnings: Vec<String>,
}

/// Reads all lines.
pub(super) fn parse(path: &Path, text: &[u8]) -> Result<Content, LoadError> {
    let mut parser = Parser::default();
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next() {
        if let Err(Fault(problem, remedy)) = parser.statement(line) {
            return Err(malformed(path, lines.number, problem, remedy));
        }
        if parser.unknown.is_some() && parser.unknown_line == 0 {
            parser.unknown_line = lines.number;
        }
    }
    Ok(parser.finish(path))
}

#[derive(Default)]
struct Parser {
    points: Points,
    vertices: Vertices,
    cutter: Cutter,
    triangles: Vec<[u32; 3]>,
    material_of_triangle: Vec<u32>,
    /// Index of each material's name.
    materials: HashMap<String, u32>,
    material: Option<u32>,
    libraries: Vec<String>,
    points_and_lines: usize,
    unknown: Option<String>,
    unknown_line: usize,
    // Buffers for the current face, reused to avoid allocation.
    face: Vec<Corner>,
    face_vertices: Vec<u32>,
    face_positions: Vec<DVec3>,
}

impl Parser {
    fn statement(&mut self, line: &[u8]) -> Result<(), Fault> {
        let (word, rest) = split_word(line);
        match word {
            b"v" => self.position(rest)?,
            b"vt" => {
                // One number is a one-dimensional texture. In the file v points upwards.
                let ([u, v, ..], _) = numbers(word, rest, 1)?;
                self.points.uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
            }
            b"vn" => {
                let ([x, y, z, ..], _) = numbers(word, rest, 3)?;
                self.points.normals.push(DVec3::new(x, y, z).as_vec3());
            }
            b"f" | b"fo" => self.face(rest)?,
            b"l" | b"p" => self.points_and_lines += 1,
            b"usemtl" => self.material = Some(self.material_named(&decoded(rest))),
            b"mtllib" => self.libraries.push(decoded(rest).into_owned()),
            b"" | b"g" | b"o" | b"s" | b"mg" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" => {}
            [b'#', ..] => {}
            _ => {
                self.unknown.get_or_insert_with(|| quoted(&word[..word.len().min(NAMED)]));
            }
        }
        Ok(())
    }

    fn position(&mut self, rest: &[u8]) -> Result<(), Fault> {
        let ([x, y, z, r, g, b], count) = numbers(b"v", rest, 3)?;
        let Points { positions, colors, .. } = &mut self.points;
        if count == MOST_NUMBERS {
            colors.resize(positions.len(), Vec3::NAN);
            colors.push(DVec3::new(r, g, b).as_vec3());
        } else if !colors.is_empty() {
            colors.push(Vec3::NAN);
        }
        positions.push(DVec3::new(x, y, z));
        Ok(())
    }

    /// The index of a material's name.
    fn material_named(&mut self, name: &str) -> u32 {
        if let Some(&known) = self.materials.get(name) {
            return known;
        }
        let added = self.materials.len() as u32;
        self.materials.insert(name.to_owned(), added);
        added
    }

    fn face(&mut self, rest: &[u8]) -> Result<(), Fault> {
        let Points { positions, uvs, normals, .. } = &self.points;
        let counts = [positions.len(), uvs.len(), normals.len()];
        face::read(rest, counts, &mut self.face)?;
        if self.face.len() < 3 {
            self.points_and_lines += 1;
            return Ok(());
        }
        let material = self.material.unwrap_or_else(|| self.material_named(""));
        self.material = Some(material);
        self.face_vertices.clear();
        self.face_vertices.extend(self.face.iter().map(|&corner| self.vertices.of(corner)));
        let vertices = &self.face_vertices;
        if let &[a, b, c] = &vertices[..] {
            self.triangles.push([a, b, c]);
        } else {
            self.face_positions.clear();
            self.face_positions.extend(self.face.iter().map(|corner| self.points.positions[corner[0] as usize]));
            let triangles = &mut self.triangles;
            self.cutter.cut(&self.face_positions, |triangle| triangles.push(triangle.map(|corner| vertices[corner])));
        }
        self.material_of_triangle.resize(self.triangles.len(), material);
        Ok(())
    }

    fn finish(self, path: &Path) -> Content {
        let path = path.display();
        let mut warnings = Vec::new();
        if self.points_and_lines > 0 {
            warnings.push(format!("{path}: {} points and lines were ignored", self.points_and_lines));
        }
        if let Some(word) = &self.unknown {
            let line = self.unknown_line;
            warnings.push(format!("{path}:{line}: `{word}` and other unknown statements were ignored"));
        }
        warnings.extend(self.cutter.warning().map(|warning| format!("{path}: {warning}")));
        let mut materials: Vec<(String, u32)> = self.materials.into_iter().collect();
        materials.sort_unstable_by_key(|&(_, number)| number);
        Content {
            points: self.points,
            corners: self.vertices.into_corners(),
            triangles: self.triangles,
            material_of_triangle: self.material_of_triangle,
            materials: materials.into_iter().map(|(name, _)| name).collect(),
            libraries: self.libraries,
            warnings,
        }
    }
}

/// The numbers of a line up to a comment, padded with zeros, and how many there are: at least `least`. Further words are
/// ignored.
fn numbers(word: &[u8], rest: &[u8], least: usize) -> Result<([f64; MOST_NUMBERS], usize), Fault> {
    const REMEDY: &str = "correct the line or export the file again";
    let mut numbers = [0.0; MOST_NUMBERS];
    let mut count = 0;
    for text in words(rest).take_while(|word| word[0] != b'#').take(MOST_NUMBERS) {
        let line = || format!("{} {}", decoded(word), quoted(rest));
        numbers[count] =
            number(text).ok_or_else(|| Fault(format!("`{}` in `{}` is not a number", quoted(text), line()), REMEDY))?;
        count += 1;
    }
    if count < least {
        let problem = format!("`{} {}` has fewer than {least} numbers", decoded(word), quoted(rest));
        return Err(Fault(problem, REMEDY));
    }
    Ok((numbers, count))
}
