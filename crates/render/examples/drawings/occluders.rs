//! Which triangles can shadow the surface points of a cell from an emitter: those that intersect the shaft between them.

use std::error::Error;

use glam::{Vec2, vec2};
use lightmesh_testkit::SceneDraft;

use crate::canvas::{Anchor, Canvas};
use crate::world::{Extrude, World, blocks_any, light_mesh};

/// The surface from left to right, and the region above it from which the surface points of the cell are found.
const SURFACE: [Vec2; 6] =
    [vec2(-6.0, -0.8), vec2(-2.0, -0.2), vec2(-0.9, 0.25), vec2(0.2, 0.42), vec2(1.2, 0.2), vec2(12.0, -1.0)];
const EYES: [f32; 8] = [-1.25, -0.9, -0.55, -0.2, 0.15, 0.5, 0.85, 1.2];
const EMITTER: [Vec2; 2] = [vec2(1.9, 6.3), vec2(4.1, 6.0)];

/// Triangles, each as its line in the drawing's plane.
const TRIANGLES: [[Vec2; 2]; 12] = [
    [vec2(0.3, 2.2), vec2(0.9, 2.7)],
    [vec2(2.1, 3.2), vec2(2.8, 3.0)],
    [vec2(-0.8, 1.6), vec2(-0.1, 1.5)],
    [vec2(1.2, 4.8), vec2(1.9, 4.5)],
    [vec2(2.5, 4.7), vec2(2.9, 5.2)],
    [vec2(-2.6, 2.6), vec2(-1.9, 2.2)],
    [vec2(-3.4, 1.2), vec2(-3.0, 1.8)],
    [vec2(-1.9, 4.6), vec2(-1.1, 4.9)],
    [vec2(3.6, 2.4), vec2(4.1, 2.9)],
    [vec2(4.6, 4.2), vec2(5.3, 4.0)],
    [vec2(3.4, 0.9), vec2(4.0, 0.7)],
    [vec2(0.1, 4.0), vec2(-0.5, 4.2)],
];

pub(crate) fn draw() -> Result<String, Box<dyn Error>> {
    let surface = SURFACE.windows(2).fold(SceneDraft::new(), |scene, ends| scene.sheet(ends[0], ends[1]));
    let scene = TRIANGLES.iter().fold(surface, |scene, &[a, b]| scene.sheet(a, b)).finish("occluders");
    let eyes = EYES.map(|x| vec2(x, 1.0));
    let world = World::new(&scene, light_mesh(vec2(0.0, 0.0), 1.0)?, &eyes)?;
    let points: Vec<Vec2> = (0..eyes.len()).map(|eye| world.half_ball(eye).position).collect();
    let cell = corners(&points);
    let segments: Vec<[Vec2; 2]> = grid(cell[0], cell[2])
        .flat_map(|from| (0..=15).map(move |index| [from, EMITTER[0].lerp(EMITTER[1], index as f32 / 15.0)]))
        .collect();

    let mut canvas = Canvas::new("The triangles that can shadow the surface points of a cell", [800, 410]);
    canvas.place(52.0, vec2(270.0, 352.0));
    canvas.polygon("region", &hull(&[&cell[..], &EMITTER].concat()));
    canvas.polygon("solid", &[&SURFACE[..], &[vec2(12.0, -2.0), vec2(-6.0, -2.0)]].concat());
    canvas.rectangle("cell", cell[0], cell[2]);
    for &point in &points {
        canvas.dot("point", point, 3.5);
    }
    canvas.line("emitter", EMITTER[0], EMITTER[1]);
    for &triangle in &TRIANGLES {
        let class = if blocks_any(triangle, &segments)? { "may" } else { "cannot" };
        canvas.line(class, triangle[0], triangle[1]);
    }
    canvas.label(EMITTER[0], [-12.0, 4.0], Anchor::End, "emitter");
    canvas.label(vec2(2.85, 5.55), [0.0, 0.0], Anchor::Middle, "shaft");
    canvas.label(cell[0].midpoint(cell[1]), [30.0, 46.0], Anchor::Middle, "surface points of a cell, and their box");
    legend(&mut canvas);
    Ok(canvas.finish())
}

fn legend(canvas: &mut Canvas) {
    canvas.place(1.0, vec2(560.0, 40.0));
    let row = |number: f32| vec2(0.0, -28.0 * number);
    canvas.label(row(0.0), [0.0, 5.0], Anchor::Start, "Triangles, in section");
    for (number, class, text) in [(1.0, "may", "meets the shaft: can block"), (2.0, "cannot", "cannot block")] {
        canvas.line(class, row(number), row(number) + 24.0 * Vec2::X);
        canvas.label(row(number), [36.0, 5.0], Anchor::Start, text);
    }
}

/// The corners of the box around some points.
fn corners(points: &[Vec2]) -> [Vec2; 4] {
    let low = points.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high = points.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    [low, vec2(high.x, low.y), high, vec2(low.x, high.y)]
}

/// Points distributed evenly over a box.
fn grid(low: Vec2, high: Vec2) -> impl Iterator<Item = Vec2> {
    let part = |index: i32| index as f32 / 15.0;
    (0..256).map(move |index| low + (high - low) * vec2(part(index % 16), part(index / 16)))
}

/// The convex hull of some points (Andrew's monotone chain).
fn hull(points: &[Vec2]) -> Vec<Vec2> {
    let mut points = points.to_vec();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    [lower, upper].concat()
}
