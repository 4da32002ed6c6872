use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use lightmesh_scene::internals::lamps::{LIGHTS, lamps};
use lightmesh_scene::{
    Bounds, Falloff, Geometry, Light, LightKind, Material, Mesh, Opacity, OpacityChannel, Texture, TextureUse,
};

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
    // Three eggs of a hundred triangles each, of which one is small: with fine patches there would be more lights than may be.
    let egg = |middle: Vec3, radius: f32| {
        let at = |ring: i32, column: i32| {
            let (up, around) = (ring as f32 * PI / 6.0, column as f32 * PI / 6.0);
            (middle + radius * Vec3::new(up.sin() * around.cos(), 0.8 * up.cos(), up.sin() * around.sin())).to_array()
        };
        let quads = (0..6).flat_map(move |ring| (0..12).map(move |column| (ring, column)));
        quads.flat_map(move |(r, c)| quad([at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)])).collect::<Vec<_>>()
    };
    let small = Vec3::new(3.0, 3.0, 0.0);
    let mut triangles = egg(Vec3::ZERO, 1.0);
    triangles.extend(egg(Vec3::new(-3.0, -3.0, 0.0), 1.0));
    triangles.extend(egg(small, 0.2));
    let lights = lamps(&mut room(&triangles));
    assert!(lights.len() <= LIGHTS);
    let of_small = |light: &&Light| light.position().unwrap().distance(small) < 0.3;
    let normals: Vec<Vec3> = lights.iter().filter(of_small).map(|light| light.surface.unwrap()).collect();
    for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        assert!(normals.iter().any(|normal| normal.dot(side) > 0.5), "{side}: {normals:?}");
    }
}

/// A ball with faces outwards, of `columns` around and half as many rings.
fn ball(center: Vec3, radius: f32, columns: u32) -> Vec<[[f32; 3]; 3]> {
    let rings = columns / 2;
    let at = |ring: u32, column: u32| {
        let (down, around) = (PI * ring as f32 / rings as f32, 2.0 * PI * (column % columns) as f32 / columns as f32);
        let place = Vec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
        (center + radius * place).to_array()
    };
    let side =
        |(ring, column)| quad([at(ring, column), at(ring, column + 1), at(ring + 1, column + 1), at(ring + 1, column)]);
    (0..rings).flat_map(|ring| (0..columns).map(move |column| (ring, column))).flat_map(side).collect()
}

fn area(triangles: &[[[f32; 3]; 3]]) -> f32 {
    let of = |corners: &[[f32; 3]; 3]| {
        let [a, b, c] = corners.map(Vec3::from_array);
        0.5 * (b - a).cross(c - a).length()
    };
    triangles.iter().map(of).sum()
}

#[test]
fn a_ball_becomes_a_ball_of_its_power() {
    let center = Vec3::new(1.0, 2.0, -0.5);
    for columns in [8, 12, 32] {
        for one_sided in [false, true] {
            let triangles = ball(center, 0.3, columns);
            let mut geometry = room(&triangles);
            geometry.materials[1].one_sided = one_sided;
            let [light] = lamps(&mut geometry).try_into().unwrap();
            let LightKind::Sphere { position, radius } = light.kind else { panic!("{light:?}") };
            assert!((position - center).length() < 1e-4 && (0.3..0.3015).contains(&radius), "{light:?}");
            assert!(light.lamp && light.surface.is_none() && light.falloff == Falloff::InverseSquare);
            // All sides together shine as π L A; a ball of intensity I as 4 π I.
            let expected = 0.25 * area(&triangles) * Vec3::new(2.0, 1.0, 0.5);
            assert!((light.intensity - expected).length() < 1e-4 * expected.length(), "{light:?}, not {expected}");
        }
    }
}

#[test]
fn what_is_no_ball_is_no_ball() {
    let is_ball = |triangles: &[[[f32; 3]; 3]], one_sided: bool| {
        let mut geometry = room(triangles);
        geometry.materials[1].one_sided = one_sided;
        lamps(&mut geometry).iter().any(|light| matches!(light.kind, LightKind::Sphere { .. }))
    };
    let round = ball(Vec3::ZERO, 0.5, 24);
    assert!(is_ball(&round, true));
    // Open, inside out, flattened, and a box, whose corners lie on a sphere, too.
    assert!(!is_ball(&round[48..], false));
    let inward: Vec<_> = round.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(is_ball(&inward, false) && !is_ball(&inward, true));
    let flat: Vec<_> = round.iter().map(|corners| corners.map(|[x, y, z]| [x, 0.9 * y, z])).collect();
    assert!(!is_ball(&flat, false));
    assert!(!is_ball(&cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)), false));
}

#[test]
fn a_chain_of_balls_is_as_many_lights() {
    let centers = (0..14).map(|index| Vec3::new(0.6 * index as f32 - 4.0, 3.0, 0.0));
    let chain: Vec<_> = centers.flat_map(|center| ball(center, 0.1, 16)).collect();
    assert_eq!(lamps(&mut room(&chain)).len(), 14);
    // Those of very many that become one shine as all of them, also together with surfaces.
    let places = (0..300).map(|index| Vec3::new(0.3 * (index % 30) as f32 - 4.5, 3.0, 0.3 * (index / 30) as f32));
    let balls: Vec<_> = places.flat_map(|center| ball(center, 0.1, 8)).collect();
    let panel = quad([[-0.5, 4.0, -0.5], [0.5, 4.0, -0.5], [0.5, 4.0, 0.5], [-0.5, 4.0, 0.5]]);
    let all = [balls, panel.to_vec()].concat();
    let lights = lamps(&mut room(&all));
    assert_eq!(lights.len(), LIGHTS);
    let power = |light: &Light| if light.surface.is_some() { light.intensity.x } else { 4.0 * light.intensity.x };
    // Open surfaces shine to both sides.
    let expected = 2.0 * (area(&all) + 1.0);
    assert!((lights.iter().map(power).sum::<f32>() / expected - 1.0).abs() < 1e-3);
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

/// The middles, normals and strengths of lights whose normal has this component along an axis.
fn facing(lights: &[Light], axis: usize, sign: f32) -> Vec<(Vec3, f32)> {
    let is_facing = |light: &&Light| light.surface.is_some_and(|normal| normal[axis] * sign > 0.99);
    lights.iter().filter(is_facing).map(|light| (light.position().unwrap(), light.intensity.x)).collect()
}

#[test]
fn sides_of_a_trough_shine_into_it_and_away_from_it() {
    // Open at the bottom: two long sides of 2 × 1, half a metre apart, and a lid.
    let [low, high] = [Vec3::new(-1.0, 0.0, -0.25), Vec3::new(1.0, 1.0, 0.25)];
    let at = |x: f32, y: f32, z: f32| [x, y, z];
    let mut sheets = Vec::new();
    for z in [low.z, high.z] {
        sheets.extend(quad([at(low.x, low.y, z), at(high.x, low.y, z), at(high.x, high.y, z), at(low.x, high.y, z)]));
    }
    let lid =
        [at(low.x, high.y, low.z), at(high.x, high.y, low.z), at(high.x, high.y, high.z), at(low.x, high.y, high.z)];
    sheets.extend(quad(lid));
    let lights = lamps(&mut room(&sheets));
    for sign in [1.0, -1.0] {
        let mut found = facing(&lights, 2, sign);
        found.sort_by(|a, b| a.0.z.total_cmp(&b.0.z));
        let [(first, one), (second, other)] = found.try_into().unwrap();
        assert!((first.z - low.z).abs() < 1e-3 && (second.z - high.z).abs() < 1e-3, "{first} {second}");
        assert!((one - 4.0).abs() < 1e-4 && (other - 4.0).abs() < 1e-4, "of 2 × 1 each: {one} {other}");
    }
}

#[test]
fn a_ring_of_bars_shines_from_its_bars() {
    let bar = |x: [f32; 2], z: [f32; 2]| cuboid(Vec3::new(x[0], 1.8, z[0]), Vec3::new(x[1], 1.9, z[1]));
    let mut ring = bar([-0.8, 0.8], [-0.8, -0.7]);
    ring.extend(bar([-0.8, 0.8], [0.7, 0.8]));
    ring.extend(bar([-0.8, -0.7], [-0.7, 0.7]));
    ring.extend(bar([0.7, 0.8], [-0.7, 0.7]));
    let lights = lamps(&mut room(&ring));
    // Below there is the ring's own area, and nothing in the hole.
    let below = facing(&lights, 1, -1.0);
    let strength: f32 = below.iter().map(|(_, strength)| strength).sum();
    assert!((strength / (2.0 * (1.6 * 1.6 - 1.4 * 1.4)) - 1.0).abs() < 0.05, "{strength}");
    assert!(below.iter().all(|(place, _)| place.x.abs().max(place.z.abs()) > 0.7), "{below:?}");
    // What faces along x: the outer side of one bar, and the inner side of the opposite one.
    let places: Vec<f32> = facing(&lights, 0, 1.0).iter().map(|(place, _)| place.x).collect();
    assert!(
        places.iter().any(|x| (x - 0.8).abs() < 1e-3) && places.iter().any(|x| (x + 0.7).abs() < 1e-3),
        "{places:?}"
    );
}

#[test]
fn walls_without_anything_else_shine_inwards_too() {
    let walls = cuboid(Vec3::new(-2.0, -1.0, -1.5), Vec3::new(2.0, 1.0, 1.5));
    let mut geometry = room(&walls);
    // Without the triangle of the room around.
    let mesh = &mut geometry.mesh;
    mesh.triangles.remove(0);
    mesh.materials.remove(0);
    let lights = lamps(&mut geometry);
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let places: Vec<f32> = facing(&lights, axis, sign).iter().map(|(place, _)| place[axis] * sign).collect();
            assert!(places.iter().any(|&place| place > 0.0) && places.iter().any(|&place| place < 0.0), "{places:?}");
        }
    }
}

#[test]
fn lights_are_a_hair_in_front_of_large_lamps() {
    let at = |x: f32, z: f32| [x, 4.0, z];
    let lights = lamps(&mut room(&quad([at(-2.0, -1.5), at(2.0, -1.5), at(2.0, 1.5), at(-2.0, 1.5)])));
    let below = facing(&lights, 1, -1.0);
    assert!(!below.is_empty() && below.iter().all(|(place, _)| place.y < 4.0 && place.y > 4.0 - 3e-4), "{below:?}");
}

/// A square of 3 × 3 with an image of these texels on it, as the first corner's diagonal divides it, of which light is left by its alpha.
fn panel(size: u32, opacity: Option<Opacity>, texel: impl Fn(u32, u32) -> [u8; 4]) -> Geometry {
    let at = |x: f32, z: f32| [x, 4.0, z];
    let mut geometry = room(&quad([at(-1.5, -1.5), at(1.5, -1.5), at(1.5, 1.5), at(-1.5, 1.5)]));
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    geometry.mesh.uvs = [[0.0; 2]; 3].into_iter().chain(uvs).map(Vec2::from_array).collect();
    let texels = (0..size * size).map(|index| texel(index % size, index / size)).collect();
    geometry.textures = vec![Texture { name: "image".into(), size: [size; 2], texels }].into();
    let lamp = &mut geometry.materials[1];
    lamp.emission = Vec3::ONE;
    lamp.emission_texture = Some(TextureUse::new(0));
    lamp.opacity = opacity;
    geometry
}

#[test]
fn each_texel_counts_by_its_area() {
    const WHITE: [u8; 4] = [255; 4];
    const BLACK: [u8; 4] = [0, 0, 0, 255];
    let strength = |size: u32, is_lit: &dyn Fn(u32, u32) -> bool| {
        let lights = lamps(&mut panel(size, None, |x, y| if is_lit(x, y) { WHITE } else { BLACK }));
        facing(&lights, 1, -1.0).iter().map(|(_, strength)| strength).sum::<f32>()
    };
    let share = |count: f32, size: f32| 9.0 * count / (size * size);
    let close = |found: f32, right: f32| assert!((found / right - 1.0).abs() < 1e-3, "{found}, not {right}");
    close(strength(64, &|x, y| x == y), share(64.0, 64.0));
    close(strength(64, &|x, y| (x, y) == (31, 30)), share(1.0, 64.0));
    close(strength(64, &|x, y| (x, y) == (31, 31)), share(1.0, 64.0));
    close(strength(64, &|_, y| y % 2 == 0), share(2048.0, 64.0));
    close(strength(512, &|x, y| x / 4 == 9 && y / 4 == 9), share(16.0, 512.0));
}

#[test]
fn holes_give_no_light() {
    let total = |opacity: Option<Opacity>| {
        let texel = |x: u32, _| [255, 255, 255, if x < 8 { 255 } else { 64 }];
        let lights = lamps(&mut panel(16, opacity, texel));
        facing(&lights, 1, -1.0).iter().map(|(_, strength)| strength).sum::<f32>()
    };
    let by = |cutoff: f32| Opacity::by(TextureUse::new(0), OpacityChannel::Alpha).with_cutoff(cutoff);
    let left = [None, Some(by(0.5)), Some(by(0.1)), Some(by(0.5).with_filter(Vec3::ONE))].map(total);
    for (found, right) in left.into_iter().zip([9.0, 4.5, 9.0, 9.0 * (0.5 + 0.5 * 64.0 / 255.0)]) {
        assert!((found / right - 1.0).abs() < 1e-3, "{found}, not {right}");
    }
}

#[test]
fn which_lights_are_merged_depends_neither_on_order_nor_on_rounding() {
    let cubes = |scale: f32, reversed: bool| {
        let cube = |index: i32| {
            let place = 0.6 * Vec3::new((index % 8) as f32 - 3.5, (index / 8) as f32 - 3.5, 0.5);
            cuboid(scale * (place - 0.1), scale * (place + 0.1))
        };
        let mut triangles: Vec<_> = (0..64).flat_map(cube).collect();
        if reversed {
            triangles.reverse();
        }
        let mut lights = lamps(&mut room(&triangles));
        assert_eq!(lights.len(), LIGHTS);
        lights.sort_by_key(|light| (10.0 * light.position().unwrap()).round().to_array().map(|axis| axis as i32));
        lights
    };
    let [one, hair, other] = [cubes(1.0, false), cubes(1.0 + 3e-7, false), cubes(1.0, true)];
    for (one, other) in one.iter().zip(&hair).chain(one.iter().zip(&other)) {
        let apart = one.position().unwrap().distance(other.position().unwrap());
        assert!(apart < 1e-3 && (one.intensity.x / other.intensity.x - 1.0).abs() < 1e-3, "{one:?} {other:?}");
    }
}

#[test]
fn lamps_in_one_place_are_merged() {
    let panel = quad([[-1.0, 4.0, -0.5], [1.0, 4.0, -0.5], [1.0, 4.0, 0.5], [-1.0, 4.0, 0.5]]);
    let mut geometry = room(&panel);
    geometry.materials[1].one_sided = true;
    // A material each, so that each is a lamp of its own.
    let lamp = geometry.materials[1].clone();
    for number in 2..=150 {
        let first = geometry.mesh.positions.len() as u32;
        geometry.mesh.positions.extend(panel.iter().flatten().copied().map(Vec3::from_array));
        geometry.mesh.triangles.extend([[first, first + 1, first + 2], [first + 3, first + 4, first + 5]]);
        geometry.mesh.materials.extend([number; 2]);
        geometry.materials.push(lamp.clone());
    }
    let lights = lamps(&mut geometry);
    assert_eq!(lights.len(), LIGHTS);
    assert!((total(&lights) / (150.0 * 4.0) - 1.0).abs() < 1e-4, "{}", total(&lights));
}
