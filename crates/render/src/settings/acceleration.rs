//! The choice of acceleration structure.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use lightmesh_scene::UnknownName;

/// The acceleration structure. As text: a name, `grid:NXxNYxNZ`, or `grid-file:PATH`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Acceleration {
    /// The fastest on this device: the BVH.
    #[default]
    Auto,
    /// The regular grid of the thesis, with the given number of cells along each axis, or a chosen one.
    Grid(Option<[u32; 3]>),
    /// The regular grid stored in a file by [`Grid::save`](lightmesh_trace::accel::Grid::save).
    GridFile(PathBuf),
    /// A wide BVH.
    Bvh,
    /// A test of every triangle, always: the reference.
    BruteForce,
}

impl Acceleration {
    /// Those that can be chosen by name and are useful; [`Acceleration::BruteForce`] is for tests.
    pub const ALL: &'static [Acceleration] = &[Acceleration::Auto, Acceleration::Grid(None), Acceleration::Bvh];

    /// Its name; the same for all grids.
    pub fn name(&self) -> &'static str {
        match self {
            Acceleration::Auto => "auto",
            Acceleration::Grid(_) => "grid",
            Acceleration::GridFile(_) => "grid-file",
            Acceleration::Bvh => "bvh",
            Acceleration::BruteForce => "brute-force",
        }
    }

    /// A short description.
    pub fn help(&self) -> &'static str {
        match self {
            Acceleration::Auto => "The fastest on the device",
            Acceleration::Grid(_) => "The regular grid of the thesis",
            Acceleration::GridFile(_) => "A regular grid stored in a file",
            Acceleration::Bvh => "A wide bounding volume hierarchy",
            Acceleration::BruteForce => "A test of every triangle, always: the reference",
        }
    }
}

impl fmt::Display for Acceleration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Acceleration::Grid(Some([nx, ny, nz])) => write!(f, "grid:{nx}x{ny}x{nz}"),
            Acceleration::GridFile(path) => write!(f, "grid-file:{}", path.display()),
            other => f.pad(other.name()),
        }
    }
}

impl FromStr for Acceleration {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Acceleration, UnknownName> {
        let dims = |text: &str| {
            let cells: Option<Vec<u32>> = text.split('x').map(|n| n.parse().ok().filter(|&n| n > 0)).collect();
            cells?.try_into().ok()
        };
        let found = match text.split_once(':') {
            Some(("grid", cells)) => dims(cells).map(|dims| Acceleration::Grid(Some(dims))),
            Some(("grid-file", path)) if !path.is_empty() => Some(Acceleration::GridFile(path.into())),
            _ if text == "brute-force" => Some(Acceleration::BruteForce),
            _ => Acceleration::ALL.iter().find(|choice| choice.name() == text).cloned(),
        };
        found.ok_or_else(|| UnknownName {
            what: "acceleration structure",
            name: text.to_owned(),
            known: vec!["auto", "grid", "grid:NXxNYxNZ", "grid-file:PATH", "bvh", "brute-force"],
        })
    }
}
