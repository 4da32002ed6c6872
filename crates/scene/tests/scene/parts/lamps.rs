use std::f32::consts::PI;

use glam::Vec3;
use lightmesh_scene::internals::lamps::{LIGHTS, lamps};
use lightmesh_scene::{Bounds, Falloff, Geometry, Light, LightKind, Material, Mesh};

/// Lamps of the second material in a room of 10³ of the first one.
fn room(lamps: &[[[f32; 3]; 3]]) -> Geometry {
    let corners = [[-5.0; 3], [5.0, -5.0, -5.0], [5.0; 3]].map(Vec3::from_array);
    let mut mesh =
        Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], materials: vec![0], ..Mesh::default() };
    for triangle in lamps {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(triangle.map(Vec3::from_array));
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.materials.push(1);
    }
    let lamp = Material::default().with_emission([2.0, 1.0, 0.5]).with_lamp(true);
    Geometry { mesh, materials: vec![Material::default(), lamp], ..Geometry::default() }
}

fn quad([a, b, c, d]: [[f32; 3]; 4]) -> [[[f32; 3]; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// A box with faces outwards.
fn cuboid(min: Vec3, max: Vec3) -> Vec<[[f32; 3]; 3]> {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    faces.iter().flat_map(|face| quad(face.map(corner))).collect()
}

fn total(lights: &[Light]) -> f32 {
    lights.iter().map(|light| light.intensity.x).sum()
}

#[test]
fn triangles_of_an_open_lamp_that_face_opposite_ways_are_one() {
    let [a, b, c, d] = [[-1.0, 4.0, -0.5], [1.0, 4.0, -0.5], [1.0, 4.0, 0.5], [-1.0, 4.0, 0.5]];
    let mut geometry = room(&[[a, b, c], [a, d, c]]);
    // One for each side.
    let lights: [Light; 2] = lamps(&mut geometry).try_into().unwrap();
    assert!(lights.iter().all(|light| (light.intensity - Vec3::new(4.0, 2.0, 1.0)).length() < 1e-5), "{lights:?}");
}

#[test]
fn a_rectangle_becomes_that_rectangle_whatever_its_winding() {
    // Turned by 30 degrees, under the ceiling.
    let (cos, sin) = (0.5 * 3.0f32.sqrt(), 0.5);
    let at = |x: f32, z: f32| [x * cos - z * sin, 4.0, x * sin + z * cos];
    let mut corners = [at(-1.0, -0.5), at(1.0, -0.5), at(1.0, 0.5), at(-1.0, 0.5)];
    for _ in 0..2 {
        let mut geometry = room(&quad(corners));
        let lights = lamps(&mut geometry);
        assert_eq!(lights.iter().map(|light| light.surface.unwrap().y).sum::<f32>(), 0.0);
        let is_below = |light: &Light| light.surface == Some(Vec3::NEG_Y);
        let light = lights.into_iter().find(is_below).unwrap();
        assert!(geometry.materials[1].lamp && light.surface == Some(Vec3::NEG_Y), "{light:?}");
        assert!(
            (light.intensity - Vec3::new(4.0, 2.0, 1.0)).length() < 1e-5 && light.falloff == Falloff::InverseSquare
        );
        let LightKind::Rectangle { position, half_u, half_v } = light.kind else { panic!("{light:?}") };
        assert!((position - 4.0 * Vec3::Y).length() < 0.01 && position.y < 4.0);
        let mut sides = [half_u.length(), half_v.length()];
        sides.sort_by(f32::total_cmp);
        assert!((sides[0] - 0.5).abs() < 1e-5 && (sides[1] - 1.0).abs() < 1e-5 && half_u.dot(half_v).abs() < 1e-5);
        assert!(
            half_u.normalize().dot(Vec3::new(cos, 0.0, sin)).abs() > 1.0 - 1e-5
                || half_v.normalize().dot(Vec3::new(cos, 0.0, sin)).abs() > 1.0 - 1e-5
        );
        corners.reverse();
    }
}

#[test]
fn a_disc_becomes_that_disc() {
    let at = |index: i32| {
        let angle = index as f32 / 24.0 * std::f32::consts::TAU;
        [0.5 * angle.cos(), 0.5 * angle.sin(), -3.0]
    };
    let fan: Vec<_> = (0..24).map(|index| [[0.0, 0.0, -3.0], at(index), at(index + 1)]).collect();
    let lights = lamps(&mut room(&fan));
    assert_eq!(lights.len(), 2);
    let light = lights.iter().find(|light| light.surface.unwrap().z > 0.0).unwrap();
    let LightKind::Disk { position, normal, radius } = light.kind else { panic!("{light:?}") };
    assert!((position - Vec3::new(0.0, 0.0, -3.0)).length() < 0.01 && normal.z > 0.999 && (radius - 0.5).abs() < 0.01);
}

#[test]
fn small_lamps_shine_to_all_sides_beside_large_ones() {
    // Three balls of a hundred triangles each, of which one is small: with fine patches there would be more lights than may be.
    let ball = |middle: Vec3, radius: f32| {
        let at = |ring: i32, column: i32| {
            let (up, around) = (ring as f32 * PI / 6.0, column as f32 * PI / 6.0);
            (middle + radius * Vec3::new(up.sin() * around.cos(), up.cos(), up.sin() * around.sin())).to_array()
        };
        let quads = (0..6).flat_map(move |ring| (0..12).map(move |column| (ring, column)));
        quads.flat_map(move |(r, c)| quad([at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)])).collect::<Vec<_>>()
    };
    let small = Vec3::new(3.0, 3.0, 0.0);
    let mut triangles = ball(Vec3::ZERO, 1.0);
    triangles.extend(ball(Vec3::new(-3.0, -3.0, 0.0), 1.0));
    triangles.extend(ball(small, 0.2));
    let lights = lamps(&mut room(&triangles));
    assert!(lights.len() <= LIGHTS);
    let of_small = |light: &&Light| light.position().unwrap().distance(small) < 0.3;
    let normals: Vec<Vec3> = lights.iter().filter(of_small).map(|light| light.surface.unwrap()).collect();
    for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        assert!(normals.iter().any(|normal| normal.dot(side) > 0.5), "{side}: {normals:?}");
    }
}

#[test]
fn all_sides_of_a_box_shine_outwards() {
    let (min, max) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.5, 2.25, 3.75));
    let outside = cuboid(min, max);
    let inside_out: Vec<_> = outside.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    for faces in [outside, inside_out] {
        let lights = lamps(&mut room(&faces));
        assert_eq!(lights.len(), 6);
        let bounds = Bounds { min, max };
        for light in &lights {
            let (normal, position) = (light.surface.unwrap(), light.position().unwrap());
            let height = 0.5 * (bounds.extent() * normal).length();
            assert!((normal.dot(position - bounds.center()) - height).abs() < 0.01, "{light:?}");
            assert!(normal.dot(position - bounds.center()) > height);
        }
        assert!((total(&lights) - 2.0 * 2.0 * (0.125 + 0.375 + 0.1875)).abs() < 1e-4);
    }
}

#[test]
fn a_panel_in_the_middle_shines_on_both_sides() {
    let panel = quad([[-0.5, 0.0, -0.5], [0.5, 0.0, -0.5], [0.5, 0.0, 0.5], [-0.5, 0.0, 0.5]]);
    let lights = lamps(&mut room(&panel));
    let normals: Vec<f32> = lights.iter().map(|light| light.surface.unwrap().y).collect();
    assert!(normals.len() == 2 && normals[0] * normals[1] == -1.0, "{normals:?}");
}

#[test]
fn a_glowing_wall_is_cut_into_pieces() {
    let mut geometry = room(&quad([[-5.0, -5.0, -5.0], [5.0, -5.0, -5.0], [5.0, 5.0, -5.0], [-5.0, 5.0, -5.0]]));
    let lights = lamps(&mut geometry);
    // Nothing is behind the wall. A quarter of the room's diagonal is 4.33.
    assert!(
        lights.len() == 9 && lights.iter().all(|light| light.surface == Some(Vec3::Z)) && geometry.materials[1].lamp
    );
    assert!((total(&lights) / 200.0 - 1.0).abs() < 1e-5, "{}", total(&lights));
    let size = |light: &Light| match light.kind {
        LightKind::Rectangle { half_u, half_v, .. } => 4.0 * half_u.cross(half_v).length(),
        _ => panic!("{light:?}"),
    };
    assert!(lights.iter().all(|light| (size(light) - 100.0 / 9.0).abs() < 1e-3));
}

#[test]
fn a_side_in_front_of_which_nothing_is_does_not_shine() {
    let at = |height: f32| quad([[-0.5, height, -0.5], [0.5, height, -0.5], [0.5, height, 0.5], [-0.5, height, 0.5]]);
    for (height, expected) in [(5.0, [-1.0].as_slice()), (-5.0, &[1.0])] {
        let lights = lamps(&mut room(&at(height)));
        assert_eq!(lights.iter().map(|light| light.surface.unwrap().y).collect::<Vec<f32>>(), expected);
    }
}

#[test]
fn one_sided_lamps_shine_where_their_corners_are_counter_clockwise() {
    let corners = [[-0.5, 0.0, -0.5], [0.5, 0.0, -0.5], [0.5, 0.0, 0.5], [-0.5, 0.0, 0.5]];
    let mut turned = corners;
    turned.reverse();
    for (corners, normal) in [(corners, Vec3::NEG_Y), (turned, Vec3::Y)] {
        let mut geometry = room(&quad(corners));
        geometry.materials[1].one_sided = true;
        let [light] = lamps(&mut geometry).try_into().unwrap();
        assert_eq!(light.surface, Some(normal));
    }
    // A box that is inside out lights what it contains.
    let (min, max) = (Vec3::splat(-1.0), Vec3::splat(1.0));
    let inward: Vec<_> = cuboid(min, max).iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let mut geometry = room(&inward);
    geometry.materials[1].one_sided = true;
    let lights = lamps(&mut geometry);
    assert!(
        lights.len() == 6 && lights.iter().all(|light| light.position().unwrap().dot(light.surface.unwrap()) < 0.0)
    );
}

#[test]
fn what_surrounds_the_scene_is_left_to_gather_rays() {
    let dome = cuboid(Vec3::splat(-50.0), Vec3::splat(50.0));
    let mut geometry = room(&dome);
    assert!(lamps(&mut geometry).is_empty() && !geometry.materials[1].lamp && geometry.glows());
    // A small lamp of the same material is told apart.
    let small = quad([[-0.5, 4.0, -0.5], [0.5, 4.0, -0.5], [0.5, 4.0, 0.5], [-0.5, 4.0, 0.5]]);
    let mut geometry = room(&[dome, small.to_vec()].concat());
    assert_eq!(lamps(&mut geometry).len(), 2);
    assert!(geometry.materials[1].lamp && !geometry.materials[2].lamp && geometry.glows());
    assert_eq!(geometry.mesh.materials, [[0].as_slice(), &[2; 12], &[1; 2]].concat());
    assert!(!room(&small).glows());
}

#[test]
fn many_lamps_become_few_with_the_same_light() {
    let lamp = |index: usize| {
        let min = Vec3::new(-4.0 + 0.1 * (index % 80) as f32, 4.0, -4.0 + 0.4 * (index / 80) as f32);
        cuboid(min, min + 0.05)
    };
    let lights = lamps(&mut room(&(0..1000).flat_map(lamp).collect::<Vec<_>>()));
    assert_eq!(lights.len(), LIGHTS);
    // All over the place of the lamps, and to all sides.
    for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        let facing = |light: &&Light| light.surface.unwrap().dot(side) > 0.9;
        let strength: f32 = lights.iter().filter(facing).map(|light| light.intensity.x).sum();
        assert!((strength / (2.0 * 1000.0 * 0.0025) - 1.0).abs() < 0.1, "{side}: {strength}");
    }
    let places = Bounds::around(lights.iter().filter_map(Light::position));
    assert!(places.min.x < -3.0 && places.max.x > 3.0 && places.max.z > -0.5, "{places:?}");
    assert!((total(&lights) / (2.0 * 6000.0 * 0.0025) - 1.0).abs() < 1e-3, "{}", total(&lights));
}
