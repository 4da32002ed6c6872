//! Written and read again, a scene is the same.

use std::fs;

use glam::{Affine2, DMat4, DVec3, Vec2, Vec3};
use lightmesh_scene::{
    Camera, Dielectric, Facets, Falloff, Fov, Light, LightKind, Material, MeshPart, NormalMap, Opacity, OpacityChannel,
    Projection, Scene, SceneBuilder, Texture, TextureUse, Weight, Wrap,
};

/// Everything that a scene can hold, around `offset`.
fn scene(offset: DVec3) -> Scene {
    let positions = [DVec3::ZERO, DVec3::new(0.1, 2.0, 0.3), DVec3::new(-1.0, 0.7, 1e-5), DVec3::new(3.0, 0.0, 0.2)];
    let normals = [Vec3::Z, Vec3::Y, Vec3::X, Vec3::NEG_Z];
    let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(0.3, 0.7)];
    let triangles = [[0, 1, 2], [1, 3, 2], [0, 3, 1]];
    let mut builder = SceneBuilder::new();
    let colors = [Vec3::new(0.1, 0.7, 0.3), Vec3::ONE, Vec3::ZERO, Vec3::splat(0.3)];
    let opacities = [0.25, 1.0, 0.75, 0.5];
    let smooth = MeshPart {
        positions: &positions,
        normals: &normals,
        uvs: &uvs,
        colors: &colors,
        opacities: &opacities,
        triangles: &triangles,
    };
    builder.add(smooth, &DMat4::from_translation(offset), |index| [1, 0, 3][index]).unwrap();
    let flat = MeshPart { normals: &[], uvs: &[], colors: &[], opacities: &[], ..smooth };
    builder.add(flat, &DMat4::from_translation(offset + DVec3::X), |_| 2).unwrap();
    let mut scene = builder.finish_scene("round trip");
    let tiled = TextureUse { transform: Affine2::from_scale(Vec2::splat(10.0)), ..TextureUse::new(1) };
    scene.geometry_mut().materials = vec![
        Material::default().named("plain"),
        Material::default()
            .named("shiny")
            .with_ka([0.1, 0.2, 0.3])
            .with_kd([0.4, 1.5, 0.6])
            .with_ks([0.7, 0.8, 0.9])
            .with_shininess(77.7)
            .with_emission([0.0, 2.5, 0.1])
            .with_ks_tinted([0.3, 0.2, 0.1])
            .with_emission_tinted([0.0, 0.0, 0.7])
            .with_lamp(false)
            .with_catcher(true)
            .with_texture(TextureUse {
                texture: 0,
                wrap: [Wrap::Clamp, Wrap::Mirror],
                transform: Affine2::from_scale_angle_translation(Vec2::new(1.3, -0.7), 0.77, Vec2::new(0.1, -3.3)),
            })
            .with_normal_texture(NormalMap::new(TextureUse::new(1)).with_scale(-0.3))
            .with_opacity(Opacity::by(TextureUse::new(1), OpacityChannel::Green).with_cutoff(0.3).with_factor(0.9)),
        Material::default(),
        Material::default()
            .named("tiles")
            .with_texture(tiled)
            .with_opacity(Opacity::by(tiled, OpacityChannel::Alpha).with_cutoff(0.1).with_factor(0.7)),
        Material::default().named("sign").with_emission([2.0, 1.0, 0.5]).with_emission_texture(TextureUse {
            transform: Affine2::from_scale_angle_translation(Vec2::new(0.3, 1.7), -0.4, Vec2::new(0.1, 0.2)),
            ..TextureUse::new(0)
        }),
        Material::default().named("gold").with_facets(Facets::new(0.3).with_metallic(0.9).with_grazing(0.7)),
        Material::default().named("rust").with_facets(Facets::new(0.9)).with_metallic_roughness_texture(TextureUse {
            transform: Affine2::from_scale_angle_translation(Vec2::new(0.7, 1.1), 0.3, Vec2::new(0.3, 0.1)),
            wrap: [Wrap::Clamp, Wrap::Repeat],
            ..TextureUse::new(1)
        }),
        Material::default().named("bricks").with_normal_texture(NormalMap::new(TextureUse {
            transform: Affine2::from_scale_angle_translation(Vec2::new(-0.3, 1.7), 0.4, Vec2::new(0.1, 0.2)),
            wrap: [Wrap::Mirror, Wrap::Clamp],
            ..TextureUse::new(0)
        })),
        Material::default().named("bare").with_opacity(Opacity::default()),
        Material::default().named("pane").with_opacity(Opacity::blend(0.25)),
        Material::default().named("foil").with_opacity(Opacity::blend(0.25).with_filter([0.5, 1.0, 0.0])),
        Material::of(Dielectric::new(1.33).with_absorption([0.5, 0.1, 0.7])).named("water"),
        Material::of(Dielectric::new(1.5).with_thin(true)).with_opacity(Opacity::blend(0.25)).named("window"),
        Material::default().named("veil").with_texture(tiled).with_opacity(
            Opacity::by(TextureUse::new(0), OpacityChannel::Red).with_filter([0.5, 1.0, 0.125]).with_factor(0.5),
        ),
    ];
    scene.geometry_mut().textures = vec![texture("oak.png", [3, 2]), texture("tiles", [1, 7])].into();
    let origin = scene.geometry.origin;
    let at = |x, y, z| (offset + DVec3::new(x, y, z) - origin).as_vec3();
    let direction = Vec3::new(0.3, -0.8, 0.2).normalize();
    let light = |kind, falloff| Light::new(kind).with_intensity([0.1, 700.3, 33.3]).with_falloff(falloff).named("l");
    let position = at(1.1, 2.2, 3.3);
    let (half_u, half_v) = (Vec3::new(0.3, 0.0, 0.1), Vec3::new(0.0, 0.7, 0.0));
    scene.lights.list = vec![
        light(LightKind::Point { position, spread: 0.0 }, Falloff::InverseSquare),
        light(LightKind::Point { position, spread: 0.35 }, Falloff::None),
        light(LightKind::Directional { direction, angle: 0.0 }, Falloff::None),
        light(LightKind::Directional { direction, angle: 0.0093 }, Falloff::InverseSquare),
        Light::directional(Vec3::NEG_Z).unwrap().with_angle(std::f32::consts::PI).with_intensity(Vec3::splat(0.2)),
        light(LightKind::Spot { position, direction, inner: 0.3, outer: 0.7, radius: 0.0 }, Falloff::InverseSquare),
        light(
            LightKind::Spot { position, direction, inner: 0.0, outer: std::f32::consts::FRAC_PI_2, radius: 0.0 },
            Falloff::None,
        ),
        light(LightKind::Spot { position, direction, inner: 0.1, outer: 0.7, radius: 0.07 }, Falloff::None),
        light(LightKind::Sphere { position, radius: 0.33 }, Falloff::None),
        light(LightKind::Disk { position, normal: direction, radius: 0.33 }, Falloff::InverseSquare),
        light(LightKind::Rectangle { position, half_u, half_v }, Falloff::None),
        Light::disk(position, direction, 0.33).unwrap().with_intensity([0.1, 0.2, 0.3]),
        Light::rectangle(position, half_u, half_v).unwrap().with_falloff(Falloff::InverseSquare),
        Light::point(position).with_intensity(Vec3::ZERO),
    ];
    let up = direction.cross(Vec3::Y).cross(direction).normalize();
    let camera = |projection| {
        let mut camera = Camera::look_to(at(5.5, 4.4, 3.3), direction, up, 45.0).unwrap();
        camera.name = "c".into();
        (camera.direction, camera.up) = (direction, up);
        camera.with_projection(projection)
    };
    scene.cameras = vec![
        camera(Projection::Perspective(Fov::Vertical(41.3))),
        camera(Projection::Perspective(Fov::Horizontal(73.1))),
        camera(Projection::Orthographic { height: 7.7 }),
        camera(Projection::Perspective(Fov::Vertical(41.3))).with_shift([0.1, -0.3]),
        camera(Projection::Perspective(Fov::Horizontal(73.1))).with_shift([0.0, 1.7]),
        camera(Projection::Orthographic { height: 7.7 }).with_shift([-1.1, 0.0]),
        camera(Projection::Perspective(Fov::Vertical(41.3))).with_clip(0.3, 7.9).unwrap(),
        camera(Projection::Perspective(Fov::Vertical(41.3))).with_clip(0.0, 1e-6).unwrap(),
        camera(Projection::Orthographic { height: 7.7 }).with_clip(1e9, f32::INFINITY).unwrap(),
    ];
    scene.lights.ambient = Some(Vec3::new(0.1, 0.2, 0.3));
    scene.lights.background = Some(Vec3::new(0.6, 0.75, 0.9));
    scene.light_mesh.step = Some(0.1);
    scene.light_mesh.radius = Some(2.1);
    scene.light_mesh.weight = Some(Weight::Constant);
    scene
}

fn texture(name: &str, size: [u32; 2]) -> Texture {
    let texel = |index: u32| [11 * index as u8, 255 - 40 * (index as u8 % 7), 90, 255 - index as u8];
    Texture { name: name.into(), size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

fn reread(scene: &Scene, name: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    scene.export(&path).unwrap();
    Scene::open(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Position, normal, texture coordinates, colour and opacity.
type Corner = (Vec3, Vec3, Vec2, Vec3, f32);

/// Triangle by triangle. Opacities count where something is cut out.
fn corners(scene: &Scene) -> Vec<[Corner; 3]> {
    let mesh = &scene.geometry.mesh;
    let corner = |vertex: u32, material: u32| {
        let vertex = vertex as usize;
        let opacity = scene.geometry.materials[material as usize].opacity.is_some();
        let opacity = if opacity { mesh.opacities[vertex] } else { 1.0 };
        (mesh.positions[vertex], mesh.normals[vertex], mesh.uvs[vertex], mesh.colors[vertex], opacity)
    };
    let triangles = mesh.triangles.iter().zip(&mesh.materials);
    triangles.map(|(triangle, &material)| triangle.map(|vertex| corner(vertex, material))).collect()
}

#[test]
fn a_scene_at_home_is_the_same_to_the_last_bit() {
    let written = scene(DVec3::ZERO);
    for name in ["scene.glb", "scene.toml"] {
        let read = reread(&written, name);
        assert_eq!(corners(&read), corners(&written), "{name}");
        assert_eq!(read.geometry.mesh.materials, written.geometry.mesh.materials, "{name}");
        assert_eq!(read.geometry.materials, written.geometry.materials, "{name}");
        assert_eq!(read.geometry.textures, written.geometry.textures, "{name}");
        assert_eq!(read.lights, written.lights, "{name}");
        assert_eq!(read.cameras, written.cameras, "{name}");
        assert_eq!(
            (read.lights.ambient, read.lights.background),
            (written.lights.ambient, written.lights.background),
            "{name}"
        );
        assert_eq!((read.light_mesh, read.geometry.origin), (written.light_mesh, written.geometry.origin), "{name}");
        assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
    }
}

#[test]
fn a_scene_far_away_keeps_its_frame_and_shape() {
    let written = scene(DVec3::new(1e6, -3e5, 7e4));
    assert_ne!(written.geometry.origin, DVec3::ZERO);
    for name in ["scene.glb", "scene.toml"] {
        let read = reread(&written, name);
        assert_eq!(read.geometry.origin, written.geometry.origin, "{name}");
        for (read, written) in corners(&read).iter().flatten().zip(corners(&written).iter().flatten()) {
            assert!(read.0.distance(written.0) < 1e-9, "{name}: {} {}", read.0, written.0);
            assert_eq!((read.1, read.2, read.3), (written.1, written.2, written.3), "{name}");
        }
        for (read, written) in read.cameras.iter().zip(&written.cameras) {
            assert!(read.position.distance(written.position) < 1e-6, "{name}");
        }
        assert_eq!(read.lights.len(), written.lights.len(), "{name}");
    }
}

#[test]
fn a_scene_without_triangles_can_be_written() {
    let mut written = SceneBuilder::new().finish_scene("empty");
    written.lights.push(Light::point(Vec3::Y));
    for name in ["empty.glb", "empty.toml"] {
        let read = reread(&written, name);
        assert_eq!((read.geometry.mesh.triangles.len(), read.lights.len()), (0, 1), "{name}");
    }
}

#[test]
fn what_cannot_be_written_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(DVec3::ZERO);
    let message = scene.export(folder.path().join("scene.obj")).unwrap_err().to_string();
    assert!(message.contains("`.obj`") && message.contains(".toml or .glb"), "{message}");
    let message = scene.export(folder.path().join("no/such/folder/scene.glb")).unwrap_err().to_string();
    assert!(message.contains("scene.glb") && message.contains("does not exist; create it first"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn written_files_may_be_read_by_others() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    scene(DVec3::ZERO).export(&path).unwrap();
    let ordinary = folder.path().join("ordinary");
    fs::write(&ordinary, "").unwrap();
    let mode = |path: &std::path::Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&ordinary));
}

#[test]
fn textures_that_nobody_can_use_are_left_out() {
    let mut scene = scene(DVec3::ZERO);
    scene.geometry_mut().textures[0].texels.pop();
    scene.geometry_mut().textures.push(texture("unused", [2, 2]));
    let read = reread(&scene, "scene.glb");
    assert_eq!(read.geometry.textures[..], scene.geometry.textures[1..2]);
    assert_eq!(
        (read.geometry.materials[1].texture, read.geometry.materials[3].texture.map(|uses| uses.texture)),
        (None, Some(0))
    );
}
