//! Material libraries of OBJ files: Ka, Kd, Ks, Ns and Ke to the coefficients of formula (1).

use std::{
    io::Cursor,
    path::{Path, PathBuf},
};

use glam::{DVec3, Vec3};

use super::malformed;
use crate::{LoadError, Material, open::read_bytes};

/// What happened while libraries were read.
#[derive(Default)]
pub(super) struct Libraries {
    pub(super) failure: Option<LoadError>,
    pub(super) warnings: Vec<String>,
}

impl Libraries {
    /// Reads the libraries that an `mtllib` line names: one file whose name may hold blanks, or several without. One that
    /// cannot be read is a warning, because the shape is there without it.
    pub(super) fn load(&mut self, obj: &Path, names: &Path) -> tobj::MTLLoadResult {
        let names = names.to_string_lossy().replace('\\', "/");
        let folder = obj.parent().unwrap_or(Path::new(""));
        let whole = folder.join(&names);
        let files: Vec<PathBuf> = if whole.is_file() {
            vec![whole]
        } else {
            names.split_whitespace().map(|name| folder.join(name)).collect()
        };
        let mut text = String::new();
        for file in files {
            match read_bytes(&file) {
                Ok(bytes) => match checked(&file, &String::from_utf8_lossy(&bytes), &mut self.warnings) {
                    Ok(checked) => text.push_str(&checked),
                    Err(failure) => {
                        self.failure.get_or_insert(failure);
                    }
                },
                Err(error) => self.warnings.push(format!("{error}; light grey is used in its place")),
            }
        }
        tobj::load_mtl_buf(&mut Cursor::new(text))
    }
}

/// The lines that matter, each with as many numbers as tobj takes for granted.
fn checked(path: &Path, text: &str, warnings: &mut Vec<String>) -> Result<String, LoadError> {
    let mut checked = String::new();
    let mut textures = 0;
    for (index, line) in text.lines().enumerate() {
        let (word, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        let values: Vec<&str> = rest.split_whitespace().collect();
        match word {
            "newmtl" if rest.trim().is_empty() => {
                return Err(malformed(path, index + 1, "`newmtl` has no name".to_owned(), "name the material"));
            }
            "newmtl" => checked += &format!("newmtl {}\n", rest.trim()),
            "Ka" | "Kd" | "Ks" | "Ke" if matches!(values.first(), Some(&"spectral" | &"xyz")) => {
                warnings.push(format!("{}:{}: `{word} {}` is not read", path.display(), index + 1, values[0]));
            }
            "Ka" | "Kd" | "Ks" | "Ke" => {
                // One number stands for all channels.
                let [r, g, b] = match values[..] {
                    [grey] => [grey; 3],
                    [r, g, b, ..] => [r, g, b],
                    _ => return Err(not_numbers(path, index + 1, line)),
                };
                if ![r, g, b].iter().all(|value| is_number(value)) {
                    return Err(not_numbers(path, index + 1, line));
                }
                checked += &format!("{word} {r} {g} {b}\n");
            }
            "Ns" if values.first().is_some_and(|value| is_number(value)) => checked += &format!("Ns {}\n", values[0]),
            "Ns" => return Err(not_numbers(path, index + 1, line)),
            "map_Kd" => textures += 1,
            _ => {}
        }
    }
    if textures > 0 {
        warnings.push(format!("{}: {textures} materials have textures, which are not read", path.display()));
    }
    Ok(checked)
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok_and(|number| (number as f32).is_finite())
}

fn not_numbers(path: &Path, line: usize, text: &str) -> LoadError {
    malformed(path, line, format!("`{}` is not one number or three", text.trim()), "correct the line or export again")
}

/// Without Ka the ambient coefficient is the diffuse one; negative values count as 0. An exponent under 1 would smear the
/// highlight over everything (exporters write `Ns 0` for "none"), so it counts as 1.
pub(super) fn material(mtl: &tobj::Material) -> Material {
    let color = |value: Option<[f64; 3]>| value.map(|rgb| DVec3::from(rgb).as_vec3().max(Vec3::ZERO));
    let default = Material::default();
    let kd = color(mtl.diffuse).unwrap_or(default.kd);
    Material {
        name: mtl.name.clone(),
        ka: color(mtl.ambient).unwrap_or(kd),
        kd,
        ks: color(mtl.specular).unwrap_or(default.ks),
        shininess: mtl.shininess.map_or(default.shininess, |exponent| (exponent as f32).max(1.0)),
        emission: color(mtl.emissive).unwrap_or(default.emission),
        ..default
    }
}
