//! What can be wrong with a scene file, said so that its author can mend it.

use std::{fmt, io, path::Path, path::PathBuf};

/// Where in a file something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as it was named by the caller or by the file that refers to it.
    pub path: PathBuf,
    /// Line and column, both counted from 1; `None` in binary files.
    pub line: Option<(usize, usize)>,
}

impl Place {
    /// The file as a whole.
    pub fn file(path: &Path) -> Place {
        Place { path: path.to_owned(), line: None }
    }

    /// The beginning of a line, counted from 1.
    pub fn line(path: &Path, line: usize) -> Place {
        Place { path: path.to_owned(), line: Some((line, 1)) }
    }

    /// The place of a byte in the text of a file.
    pub fn byte(path: &Path, text: &str, byte: usize) -> Place {
        let before = text.get(..byte).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        Place { path: path.to_owned(), line: Some((line, before[line_start..].chars().count() + 1)) }
    }
}

/// `file:line`, or the file alone.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.line {
            Some((line, _)) => write!(f, "{}:{line}", self.path.display()),
            None => write!(f, "{}", self.path.display()),
        }
    }
}

/// Why a scene could not be read. One line each: what is wrong, where, and what to do. Places are boxed to keep results small.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file system rejected.
    #[error("cannot read the file ({cause}), {}; check that it exists and may be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        cause: io::Error,
    },
    /// A folder, a pipe or a device.
    #[error("this is not a regular file, {}; name a file", path.display())]
    NoFile {
        /// What was named.
        path: PathBuf,
    },
    /// The name's ending is not that of a known format.
    #[error("`.{extension}` is not a format that can be read, {}; known are {}, and builtin:NAME", path.display(), known.join(", "))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its ending without the dot; may be empty.
        extension: String,
        /// Endings that can be read.
        known: Vec<String>,
    },
    /// No built-in scene has this name.
    #[error("there is no built-in scene `{name}`, builtin:{name}; known are {}", known.join(", "))]
    UnknownBuiltin {
        /// The name asked for.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A built-in scene does not take this parameter or this value.
    #[error("{problem}, builtin:{name}?{parameter}={value}; {remedy}")]
    BuiltinParameter {
        /// Name of the scene.
        name: String,
        /// Parameter before the `=`.
        parameter: String,
        /// Text after the `=`.
        value: String,
        /// What is wrong.
        problem: String,
        /// What to write instead.
        remedy: String,
    },
    /// The text does not follow the format's grammar or types.
    #[error("{problem}, {place}; {remedy}")]
    Syntax {
        /// Where.
        place: Box<Place>,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A key that the table does not have.
    #[error("unknown key `{key}`, {place}; {}", suggestion(key, known))]
    UnknownKey {
        /// Where.
        place: Box<Place>,
        /// The key.
        key: String,
        /// All keys of the table.
        known: Vec<String>,
    },
    /// A key that must be there is not.
    #[error("key `{key}` is missing, {place}; {remedy}")]
    MissingKey {
        /// The table that lacks it.
        place: Box<Place>,
        /// The key, or keys, that would do.
        key: String,
        /// What to write.
        remedy: String,
    },
    /// A value that cannot be used.
    #[error("{key} = {value} {problem}, {place}; {remedy}")]
    Value {
        /// Where.
        place: Box<Place>,
        /// The key.
        key: String,
        /// The value, as text.
        value: String,
        /// What is wrong with it, as a predicate: "is not above 0".
        problem: String,
        /// What to write instead.
        remedy: String,
    },
    /// A reference to something that is not there.
    #[error("there is no {kind} named `{name}`, {place}; {}", suggestion(name, known))]
    UnknownName {
        /// Where.
        place: Box<Place>,
        /// What is referred to: "material", "camera".
        kind: &'static str,
        /// The name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A file that contradicts itself or its format.
    #[error("{problem}, {place}; {remedy}")]
    Malformed {
        /// Where.
        place: Box<Place>,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// The file cannot be shown without an extension of its format that is not known here.
    #[error("the file requires the extension {extension}, {}; export it again without (known: {})", path.display(), known.join(", "))]
    UnsupportedExtension {
        /// The file.
        path: PathBuf,
        /// Name of the extension.
        extension: String,
        /// Extensions that are known.
        known: Vec<String>,
    },
    /// A reference that leads out of the scene's folder.
    #[error("`{name}` lies outside the scene's folder, {place}; move it there, or allow references to lead outside")]
    Outside {
        /// The file that refers to it.
        place: Box<Place>,
        /// The reference.
        name: String,
    },
    /// Something to warn of, where warnings count as errors.
    #[error("{}, {}; mend it, or read the scene less strictly", warnings.join("; "), path.display())]
    Warnings {
        /// The file.
        path: PathBuf,
        /// All warnings.
        warnings: Vec<String>,
    },
    /// More than there is memory for.
    #[error("there is no memory for {vertices} vertices and {triangles} triangles, {}; split the scene or thin it out", path.display())]
    Memory {
        /// The file that is opened.
        path: PathBuf,
        /// Vertices, every use of a mesh counted.
        vertices: usize,
        /// Triangles, every use of a mesh counted.
        triangles: usize,
    },
    /// More vertices or triangles than 32-bit indices can tell apart.
    #[error("the scene has more than {} vertices or triangles, {}; split it or thin it out", u32::MAX, path.display())]
    TooLarge {
        /// The file that went over the limit.
        path: PathBuf,
    },
}

/// The nearest known name, or all of them: the remedy for a misspelt one.
fn suggestion(name: &str, known: &[String]) -> String {
    let similarity = |candidate: &&String| (1e6 * strsim::jaro_winkler(name, candidate)) as u32;
    match known.iter().max_by_key(similarity).filter(|best| similarity(best) > 800_000) {
        _ if known.is_empty() => "there are none: define it first, or leave the reference out".to_owned(),
        Some(best) => format!("did you mean `{best}`? Known are {}", known.join(", ")),
        None => format!("known are {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known() -> Vec<String> {
        ["center", "material", "radius"].map(str::to_owned).to_vec()
    }

    #[test]
    fn a_byte_has_a_line_and_a_column() {
        let place = |byte| Place::byte(Path::new("f"), "ab\ncd\n", byte).line;
        assert_eq!([place(0), place(1), place(3), place(4)], [Some((1, 1)), Some((1, 2)), Some((2, 1)), Some((2, 2))]);
    }

    #[test]
    fn a_misspelt_key_is_answered_with_the_nearest() {
        let place = Place::line(Path::new("room.toml"), 7);
        let error = LoadError::UnknownKey { place: place.into(), key: "raduis".into(), known: known() };
        let message = "unknown key `raduis`, room.toml:7; did you mean `radius`? Known are center, material, radius";
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn a_far_fetched_name_is_answered_with_all() {
        assert_eq!(suggestion("xyz", &known()), "known are center, material, radius");
        assert!(suggestion("xyz", &[]).contains("define it"));
    }
}
