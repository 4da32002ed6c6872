//! Samples of a disc in rows, and which of them a triangle hides from a surface point: those between the bounds that its edges put on
//! each row.

use std::error::Error;
use std::f32::consts::PI;

use glam::{Vec2, vec2};

use crate::canvas::{Anchor, Canvas};

/// Number of samples in each row, as for sixteen.
const ROWS: [u32; 4] = [3, 5, 5, 3];
/// By how much of their distance samples are shifted along each row.
const SHIFTS: [f32; 4] = [0.3, 0.8, 0.15, 0.6];
/// The angle by which the surface point turns the rows.
const TURN: f32 = 0.25;
/// The triangle as the surface point sees it; the disc has the radius 1.
const TRIANGLE: [Vec2; 3] = [vec2(-1.5, -0.8), vec2(-0.29, 1.08), vec2(0.73, -0.38)];

pub(crate) fn draw() -> Result<String, Box<dyn Error>> {
    let mut canvas = Canvas::new("Rows of samples, and which of them a triangle hides", [800, 400]);
    canvas.place(165.0, vec2(330.0, 200.0));
    let circle: Vec<Vec2> = (0..96).map(|at| Vec2::from_angle(2.0 * PI * at as f32 / 96.0)).collect();
    canvas.polygon("region", &circle);
    canvas.polygon("solid", &TRIANGLE);
    let turned = |x: f32, y: f32| Vec2::from_angle(TURN).rotate(vec2(x, y));
    let mut before = 0.0;
    for (&count, shift) in ROWS.iter().zip(SHIFTS) {
        let all = ROWS.iter().sum::<u32>() as f32;
        let y = height_below((before + 0.5 * count as f32) / all);
        before += count as f32;
        let half = (1.0 - y * y).sqrt();
        canvas.line("guide", turned(-half, y), turned(half, y));
        let (low, high) = bounds(turned(-half, y), turned(half, y));
        if low < high {
            let at = |share: f32| turned(-half, y).lerp(turned(half, y), share);
            canvas.line("may", at(low), at(high));
        }
        for place in 0..count {
            let share = (place as f32 + shift) / count as f32;
            let class = if (low..=high).contains(&share) { "dark" } else { "lit" };
            canvas.dot(class, turned(-half, y).lerp(turned(half, y), share), 7.0);
        }
    }
    canvas.label(TRIANGLE[0], [8.0, 20.0], Anchor::Start, "a triangle");
    canvas.place(1.0, vec2(560.0, 60.0));
    let row = |number: f32| vec2(0.0, -28.0 * number);
    canvas.label(row(0.0), [0.0, 5.0], Anchor::Start, "A light, from a surface point");
    for (number, class, text) in [(1.0, "lit", "a sample that is seen"), (2.0, "dark", "a hidden sample")] {
        canvas.dot(class, row(number) + vec2(12.0, 0.0), 7.0);
        canvas.label(row(number), [36.0, 5.0], Anchor::Start, text);
    }
    for (number, class, text) in [(3.0, "guide", "a row"), (4.0, "may", "between the bounds")] {
        canvas.line(class, row(number), row(number) + 24.0 * Vec2::X);
        canvas.label(row(number), [36.0, 5.0], Anchor::Start, text);
    }
    Ok(canvas.finish())
}

/// The height below which `share` of a disc of radius 1 lies.
fn height_below(share: f32) -> f32 {
    let (mut low, mut high) = (-1.0f32, 1.0f32);
    for _ in 0..40 {
        let y = 0.5 * (low + high);
        let below = 0.5 + (y * (1.0 - y * y).sqrt() + y.asin()) / PI;
        if below < share { low = y } else { high = y }
    }
    low
}

/// Between which parts of the way from `from` to `to` the triangle lies: each edge bounds it on one side.
fn bounds(from: Vec2, to: Vec2) -> (f32, f32) {
    let [a, b, c] = TRIANGLE;
    let (mut low, mut high) = (0.0f32, 1.0f32);
    for (start, end) in [(a, b), (b, c), (c, a)] {
        // The triangle is clockwise: its inner side is to the right of each edge.
        let inner = |point: Vec2| (point - start).perp_dot(end - start);
        let (at_start, at_end) = (inner(from), inner(to));
        let zero = at_start / (at_start - at_end);
        if at_end > at_start { low = low.max(zero) } else { high = high.min(zero) }
    }
    (low, high)
}
