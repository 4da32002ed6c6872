//! Analytic scenes: what is lit and what is in shadow is known without rendering.

use std::f32::consts::TAU;

use glam::{DMat4, DQuat, DVec3, EulerRot, Vec2, Vec3};
use lightmesh_scene::{
    Dielectric, LightKind, Material, Mesh, Opacity, OpacityChannel, Scene, Texture, TextureUse, Wrap,
};

use crate::{Random, SceneDraft};

/// A small spherical light for [`open_floor`] and [`thin_wall`].
pub const BALL_LIGHT: LightKind = LightKind::Sphere { position: Vec3::new(-2.0, 3.0, 0.7), radius: 0.25 };

/// A floor under a light with nothing between them: every visible point is fully lit.
pub fn open_floor(light: LightKind) -> Scene {
    SceneDraft::new().floor(0.0, 4.0).light(light).camera([0.5, 2.5, 4.0], [0.0, 0.0, 0.3]).finish("open floor")
}

/// A wall from x = 0 to x = `thickness` between a lit yard (x < 0) and a closed room (x > 0). No light reaches the room. The
/// room's sheets intersect, so that no corner has a crack; the camera is inside and sees the base of the wall.
///
/// The light must be on the yard's side.
pub fn thin_wall(thickness: f64, light: LightKind) -> SceneDraft {
    SceneDraft::new()
        .floor(0.0, 6.0)
        .cuboid([0.0, -0.5, -4.0], [thickness, 4.0, 4.0])
        // Ceiling, far wall, two side walls.
        .quad([[0.0, 3.5, -4.0], [5.0, 3.5, -4.0], [5.0, 3.5, 4.0], [0.0, 3.5, 4.0]])
        .quad([[4.5, -0.5, -4.0], [4.5, -0.5, 4.0], [4.5, 4.0, 4.0], [4.5, 4.0, -4.0]])
        .quad([[0.0, -0.5, -3.5], [5.0, -0.5, -3.5], [5.0, 4.0, -3.5], [0.0, 4.0, -3.5]])
        .quad([[0.0, -0.5, 3.5], [5.0, -0.5, 3.5], [5.0, 4.0, 3.5], [0.0, 4.0, 3.5]])
        .light(light)
        .camera([2.0, 1.2, 1.0], [0.0, 0.1, 0.0])
}

/// A half-plane (x < 0, at height 2) under a square light (2 × 2, at height 4) over a floor. The camera looks down on the floor
/// from below the half-plane: its pixels cover x in [-2, 2] if the image is four times as wide as high.
///
/// The fraction of the light visible from the floor's point (x, 0, z) is `clamp((1 + x) / 2, 0, 1)`: the line from it past the
/// edge meets the light at -x.
pub fn half_plane() -> Scene {
    let light = LightKind::Rectangle { position: Vec3::new(0.0, 4.0, 0.0), half_u: Vec3::X, half_v: Vec3::Z };
    SceneDraft::new()
        .floor(0.0, 8.0)
        .quad([[-40.0, 2.0, -40.0], [-40.0, 2.0, 40.0], [0.0, 2.0, 40.0], [0.0, 2.0, -40.0]])
        .light(light)
        .orthographic([0.0, 1.0, 0.0], [0.0, 0.0, 0.0], 1.0)
        .finish("half-plane")
}

/// A few boxes on a floor with lights `lights`, all moved by `offset`.
pub fn pile(offset: DVec3, lights: &[LightKind]) -> Scene {
    let draft = SceneDraft::new()
        .moved(offset)
        .floor(0.0, 5.0)
        .cuboid([-1.0, -0.1, -1.0], [0.5, 1.1, 0.3])
        .cuboid([0.8, -0.1, -0.4], [1.7, 0.6, 0.9])
        .cuboid([-0.9, 1.7, -2.0], [1.3, 1.8, -1.4]);
    lights
        .iter()
        .fold(draft, |draft, light| draft.light(light.clone()))
        .camera([2.5, 3.1, 4.2], [0.0, 0.4, 0.0])
        .finish("pile")
}

/// The low and the high corner of [`mirror_room`].
pub const MIRROR_ROOM: [DVec3; 2] = [DVec3::new(-2.0, -1.0, -1.5), DVec3::new(2.5, 1.0, 1.5)];
/// The low and the high corner of the box in it.
pub const BOX_IN_MIRRORS: [DVec3; 2] = [DVec3::new(0.6, -0.7, -0.9), DVec3::new(1.3, 0.1, -0.2)];
/// Where its camera stands.
pub const EYE_IN_MIRRORS: DVec3 = DVec3::new(-1.1, 0.3, 0.7);

/// A closed room whose walls mirror `ks` of the light and nothing else, with a box that shines by 1.
pub fn mirror_room(ks: f32) -> Scene {
    let black = || Material::matt(Vec3::ZERO);
    let cuboid = |draft: SceneDraft, [low, high]: [DVec3; 2]| draft.cuboid(low.to_array(), high.to_array());
    let walls = cuboid(SceneDraft::new().painted(black().with_ks([ks; 3])), MIRROR_ROOM);
    let both = cuboid(walls.painted(black().with_emission(Vec3::ONE)), BOX_IN_MIRRORS);
    both.camera(EYE_IN_MIRRORS.to_array(), [0.4, -0.4, -0.3]).finish("mirror room")
}

/// The same scene with holes: two of three triangles are cut out by noise in an image, and by the opacities of their corners.
pub fn perforated(scene: Scene) -> Scene {
    with_opacity(scene, |opacity| opacity.with_cutoff(0.45))
}

/// The same scene with panes: two of three triangles let light through in part, some of them as glass.
pub fn glazed(scene: Scene) -> Scene {
    let mut scene = with_opacity(scene, |opacity| opacity.with_filter([0.9, 0.6, 1.0]).with_factor(0.8));
    let geometry = scene.geometry_mut();
    let all = geometry.materials.len();
    let glass = Dielectric::new(1.5).with_absorption([0.1, 0.7, 0.3]);
    for thin in [false, true] {
        let panes = &geometry.materials[all / 2..all];
        let of_glass = |pane: &Material| pane.clone().with_dielectric(glass.with_thin(thin));
        geometry.materials.extend(panes.iter().map(of_glass).collect::<Vec<_>>());
    }
    for (material, index) in geometry.mesh.materials.iter_mut().zip(0..) {
        *material += match index % 6 {
            2 => all as u32 / 2,
            5 => all as u32,
            _ => 0,
        };
    }
    scene
}

/// Gives two of three triangles opacities that are noise in an image, and vary between their corners.
fn with_opacity(mut scene: Scene, complete: impl Fn(Opacity) -> Opacity) -> Scene {
    const SIDE: u32 = 16;
    let mut random = Random::new(11);
    let geometry = scene.geometry_mut();
    let texels = (0..SIDE * SIDE).map(|_| [90, 160, 40, (256.0 * random.unit()) as u8]).collect();
    geometry.textures.push(Texture { name: "holes".into(), size: [SIDE; 2], texels });
    let wrap = [Wrap::Repeat, Wrap::Mirror];
    let uses = TextureUse { wrap, ..TextureUse::new(geometry.textures.len() as u32 - 1) };
    let count = geometry.materials.len() as u32;
    for index in 0..count as usize {
        let material = geometry.materials[index].clone();
        geometry.materials.push(material.with_opacity(complete(Opacity::by(uses, OpacityChannel::Alpha))));
    }
    let mesh = &mut geometry.mesh;
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(0.17 * p.x + 0.05 * p.y, 0.11 * p.z - 0.14 * p.y)).collect();
    mesh.opacities = mesh.positions.iter().map(|_| 0.75 + 0.25 * random.unit() as f32).collect();
    for (material, index) in mesh.materials.iter_mut().zip(0..) {
        *material += if index % 3 == 0 { 0 } else { count };
    }
    scene
}

/// `count` random triangles in the cube [-3, 3]³ with a point light at its centre.
pub fn soup(seed: u64, count: usize) -> Scene {
    let mut random = Random::new(seed);
    let mut draft = SceneDraft::new();
    for _ in 0..count {
        let (center, size) = (3.0 * random.in_cube(), 0.2 + random.unit());
        let corners = [(); 3].map(|()| center + size * random.in_cube());
        draft = draft.triangles(&corners, &[[0, 1, 2]]);
    }
    draft.point_light([0.3, 0.2, -0.1]).camera([5.0, 4.0, 6.0], [0.0; 3]).finish("soup")
}

/// A knobbly ball with normals, which is stored once for many places: turned, mirrored, squeezed and inside each other; on a floor with a box,
/// under lights of two kinds.
pub fn many_balls() -> Scene {
    let lights = [BALL_LIGHT, LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 }];
    let draft = SceneDraft::new().floor(0.0, 4.0).cuboid([-0.3, -0.1, -2.5], [0.4, 1.7, -2.1]);
    let draft = lights.into_iter().fold(draft, SceneDraft::light);
    let mut scene = draft.camera([0.3, 2.6, 6.5], [0.0, 0.6, 0.0]).finish("many balls");
    let mut random = Random::new(5);
    let places: Vec<DMat4> = (0..23).map(|number| place(number, &mut random)).collect();
    let added = scene.geometry_mut().mesh.add_instances(&knobbly_ball(), &places, "ball");
    added.expect("each place can be held");
    scene
}

/// Clumps of small triangles, stored once for 60 places, between a floor and a wide light: what hides the light from neighbouring points are
/// thousands of triangles, each a little.
pub fn thicket() -> Scene {
    let mut random = Random::new(3);
    let mut clump = Mesh::default();
    for number in 0..1000 {
        let center = random.in_cube();
        clump.positions.extend([(); 3].map(|()| (center + 0.05 * random.in_cube()).as_vec3()));
        clump.triangles.push([0, 1, 2].map(|corner| 3 * number + corner));
    }
    clump.materials = vec![0; clump.triangles.len()];
    let mut random = Random::new(4);
    let places: Vec<DMat4> = (0..60)
        .map(|_| DMat4::from_translation(DVec3::new(2.0, 0.4, 2.0) * random.in_cube() + 1.5 * DVec3::Y))
        .collect();
    let light = LightKind::Rectangle { position: 4.0 * Vec3::Y, half_u: 2.0 * Vec3::X, half_v: 1.5 * Vec3::Z };
    let draft = SceneDraft::new().floor(0.0, 4.0).light(light);
    let mut scene = draft.camera([0.0, 0.4, 4.0], [0.0, 0.0, 0.0]).finish("thicket");
    let added = scene.geometry_mut().mesh.add_instances(&clump, &places, "clump");
    added.expect("each place can be held");
    scene
}

/// A place of a ball on a floor, in rows of five; each fourth mirrors.
fn place(number: u32, random: &mut Random) -> DMat4 {
    let [x, z] = [number % 5, number / 5].map(|k| f64::from(k) - 2.0);
    let [a, b, c, d] = std::array::from_fn(|_| random.unit());
    let side = if number % 4 == 1 { -1.0 } else { 1.0 };
    let turn = DQuat::from_euler(EulerRot::XYZ, 6.0 * a, 6.0 * b, 6.0 * c);
    let scale = DVec3::new(side * (0.5 + d), 0.5 + a, 0.5 + b);
    DMat4::from_scale_rotation_translation(scale, turn, DVec3::new(x, 0.5 + 0.3 * c, z))
}

/// A ball of 108 triangles with three ridges.
fn knobbly_ball() -> Mesh {
    const COLUMNS: u32 = 9;
    const ROWS: u32 = 6;
    let mut ball = Mesh::default();
    for (row, column) in (0..=ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let (a, b) = (TAU * column as f32 / COLUMNS as f32, 0.5 * TAU * row as f32 / ROWS as f32);
        let normal = Vec3::new(b.sin() * a.cos(), b.cos(), b.sin() * a.sin());
        ball.positions.push((0.4 + 0.1 * (3.0 * a).sin() * b.sin()) * normal);
        ball.normals.push(normal);
    }
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let at = |row: u32, column: u32| row * COLUMNS + column % COLUMNS;
        let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
        ball.triangles.extend([[a, b, c], [a, c, d]]);
    }
    ball.materials = vec![0; ball.triangles.len()];
    ball
}
