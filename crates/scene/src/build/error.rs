//! Errors in scene files, worded so that the author can fix them.

use std::{fmt, io, path::Path, path::PathBuf};

use lightmesh_memory::OverBudget;

use crate::build::other_programs;
use crate::build::quote::{self, list, quote, reference};

/// The location of an error in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as named by the caller or by the file that refers to it.
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

    /// The location of a byte in the text of a file.
    pub fn byte(path: &Path, text: &str, byte: usize) -> Place {
        let before = text.get(..byte).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        Place { path: path.to_owned(), line: Some((line, before[line_start..].chars().count() + 1)) }
    }
}

/// `file:line`, or only the file.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.line {
            Some((line, _)) => write!(f, "{}:{line}", self.path.display()),
            None => write!(f, "{}", self.path.display()),
        }
    }
}

/// Why a scene could not be read. One line each: the problem, the location, and the remedy. Fields hold what files say; messages quote
/// little of it. Places are boxed to keep results small.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file system returned an error.
    #[error("cannot read the file ({cause}), {}; check that it exists and is readable", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        cause: io::Error,
    },
    /// The path names a folder, a pipe or a device.
    #[error("this is not a regular file, {}; specify a file", path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
    /// The file extension is not that of a supported format.
    #[error(
        "`.{extension}` is not a supported scene format, {}; {}supported: {}, and builtin:NAME",
        path.display(),
        other_programs::remedy(extension),
        known.join(", ")
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The extension without the dot; may be empty.
        extension: String,
        /// Supported extensions.
        known: Vec<String>,
    },
    /// No animation of the file has the requested name.
    #[error("{} has no animation `{name}`; {}", path.display(), match known.is_empty() {
        true => "it has none".to_owned(),
        false => format!("available: {}", known.join(", ")),
    })]
    UnknownAnimation {
        /// The file.
        path: PathBuf,
        /// The requested name.
        name: String,
        /// Names of its animations.
        known: Vec<String>,
    },
    /// No built-in scene has this name.
    #[error("there is no built-in scene `{name}`, builtin:{name}; available: {}", known.join(", "))]
    UnknownBuiltin {
        /// The requested name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A built-in scene does not accept this parameter or this value.
    #[error("{problem}, builtin:{name}?{parameter}={value}; {remedy}")]
    BuiltinParameter {
        /// Name of the scene.
        name: String,
        /// Parameter before the `=`.
        parameter: String,
        /// Text after the `=`.
        value: String,
        /// The problem.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// The text does not follow the format's grammar or types.
    #[error("{problem}, {place}; {remedy}")]
    Syntax {
        /// The location.
        place: Box<Place>,
        /// The problem.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// A key that does not exist in the table.
    #[error("unknown key `{}`, {place}; {}", quote(key), suggestion(key, known))]
    UnknownKey {
        /// The location.
        place: Box<Place>,
        /// The key.
        key: String,
        /// All keys of the table.
        known: Vec<String>,
    },
    /// A required key is missing.
    #[error("key `{key}` is missing, {place}; {remedy}")]
    MissingKey {
        /// The table without the key.
        place: Box<Place>,
        /// The key, or the alternative keys.
        key: String,
        /// The remedy.
        remedy: String,
    },
    /// An invalid value.
    #[error("{key} = {} {problem}, {place}; {remedy}", quote::name(value))]
    Value {
        /// The location.
        place: Box<Place>,
        /// The key.
        key: String,
        /// The value, as text.
        value: String,
        /// The problem as a predicate: "is not positive".
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// A reference to something that does not exist.
    #[error("there is no {kind} named `{}`, {place}; {}", quote::name(name), suggestion(name, known))]
    UnknownName {
        /// The location.
        place: Box<Place>,
        /// The kind of object referred to: "material", "camera".
        kind: &'static str,
        /// The name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// A file that contradicts itself or its format.
    #[error("{problem}, {place}; {remedy}")]
    Malformed {
        /// The location.
        place: Box<Place>,
        /// The problem.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// The file requires an extension of its format that is not supported.
    #[error("the file requires the extension {}, {}; export it again without it (supported: {})",
        quote::name(extension), path.display(), known.join(", "))]
    UnsupportedExtension {
        /// The file.
        path: PathBuf,
        /// Name of the extension.
        extension: String,
        /// Supported extensions.
        known: Vec<String>,
    },
    /// A reference to a file outside the scene's folder, or to a link that leads out of it.
    #[error(
        "`{}` leads outside the scene's folder, {place}; move the file there, or allow references outside",
        reference(name)
    )]
    Outside {
        /// The file that contains the reference.
        place: Box<Place>,
        /// The reference.
        name: String,
    },
    /// A file of the scene cannot be used. The message is that of the cause, which names the file, and says who refers to it.
    #[error("{cause} (named by {place})")]
    Referenced {
        /// The location of the reference.
        place: Box<Place>,
        /// What is wrong with the file.
        cause: Box<LoadError>,
    },
    /// There were warnings, and warnings are treated as errors.
    #[error("{}, {}; fix this, or load the scene without strict checks", warnings.join("; "), path.display())]
    Warnings {
        /// The file.
        path: PathBuf,
        /// All warnings.
        warnings: Vec<String>,
    },
    /// Not enough memory.
    #[error("there is not enough memory for {what}: {short}, {}; raise the memory limit, or simplify the scene", path.display())]
    Memory {
        /// The file.
        path: PathBuf,
        /// What would be held: the file itself, a texture, vertices and triangles counting every use of a mesh.
        what: String,
        /// Bytes needed and left.
        short: OverBudget,
    },
    /// Not enough memory for smooth normals.
    #[error(
        "there is not enough memory for smooth normals of {triangles} triangles: {short}, {}; raise the memory limit, or do not smooth",
        path.display()
    )]
    SmoothMemory {
        /// The file that was opened.
        path: PathBuf,
        /// Triangles of the mesh.
        triangles: usize,
        /// Bytes needed and left.
        short: OverBudget,
    },
    /// More vertices or triangles than 32-bit indices can address.
    #[error("the scene has more than {} vertices or triangles, {}; split or simplify it", u32::MAX, path.display())]
    TooLarge {
        /// The file that exceeded the limit.
        path: PathBuf,
    },
}

impl LoadError {
    /// The error without those who refer to its file.
    pub fn root(&self) -> &LoadError {
        match self {
            LoadError::Referenced { cause, .. } => cause.root(),
            error => error,
        }
    }

    /// The error in a file that is named at `place`.
    pub(crate) fn named_by(self, place: impl Into<Box<Place>>) -> LoadError {
        let place = place.into();
        match self {
            // It names who refers to the file, perhaps without a line.
            LoadError::Outside { place: known, name } if known.path == place.path => LoadError::Outside { place, name },
            cause => LoadError::Referenced { place, cause: cause.into() },
        }
    }
}

/// Names longer than this have no typing errors: comparing them would take too long.
const COMPARED: usize = 64;

/// The nearest known name, or all of them: the remedy for a misspelt name.
pub fn suggestion(name: &str, known: &[String]) -> String {
    let is_short = |name: &str| name.len() <= COMPARED;
    let similarity = |candidate: &&String| (1e6 * strsim::jaro_winkler(name, candidate)) as u32;
    let candidates = known.iter().filter(|candidate| is_short(name) && is_short(candidate));
    let available = || list(known.iter().map(String::as_str));
    match candidates.max_by_key(similarity).filter(|best| similarity(best) > 800_000) {
        _ if known.is_empty() => "there are none: define it first, or remove the reference".to_owned(),
        Some(best) => format!("did you mean `{}`? Available: {}", quote::name(best), available()),
        None => format!("available: {}", available()),
    }
}
