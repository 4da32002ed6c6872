//! Short and long tests of two surface points that share light points.

use std::error::Error;

use glam::{Vec2, vec2};
use lightmesh_testkit::SceneDraft;

use crate::canvas::{Anchor, Canvas};
use crate::world::{Extrude, HalfBall, World, light_mesh, nodes};

const RADIUS: f32 = 2.1;
const LIGHT: Vec2 = vec2(2.9, 6.4);
const SLAB: [Vec2; 2] = [vec2(-3.1, 3.5), vec2(0.35, 3.75)];
const GROUND: [Vec2; 2] = [vec2(-6.0, 0.0), vec2(12.0, 0.0)];

pub(crate) fn draw() -> Result<String, Box<dyn Error>> {
    let scene = SceneDraft::new().sheet(GROUND[0], GROUND[1]).bar(SLAB[0], SLAB[1]);
    let scene = scene.point_light([LIGHT.x, LIGHT.y, 0.0]).finish("short and long tests");
    let mesh = light_mesh(vec2(0.35, 0.32), RADIUS)?;
    let world = World::new(&scene, mesh.clone(), &[vec2(-1.25, 3.0), vec2(0.75, 3.0)])?;
    let seen = world.long_tests()?;

    let mut canvas = Canvas::new("Short tests from surface points, long tests from light points", [800, 410]);
    canvas.place(52.0, vec2(260.0, 370.0));
    canvas.rectangle("solid", GROUND[0] - 2.0 * Vec2::Y, GROUND[1]);
    for &(node, lit) in &seen {
        let end = if lit { LIGHT } else { world.first_hit(node, LIGHT).unwrap_or(LIGHT) };
        canvas.line(if lit { "open" } else { "blocked" }, node, end);
    }
    canvas.rectangle("solid", SLAB[0], SLAB[1]);
    canvas.label(SLAB[0].with_y(SLAB[1].y), [2.0, -10.0], Anchor::Start, "occluder");
    canvas.dot("lit", LIGHT, 9.0);
    canvas.label(LIGHT, [16.0, 5.0], Anchor::Start, "*L*");
    let points = [world.half_ball(0), world.half_ball(1)];
    short_tests(&mut canvas, &points);
    light_points(&mut canvas, &seen, nodes(&mesh));
    for (point, name) in points.iter().zip(["*P*", "*Q*"]) {
        canvas.dot("point", point.position, 5.0);
        canvas.label(point.position, [0.0, 23.0], Anchor::Middle, name);
    }
    legend(&mut canvas);
    Ok(canvas.finish())
}

fn short_tests(canvas: &mut Canvas, points: &[HalfBall]) {
    for point in points {
        for &node in &point.used {
            canvas.line("short", point.position, node);
        }
    }
}

fn light_points(canvas: &mut Canvas, seen: &[(Vec2, bool)], nodes: impl Iterator<Item = Vec2>) {
    for node in nodes.filter(|node| node.x > -4.7 && node.x < 9.9 && node.y > 0.0 && node.y < 3.0) {
        match seen.iter().find(|(used, _)| *used == node) {
            Some((_, true)) => canvas.dot("lit", node, 6.0),
            Some((_, false)) => canvas.dot("dark", node, 6.0),
            None => canvas.dot("unused", node, 2.5),
        }
    }
}

fn legend(canvas: &mut Canvas) {
    canvas.place(1.0, vec2(560.0, 40.0));
    let row = |number: f32| vec2(0.0, -28.0 * number);
    for (number, class, text) in
        [(0.0, "short", "short test"), (1.0, "open", "long test, not blocked"), (2.0, "blocked", "long test, blocked")]
    {
        canvas.line(class, row(number), row(number) + 28.0 * Vec2::X);
        canvas.label(row(number), [38.0, 5.0], Anchor::Start, text);
    }
    for (number, class, text) in [
        (3.0, "lit", "light point that sees *L*"),
        (4.0, "dark", "light point in shadow"),
        (5.0, "unused", "light point, not used"),
    ] {
        canvas.dot(class, row(number) + 14.0 * Vec2::X, if class == "unused" { 2.5 } else { 6.0 });
        canvas.label(row(number), [38.0, 5.0], Anchor::Start, text);
    }
}
