//! The lines of an OBJ file, one by one: points, and triangles made of vertices.

use std::{
    collections::{HashMap, HashSet},
    path::Path,
};

use glam::{DVec3, Vec2, Vec3};

use super::{
    error::{Fault, malformed},
    face::{self, Counts},
    lines::Lines,
    smoothing::Smoothing,
};
use crate::formats::notes::Notes;
use crate::formats::polygon::Cutter;
use crate::formats::text::{decoded, number, odd_number, quoted, split_word, words};
use crate::formats::vertices::{Corner, Vertices};
use crate::{LoadError, Objects};

/// Maximum number of values read from a position: three coordinates and a colour.
const MAX_NUMBERS: usize = 6;

/// First words of positions, texture coordinates and normals.
const POINTS: [&[u8]; 3] = [b"v", b"vt", b"vn"];

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
    /// By triangle: its smoothing group, 0 for none; empty if the file has none, or if they are not wanted.
    pub(super) groups: Vec<u32>,
    /// The object of each triangle: by `o`, else by `g`; none if the file has no names.
    pub(super) objects: Objects,
    /// Names in the order of their first use; the empty one means none.
    pub(super) materials: Vec<String>,
    /// The lines `mtllib`, each once: number and names.
    pub(super) libraries: Vec<(usize, String)>,
    pub(super) warnings: Vec<String>,
}

/// Reads all lines. Faces may be above what they refer to: if one cannot be read, or lacks an attribute that is found later, all points are
/// read before all faces. Smoothing groups are read if `with_groups`.
pub(super) fn parse(path: &Path, text: &[u8], with_groups: bool) -> Result<Content, LoadError> {
    let new = || Parser { smoothing: with_groups.then(Smoothing::default), ..Parser::default() };
    let mut parser = new();
    let read = parser.read(path, text, |_| true);
    if parser.refers_ahead() {
        parser = new();
        parser.read(path, text, is_point)?;
        parser.above = Some([0; 3]);
        parser.read(path, text, |_| true)?;
    } else {
        read?;
    }
    Ok(parser.finish(path))
}

/// Whether faces can refer to lines with this word.
fn is_point(word: &[u8]) -> bool {
    POINTS.contains(&word)
}

#[derive(Default)]
struct Parser {
    /// Number of the current line.
    line: usize,
    points: Points,
    vertices: Vertices,
    cutter: Cutter,
    triangles: Vec<[u32; 3]>,
    material_of_triangle: Vec<u32>,
    /// Index of each material's name.
    materials: HashMap<String, u32>,
    material: Option<u32>,
    libraries: Vec<(usize, String)>,
    known_libraries: HashSet<String>,
    points_and_lines: usize,
    notes: Notes,
    /// Those of the last lines `o` and `g`, and whether one of them is new.
    names: [String; 2],
    is_renamed: bool,
    objects: Objects,
    /// If smoothing groups are wanted.
    smoothing: Option<Smoothing>,
    /// If all points have been read: how many are above the current line.
    above: Option<[usize; 3]>,
    is_face_refused: bool,
    /// Whether a face refers to an attribute of which there was none.
    lacks: [bool; 3],
    // Buffers for the current face, reused to avoid allocation.
    face: Vec<Corner>,
    face_vertices: Vec<u32>,
    face_positions: Vec<DVec3>,
}

impl Parser {
    /// Reads the lines whose first words are `wanted`.
    fn read(&mut self, path: &Path, text: &[u8], wanted: fn(&[u8]) -> bool) -> Result<(), LoadError> {
        let mut lines = Lines::new(text);
        while let Some((number, line)) = lines.next_line() {
            let (word, rest) = split_word(line);
            if wanted(word) {
                self.line = number;
                self.statement(word, rest)
                    .map_err(|Fault(problem, remedy)| malformed(path, number, problem, remedy))?;
            }
        }
        Ok(())
    }

    fn refers_ahead(&self) -> bool {
        let counts = self.counts();
        self.is_face_refused || (0..counts.len()).any(|kind| self.lacks[kind] && counts[kind] > 0)
    }

    /// Numbers of positions, texture coordinates and normals so far.
    fn counts(&self) -> [usize; 3] {
        let Points { positions, uvs, normals, .. } = &self.points;
        [positions.len(), uvs.len(), normals.len()]
    }

    fn statement(&mut self, word: &[u8], rest: &[u8]) -> Result<(), Fault> {
        if let Some(above) = &mut self.above
            && let Some(kind) = POINTS.iter().position(|&point| point == word)
        {
            above[kind] += 1;
            return Ok(());
        }
        match word {
            b"v" => self.position(rest)?,
            b"vt" => {
                // One number is a one-dimensional texture. In the file v points upwards.
                let ([u, v, ..], _) = self.numbers(word, rest, 1)?;
                self.points.uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
            }
            b"vn" => {
                let ([x, y, z, ..], _) = self.numbers(word, rest, 3)?;
                self.points.normals.push(DVec3::new(x, y, z).as_vec3());
            }
            b"f" | b"fo" => self.face(rest)?,
            b"l" | b"p" => self.points_and_lines += 1,
            b"usemtl" => self.material = Some(self.material_named(&decoded(rest))),
            b"mtllib" => {
                let names = decoded(rest).into_owned();
                if self.known_libraries.insert(names.clone()) {
                    self.libraries.push((self.line, names));
                }
            }
            b"s" => self.smoothing_group(rest),
            b"o" | b"g" => {
                self.names[usize::from(word == b"g")] = decoded(rest).trim().to_owned();
                self.is_renamed = true;
            }
            b"" | b"mg" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" => {}
            [b'#', ..] => {}
            _ => self.notes.add("is an unknown statement, which is ignored", || (self.line, quoted(word))),
        }
        Ok(())
    }

    fn position(&mut self, rest: &[u8]) -> Result<(), Fault> {
        let ([x, y, z, r, g, b], count) = self.numbers(b"v", rest, 3)?;
        let Points { positions, colors, .. } = &mut self.points;
        if count == MAX_NUMBERS {
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
        let all = self.counts();
        let counts = Counts { above: self.above.unwrap_or(all), all };
        let Parser { line, notes, lacks, .. } = self;
        let read = face::read(rest, counts, &mut self.face, |kind, oddity, word| {
            lacks[kind] = true;
            notes.add(oddity, || (*line, quoted(word)));
        });
        self.is_face_refused = read.is_err();
        read?;
        if self.face.len() < 3 {
            self.points_and_lines += 1;
            return Ok(());
        }
        let material = self.material.unwrap_or_else(|| self.material_named(""));
        self.material = Some(material);
        self.face_vertices.clear();
        self.face_vertices.extend(self.face.iter().map(|&corner| self.vertices.of(corner)));
        if std::mem::take(&mut self.is_renamed) {
            let name = self.names.iter().find(|name| !name.is_empty());
            self.objects.begin(self.triangles.len(), name.map_or("", |name| name));
        }
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
        if let Some(smoothing) = &mut self.smoothing {
            smoothing.extend_to(self.triangles.len());
        }
        Ok(())
    }

    fn smoothing_group(&mut self, rest: &[u8]) {
        let Some(smoothing) = &mut self.smoothing else { return };
        let word = words(rest).next().unwrap_or_default();
        if !smoothing.begin(word, self.triangles.len()) {
            self.notes.add("is no smoothing group, and is ignored", || (self.line, quoted(word)));
        }
    }

    fn finish(self, path: &Path) -> Content {
        let mut warnings = Vec::new();
        if self.points_and_lines > 0 {
            warnings.push(format!("{}: {} points and lines were ignored", path.display(), self.points_and_lines));
        }
        warnings.extend(self.notes.warnings(path));
        let path = path.display();
        warnings.extend(self.cutter.warning().map(|warning| format!("{path}: {warning}")));
        let mut materials: Vec<(String, u32)> = self.materials.into_iter().collect();
        materials.sort_unstable_by_key(|&(_, number)| number);
        Content {
            points: self.points,
            corners: self.vertices.into_corners(),
            triangles: self.triangles,
            groups: self.smoothing.unwrap_or_default().groups,
            material_of_triangle: self.material_of_triangle,
            objects: self.objects,
            materials: materials.into_iter().map(|(name, _)| name).collect(),
            libraries: self.libraries,
            warnings,
        }
    }

    /// The numbers of a line up to a comment, padded with zeros, and how many there are: at least `least`. What follows them is ignored;
    /// but a second or third word that is no number must be damage.
    fn numbers(&mut self, word: &[u8], rest: &[u8], least: usize) -> Result<([f64; MAX_NUMBERS], usize), Fault> {
        const REMEDY: &str = "correct the line or export the file again";
        const NEEDED: usize = 3;
        let mut numbers = [0.0; MAX_NUMBERS];
        let mut count = 0;
        for text in words(rest).take_while(|word| word[0] != b'#').take(MAX_NUMBERS) {
            if let Some(number) = number(text) {
                numbers[count] = number;
            } else if let Some(number) = odd_number(text) {
                self.notes.add("is an odd way to write a number, but known", || (self.line, quoted(text)));
                numbers[count] = number;
            } else if count < NEEDED {
                let problem = format!("`{}` in a line `{}` is not a number", quoted(text), decoded(word));
                return Err(Fault(problem, REMEDY));
            } else {
                self.notes.add("behind the numbers is ignored", || (self.line, quoted(text)));
                break;
            }
            count += 1;
        }
        if count < least {
            return Err(Fault(format!("a line `{}` has fewer than {least} numbers", decoded(word)), REMEDY));
        }
        Ok((numbers, count))
    }
}
