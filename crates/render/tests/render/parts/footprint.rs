use glam::{Vec2, Vec3};
use lightmesh_layout::constants::MIN_FOOTPRINT_COSINE;
use lightmesh_render::Cone;
use lightmesh_render::accel::Hit;
use lightmesh_render::internals::footprint::{axes, curvature};
use lightmesh_scene::Mesh;

const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, -4.0)];
const UVS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];

/// The lengths of the axes, the longer one first.
fn lengths(direction: Vec3, width: f32) -> [f32; 2] {
    let [a, b] = axes(direction, width, CORNERS, UVS).map(Vec2::length);
    [a.max(b), a.min(b)]
}

#[test]
fn from_above_a_circle_is_seen_and_stretched_as_the_texture_is() {
    // u is as long as 2, v as 4.
    assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, UVS), [Vec2::new(0.25, 0.0), Vec2::new(0.0, 0.125)]);
    assert_eq!(axes(Vec3::Y, 0.5, CORNERS, UVS)[0], Vec2::new(0.25, 0.0), "from below, too");
}

#[test]
fn a_slanted_view_stretches_the_ellipse_along_itself() {
    // At 30 degrees above the floor, along u: 1 / sin 30°.
    let direction = Vec3::new(0.75f32.sqrt(), -0.5, 0.0);
    let [along, across] = axes(direction, 0.5, CORNERS, UVS);
    assert!((along - Vec2::new(0.5, 0.0)).length() < 1e-6, "{along}");
    assert!((across.abs() - Vec2::new(0.0, 0.125)).length() < 1e-6, "{across}");
    // Along the surface, the ellipse is as long as can be counted.
    let [long, _] = lengths(Vec3::X, 0.5);
    assert!((long - 0.25 / MIN_FOOTPRINT_COSINE).abs() < 1e-3 * long, "{long}");
}

#[test]
fn needles_and_textures_without_area_have_what_can_be_told() {
    let needle = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
    assert_eq!(axes(Vec3::NEG_Y, 0.5, needle, UVS), [Vec2::ZERO; 2]);
    assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, [Vec2::ONE; 3]), [Vec2::ZERO; 2]);
    let line = axes(Vec3::NEG_Y, 0.5, CORNERS, [Vec2::ZERO, Vec2::X, Vec2::ZERO]);
    assert_eq!(line, [Vec2::new(0.25, 0.0), Vec2::ZERO]);
    let endless = [Vec2::ZERO, Vec2::new(f32::INFINITY, 0.0), Vec2::ZERO];
    assert_eq!(axes(Vec3::NEG_Y, 0.5, CORNERS, endless), [Vec2::ZERO; 2]);
    assert!(axes(Vec3::NAN, 0.5, CORNERS, UVS).iter().all(|axis| axis.is_finite()));
}

#[test]
fn samples_share_the_area_of_their_pixel() {
    assert_eq!(Cone::of_sample([0.0, 0.5], 4, 1.0), Cone { width: 0.0, spread: 0.25 });
    assert_eq!(Cone::of_sample([3.0, 0.0], 9, 2.0), Cone { width: 2.0, spread: 0.0 });
}

#[test]
fn cones_grow_and_have_a_focus() {
    let cone = Cone { width: 1.0, spread: -0.25 };
    assert_eq!(cone.after(2.0), Cone { width: 0.5, spread: -0.25 });
    assert_eq!(cone.after(6.0), Cone { width: 0.5, spread: 0.25 });
    assert!(Cone::default().after(7.0).reflected(3.0).is_point());
}

/// A triangle on a ball around the origin, with its normals.
fn ball(radius: f32, inside: bool) -> (Mesh, [Vec3; 3]) {
    let ways = [Vec3::new(-0.01, 0.0, 1.0), Vec3::new(0.02, -0.01, 1.0), Vec3::new(0.0, 0.02, 1.0)];
    let corners = ways.map(|way| radius * way.normalize());
    let normals = ways.map(|way| if inside { -way.normalize() } else { way.normalize() }).to_vec();
    (Mesh { normals, triangles: vec![[0, 1, 2]], positions: corners.to_vec(), ..Mesh::default() }, corners)
}

#[test]
fn a_ball_has_the_curvature_of_its_radius() {
    let hit = Hit { t: 1.0, u: 0.3, v: 0.3, triangle: 0 };
    let (mesh, corners) = ball(4.0, false);
    assert!((curvature(&mesh, &hit, corners, Vec3::Z) - 0.25).abs() < 1e-3, "from outside");
    assert!((curvature(&mesh, &hit, corners, Vec3::NEG_Z) + 0.25).abs() < 1e-3, "from inside");
    let (mesh, corners) = ball(4.0, true);
    assert!((curvature(&mesh, &hit, corners, Vec3::NEG_Z) + 0.25).abs() < 1e-3, "with normals to the inside");
    let mut flat = mesh.clone();
    flat.normals = vec![Vec3::Z; 3];
    assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
    flat.normals[1] = Vec3::ZERO;
    assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
    flat.normals.clear();
    assert_eq!(curvature(&flat, &hit, corners, Vec3::Z), 0.0);
}

#[test]
fn a_ball_spreads_what_it_reflects_as_a_mirror_formula_says() {
    // A convex mirror of radius R has its focus R / 2 behind it: parallel rays seem to come from there.
    let cone = Cone { width: 0.1, spread: 0.0 }.reflected(0.25);
    assert!((cone.after(2.0).width - 0.2).abs() < 1e-6, "twice as wide at the distance of the focus");
    // A concave one focuses there.
    assert!(Cone { width: 0.1, spread: 0.0 }.reflected(-0.25).after(2.0).width.abs() < 1e-6);
}
