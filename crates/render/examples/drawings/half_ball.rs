//! Formula (2): the half-ball of one surface point.

use std::error::Error;

use glam::{Vec2, vec2};
use lightmesh_testkit::SceneDraft;

use crate::canvas::{Anchor, Canvas};
use crate::world::{Extrude, HalfBall, World, light_mesh, nodes};

const RADIUS: f32 = 3.1;
/// The surface from left to right: convex, so that it curves away from the tangent plane.
const SURFACE: [Vec2; 4] = [vec2(-6.0, -3.0), vec2(-1.4, -0.28), vec2(1.9, 0.38), vec2(12.0, -0.25)];
const WALL: [Vec2; 2] = [vec2(1.5, 0.2), vec2(1.68, 1.55)];

pub(crate) fn draw() -> Result<String, Box<dyn Error>> {
    let surface = SURFACE.windows(2).fold(SceneDraft::new(), |scene, ends| scene.sheet(ends[0], ends[1]));
    let scene = surface.bar(WALL[0], WALL[1]).finish("half-ball");
    let mesh = light_mesh(vec2(0.1, 0.725), RADIUS)?;
    let world = World::new(&scene, mesh.clone(), &[vec2(0.0, 5.0)])?;
    let half_ball = world.half_ball(0);

    let mut canvas = Canvas::new("The interpolation half-ball D(P, r) of a surface point P", [800, 380]);
    canvas.place(58.0, vec2(280.0, 252.0));
    canvas.half_disk("region", half_ball.position, RADIUS, half_ball.normal);
    canvas.rectangle("solid", WALL[0], WALL[1]);
    canvas.polygon("solid", &[&SURFACE[..], &[vec2(12.0, -3.0)]].concat());
    short_tests(&mut canvas, &world, &half_ball);
    light_points(&mut canvas, &half_ball, nodes(&mesh));
    names(&mut canvas, &half_ball);
    legend(&mut canvas);
    Ok(canvas.finish())
}

fn short_tests(canvas: &mut Canvas, world: &World, half_ball: &HalfBall) {
    for &node in &half_ball.used {
        canvas.line("short", half_ball.position, node);
    }
    for &node in &half_ball.hidden {
        // Short tests start slightly above the surface.
        let end = world.first_hit(half_ball.position + 1e-3 * half_ball.normal, node).unwrap_or(node);
        canvas.line("blocked", half_ball.position, end);
    }
}

fn light_points(canvas: &mut Canvas, half_ball: &HalfBall, nodes: impl Iterator<Item = Vec2>) {
    for node in nodes.filter(|node| node.x > -4.6 && node.x < 5.0 && node.y > -2.0 && node.y < 4.2) {
        if half_ball.used.contains(&node) {
            canvas.dot("used", node, 6.0);
        } else if half_ball.hidden.contains(&node) {
            canvas.dot("hidden", node, 5.0);
        } else {
            canvas.dot("unused", node, 2.5);
        }
    }
}

fn names(canvas: &mut Canvas, half_ball: &HalfBall) {
    let HalfBall { position, normal, .. } = *half_ball;
    let along = -normal.perp();
    canvas.line("guide", position - 4.6 * along, position + 5.2 * along);
    canvas.label(position + 5.2 * along, [0.0, -10.0], Anchor::End, "tangent plane");
    canvas.arrow(position, position + 1.3 * normal);
    canvas.label(position + 1.3 * normal, [-7.0, 6.0], Anchor::End, "*n*");
    let rim = position + RADIUS * Vec2::from_angle(128.0_f32.to_radians());
    canvas.arrow(position, rim);
    canvas.label(position.lerp(rim, 0.82), [9.0, -2.0], Anchor::Start, "*r*");
    canvas.dot("point", position, 5.0);
    canvas.label(position, [2.0, 24.0], Anchor::Middle, "*P*");
}

fn legend(canvas: &mut Canvas) {
    canvas.place(1.0, vec2(606.0, 40.0));
    let row = |number: f32| vec2(0.0, -28.0 * number);
    canvas.label(row(0.0), [-6.0, 5.0], Anchor::Start, "Light points");
    canvas.dot("used", row(1.0), 6.0);
    canvas.label(row(1.0), [16.0, 5.0], Anchor::Start, "in *D*(*P*, *r*)");
    canvas.dot("hidden", row(2.0), 5.0);
    canvas.label(row(2.0), [16.0, 5.0], Anchor::Start, "hidden from *P*");
    canvas.dot("unused", row(3.0), 2.5);
    canvas.label(row(3.0), [16.0, 5.0], Anchor::Start, "too far, or behind");
    canvas.label(row(3.65), [16.0, 5.0], Anchor::Start, "the tangent plane");
}
