//! Step 3 on the CPU: first the bricks, then the points in them.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::counters::Tally;
use crate::data::cells::CellGroups;
use crate::data::masks::Masks;
use crate::light_mesh::{BrickKey, BrickMap, LightMesh, UsedPoints, Windows, point_of};
use crate::render_context::RenderContext;

/// Number of surface points per task.
const RUN: usize = 8192;

pub(crate) fn light_points(context: &RenderContext, cells: &CellGroups, masks: &Masks, mesh: &LightMesh) -> UsedPoints {
    let runs = cells.runs(RUN);
    let windows = Windows::new(&mesh.template);

    // 1. The bricks that hold a used point.
    let mut keys: Vec<BrickKey> = runs
        .par_iter()
        .flat_map_iter(|run| {
            let mut keys = Vec::new();
            Marker::new(cells, masks, &windows).each_brick(run.clone(), |key, _| keys.push(key));
            keys.sort_unstable();
            keys.dedup();
            keys
        })
        .collect();
    keys.par_sort_unstable();
    keys.dedup();
    let bricks = BrickMap::new(keys);

    // 2. The used points in each. The order of marking does not matter to an "or".
    let used: Vec<AtomicU64> = bricks.keys().iter().map(|_| AtomicU64::new(0)).collect();
    runs.par_iter().for_each(|run| {
        context.piece(cells.slots_of(run).len(), || {
            Marker::new(cells, masks, &windows).each_brick(run.clone(), |key, points| {
                if let Some(brick) = bricks.find(key) {
                    used[brick].fetch_or(points, Ordering::Relaxed);
                }
            });
        });
    });

    // 3. Ranks.
    let points = UsedPoints::new(bricks, used.into_iter().map(AtomicU64::into_inner).collect());
    Tally::add(&context.tally.light_points, points.count() as u64);
    points
}

/// Turns the masks of a cell's surface points into marks in the bricks around the cell.
struct Marker<'a> {
    cells: &'a CellGroups,
    masks: &'a Masks,
    windows: &'a Windows,
    marks: Vec<u64>,
    union: Vec<u32>,
}

impl<'a> Marker<'a> {
    fn new(cells: &'a CellGroups, masks: &'a Masks, windows: &'a Windows) -> Marker<'a> {
        Marker { cells, masks, windows, marks: vec![0; windows.len()], union: vec![0; masks.words] }
    }

    /// Calls `mark` for each brick in which a cell of `run` uses points, with these points. A brick may come once per cell.
    fn each_brick(&mut self, run: Range<usize>, mut mark: impl FnMut(BrickKey, u64)) {
        for group in run {
            let window = self.windows.around(point_of(self.cells.cell(group)));
            self.union.fill(0);
            for slot in self.cells.slots(group) {
                for (union, word) in self.union.iter_mut().zip(self.masks.mask(slot)) {
                    *union |= word;
                }
            }
            for span in window.spans {
                self.marks[usize::from(span.slot)] |= span.to_brick(self.union[usize::from(span.word)]);
            }
            for slot in 0..self.marks.len() {
                let points = std::mem::take(&mut self.marks[slot]);
                if points != 0 {
                    mark(window.key(slot), points);
                }
            }
        }
    }
}
