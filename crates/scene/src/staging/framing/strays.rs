//! What of a scene a camera frames: all of it but strays, small pieces far from the rest that would make everything else small.
//!
//! Triangles are sorted into the cells of a grid around the scene. Cells next to each other are a cluster, so clusters are at least a cell apart:
//! the rule needs neither shared vertices nor objects. Strays are clusters that are small beside the largest one and stick out of what is not
//! small; they are few and have hardly any area, and without them the scene is clearly smaller. Then the grid is finer, and they are looked for
//! again. Whatever is not clear stays: chairs around a table, houses of a street, leaves of a tree.

use glam::Vec3;

use crate::{Bounds, Mesh};

/// Cells along the longest edge.
const CELLS: usize = 64;
/// Cells that triangles may cover together; beyond, nothing is a stray.
const MAX_COVERED: usize = 1 << 24;
/// Strays are found in rounds, each around what the one before has left.
const ROUNDS: usize = 4;
/// A stray's diagonal is at most this share of that of the largest cluster.
const SMALL: f32 = 0.2;
/// All strays of a round have at most this share of the area.
const SLIGHT: f64 = 0.02;
/// More than this are no strays but what the scene consists of.
const FEW: usize = 4;
/// Without strays, the diagonal is at most this share.
const SHRUNK: f32 = 0.95;

/// What a camera frames.
pub(super) struct Subject {
    /// The box around it; a unit cube if there is nothing or a single point.
    pub(super) bounds: Bounds,
    /// Whether each triangle counts; all do if this is `None`.
    counts: Option<Vec<bool>>,
}

impl Subject {
    pub(super) fn of(mesh: &Mesh) -> Subject {
        let mut bounds = mesh.bounds();
        let mut counts = None;
        for _ in 0..ROUNDS {
            let Some((rest, around)) = without_strays(mesh, &bounds, counts.as_deref()) else { break };
            (bounds, counts) = (around, Some(rest));
        }
        Subject { bounds: framed(bounds), counts }
    }

    /// The vertices of it, some perhaps more than once; those that no triangle has may be among them if they are in its box.
    pub(super) fn each_vertex(&self, mesh: &Mesh, mut take: impl FnMut(Vec3)) {
        match &self.counts {
            None => mesh.positions.iter().for_each(|&position| take(position)),
            Some(counts) => {
                let of_it = (0..counts.len()).filter(|&triangle| counts[triangle]);
                of_it.flat_map(|triangle| mesh.corners(triangle)).for_each(take);
            }
        }
    }

    /// Whether the vertices of a mesh tell more than the box does.
    pub(super) fn has_vertices(&self, mesh: &Mesh) -> bool {
        self.counts.is_some() || mesh.bounds() == self.bounds
    }
}

/// The box to frame: a unit cube if the scene is empty or a single point.
fn framed(bounds: Bounds) -> Bounds {
    let center = if bounds.is_empty() { Vec3::ZERO } else { bounds.center() };
    if bounds.diagonal() > 0.0 { bounds } else { Bounds { min: center - 0.5, max: center + 0.5 } }
}

/// Triangles that are near each other.
#[derive(Clone)]
struct Cluster {
    bounds: Bounds,
    area: f64,
}

/// Which triangles are left without the strays among those that count, and the box around them; `None` if there are no strays.
fn without_strays(mesh: &Mesh, bounds: &Bounds, counts: Option<&[bool]>) -> Option<(Vec<bool>, Bounds)> {
    let grid = Grid::around(bounds)?;
    let is_asked = |triangle: &usize| counts.is_none_or(|counts| counts[*triangle]);
    let asked = || (0..mesh.triangles.len()).filter(is_asked);

    // 1. Cells that triangles are in, and which of them are next to each other.
    let mut labels = vec![NONE; grid.len()];
    let mut covered = 0;
    for triangle in asked() {
        let [least, most] = grid.cells_of(mesh.corners(triangle));
        covered += (0..3).map(|axis| most[axis] - least[axis] + 1).product::<usize>();
        if covered > MAX_COVERED {
            return None;
        }
        grid.each(least, most, |cell| labels[cell] = OCCUPIED);
    }
    let count = grid.label(&mut labels);

    // 2. The extent and the area of each cluster.
    let mut clusters = vec![Cluster { bounds: Bounds::EMPTY, area: 0.0 }; count];
    let cluster_of = |triangle: usize| labels[grid.index(grid.cell(mesh.corners(triangle)[0]))] as usize;
    for triangle in asked() {
        let [a, b, c] = mesh.corners(triangle);
        let cluster = &mut clusters[cluster_of(triangle)];
        cluster.bounds = [a, b, c].into_iter().fold(cluster.bounds, Bounds::including);
        cluster.area += 0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length();
    }

    // 3. Those that are small, lie outside of what is not, and have hardly any area.
    let largest = clusters.iter().map(|cluster| cluster.bounds.diagonal()).fold(0.0, f32::max);
    let is_small = |cluster: &Cluster| cluster.bounds.diagonal() <= SMALL * largest;
    let large = clusters.iter().filter(|cluster| !is_small(cluster)).map(|cluster| cluster.bounds);
    let rest = large.fold(Bounds::EMPTY, Bounds::with_box);
    let is_within = |one: &Bounds| one.min.cmpge(rest.min).all() && one.max.cmple(rest.max).all();
    let is_stray = |cluster: &Cluster| is_small(cluster) && !is_within(&cluster.bounds);
    let are_strays: Vec<bool> = clusters.iter().map(is_stray).collect();
    let strays = || clusters.iter().filter(|cluster| is_stray(cluster));
    let area = |clusters: &mut dyn Iterator<Item = &Cluster>| clusters.map(|cluster| cluster.area).sum::<f64>();
    let is_slight = area(&mut strays()) <= SLIGHT * area(&mut clusters.iter());
    let is_smaller = rest.diagonal() > 0.0 && rest.diagonal() <= SHRUNK * bounds.diagonal();
    let stays = |triangle: usize| is_asked(&triangle) && !are_strays[cluster_of(triangle)];
    let are_clear = (1..=FEW).contains(&strays().count()) && is_slight && is_smaller;
    are_clear.then(|| ((0..mesh.triangles.len()).map(stays).collect(), rest))
}

/// Labels of cells: of those without triangles, and of those whose cluster has no number yet.
const NONE: u32 = u32::MAX;
const OCCUPIED: u32 = u32::MAX - 1;

/// Cubes around a scene.
struct Grid {
    min: Vec3,
    edge: f32,
    size: Cell,
}

/// Along each axis.
type Cell = [usize; 3];

impl Grid {
    /// `None` for boxes without extent, or one that cannot be divided.
    fn around(bounds: &Bounds) -> Option<Grid> {
        let edge = bounds.extent().max_element() / CELLS as f32;
        let is_usual = !bounds.is_empty() && edge.is_normal() && bounds.extent().is_finite();
        let size = (bounds.extent() / edge).to_array().map(|cells| (cells as usize + 1).min(CELLS));
        is_usual.then_some(Grid { min: bounds.min, edge, size })
    }

    fn len(&self) -> usize {
        self.size.iter().product()
    }

    fn cell(&self, point: Vec3) -> Cell {
        let cell = ((point - self.min) / self.edge).to_array();
        std::array::from_fn(|axis| (cell[axis] as usize).min(self.size[axis] - 1))
    }

    fn index(&self, [x, y, z]: Cell) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// The first and the last cell of the box around a triangle.
    fn cells_of(&self, corners: [Vec3; 3]) -> [Cell; 2] {
        let [a, b, c] = corners.map(|corner| self.cell(corner));
        let of =
            |choose: fn(usize, usize) -> usize| std::array::from_fn(|axis| choose(choose(a[axis], b[axis]), c[axis]));
        [of(usize::min), of(usize::max)]
    }

    fn each(&self, least: Cell, most: Cell, mut take: impl FnMut(usize)) {
        for z in least[2]..=most[2] {
            for y in least[1]..=most[1] {
                (least[0]..=most[0]).for_each(|x| take(self.index([x, y, z])));
            }
        }
    }

    /// The cells around one, and itself.
    fn neighbours(&self, index: usize) -> [Cell; 2] {
        let [width, height, _] = self.size;
        let cell = [index % width, index / width % height, index / width / height];
        let most = std::array::from_fn(|axis| (cell[axis] + 1).min(self.size[axis] - 1));
        [cell.map(|place| place.saturating_sub(1)), most]
    }

    /// Numbers the clusters in the order of their first cells; returns how many there are.
    fn label(&self, labels: &mut [u32]) -> usize {
        let mut count = 0;
        let mut waiting = Vec::new();
        for first in 0..labels.len() {
            if labels[first] != OCCUPIED {
                continue;
            }
            labels[first] = count;
            waiting.push(first);
            while let Some(cell) = waiting.pop() {
                let [least, most] = self.neighbours(cell);
                self.each(least, most, |next| {
                    if labels[next] == OCCUPIED {
                        labels[next] = count;
                        waiting.push(next);
                    }
                });
            }
            count += 1;
        }
        count as usize
    }
}
