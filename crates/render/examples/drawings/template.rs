//! Formula (6): a cell of the lattice and its template.

use std::error::Error;
use std::f32::consts::PI;

use glam::{IVec3, Vec2, vec2};
use lightmesh_render::light_mesh::Template;

use crate::canvas::{Anchor, Canvas};

const RADIUS: f32 = 2.1;

pub(crate) fn draw() -> Result<String, Box<dyn Error>> {
    let template = Template::new(RADIUS)?;
    let mut canvas = Canvas::new("A lattice cell and its template for R = 2.1", [800, 400]);
    middle_layer(&mut canvas, &template);
    all_layers(&mut canvas, &template);
    Ok(canvas.finish())
}

/// The layer k = 0, large.
fn middle_layer(canvas: &mut Canvas, template: &Template) {
    let (low, high) = (1 - template.reach(), template.reach());
    canvas.place(52.0, vec2(180.0, 226.0));
    lattice(canvas, low, high);
    canvas.polygon("region", &reach());
    canvas.rectangle("cell", Vec2::ZERO, Vec2::ONE);
    let position = vec2(0.7, 0.62);
    canvas.disk("guide", position, RADIUS);
    for (i, j) in (low..=high).flat_map(|j| (low..=high).map(move |i| (i, j))) {
        let node = vec2(i as f32, j as f32);
        if template.offsets().contains(&IVec3::new(i, j, 0)) {
            canvas.dot("used", node, 6.0);
        } else {
            canvas.dot("unused", node, 2.5);
        }
    }
    let rim = position + RADIUS * Vec2::from_angle(-2.05);
    canvas.arrow(position, rim);
    canvas.label(position.lerp(rim, 0.62), [8.0, 6.0], Anchor::Start, "*r* = *R* *h*");
    canvas.dot("point", position, 5.0);
    canvas.label(position, [-9.0, -2.0], Anchor::End, "*P*");
    canvas.arrow(vec2(1.0, 0.5), vec2(1.0 + RADIUS, 0.5));
    canvas.label(vec2(2.5, 0.5), [0.0, -7.0], Anchor::Middle, "*R*");
    axes(canvas, low, high);
}

fn axes(canvas: &mut Canvas, low: i32, high: i32) {
    let first = low as f32;
    for index in low..=high {
        canvas.label(vec2(index as f32, first), [0.0, 36.0], Anchor::Middle, &number(index));
        canvas.label(vec2(first, index as f32), [-26.0, 5.0], Anchor::End, &number(index));
    }
    canvas.label(vec2(high as f32, first), [30.0, 36.0], Anchor::Start, "*i*");
    canvas.label(vec2(first, high as f32), [-28.0, -24.0], Anchor::End, "*j*");
}

/// The outline of all points closer than R to the cell.
fn reach() -> Vec<Vec2> {
    let corners = [Vec2::ONE, Vec2::Y, Vec2::ZERO, Vec2::X].into_iter().zip([0.0, 0.5, 1.0, 1.5]);
    let arc = |(corner, first): (Vec2, f32)| {
        (0..=30).map(move |step| corner + RADIUS * Vec2::from_angle(PI * (first + step as f32 / 60.0)))
    };
    corners.flat_map(arc).collect()
}

fn lattice(canvas: &mut Canvas, low: i32, high: i32) {
    let (first, last) = (low as f32, high as f32);
    for at in (low..=high).map(|index| index as f32) {
        canvas.line("lattice", vec2(at, first), vec2(at, last));
        canvas.line("lattice", vec2(first, at), vec2(last, at));
    }
}

/// Every layer, small, with its number of points.
fn all_layers(canvas: &mut Canvas, template: &Template) {
    let (low, high) = (1 - template.reach(), template.reach());
    for k in low..=high {
        let (column, row) = ((k - low) % 3, (k - low) / 3);
        canvas.place(15.0, vec2(475.0 + 120.0 * column as f32, 98.0 + 150.0 * row as f32));
        canvas.rectangle("cell", Vec2::ZERO, Vec2::ONE);
        let layer: Vec<_> = template.offsets().iter().filter(|offset| offset.z == k).collect();
        for offset in &layer {
            canvas.dot("used", offset.truncate().as_vec2(), 3.5);
        }
        let text = format!("*k* = {}: {}", number(k), layer.len());
        canvas.label(vec2(0.5, low as f32), [0.0, 32.0], Anchor::Middle, &text);
    }
    canvas.place(1.0, vec2(602.5, 362.0));
    canvas.label(Vec2::ZERO, [0.0, 0.0], Anchor::Middle, &format!("{} template points in all layers", template.len()));
}

/// A number with a minus sign instead of a hyphen.
fn number(number: i32) -> String {
    number.to_string().replace('-', "\u{2212}")
}
