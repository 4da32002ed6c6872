use std::fmt::Debug;

use glam::{Affine2, Vec3};
use lightmesh_render::internals::irradiance_cache::Identity;
use lightmesh_scene::{
    Dielectric, Facets, Falloff, Light, LightKind, Material, NormalMap, Opacity, OpacityChannel, OpacityMode,
    TextureUse, Wrap,
};

fn light() -> Light {
    let kind = LightKind::Spot { position: Vec3::X, direction: Vec3::NEG_Y, inner: 0.2, outer: 0.3, radius: 0.1 };
    let mut light = Light::new(kind);
    light.intensity = Vec3::new(3.0, 2.0, 1.0);
    light.falloff = Falloff::InverseSquare;
    light.surface = Some(Vec3::Y);
    light
}

fn texture_use() -> TextureUse {
    TextureUse { texture: 3, wrap: [Wrap::Mirror, Wrap::Clamp], transform: Affine2::from_angle(0.5) }
}

/// With all that a material may have.
fn material() -> Material {
    let mut opacity = Opacity::default();
    opacity.texture = Some(texture_use());
    opacity.channel = OpacityChannel::Luminance;
    opacity.mode = OpacityMode::Blend { filter: Vec3::new(0.1, 0.2, 0.3) };
    let mut material = Material::matt([0.5, 0.25, 0.125]);
    material.facets = Some(Facets::new(0.5));
    material.texture = Some(texture_use());
    material.normal_texture = Some(NormalMap::new(texture_use()));
    material.opacity = Some(opacity);
    material.dielectric = Some(Dielectric::new(1.5));
    material
}

fn identity(add: impl Fn(&mut Identity)) -> u64 {
    let mut identity = Identity::default();
    add(&mut identity);
    identity.digest()
}

/// The names of a value's own fields, as it is shown for people.
fn fields(value: &impl Debug) -> Vec<String> {
    let text = format!("{value:?}");
    let (mut depth, mut names, mut word) = (0, Vec::new(), String::new());
    for letter in text.chars() {
        match letter {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' => depth -= 1,
            ':' if depth == 1 => names.push(std::mem::take(&mut word)),
            _ if letter.is_alphanumeric() || letter == '_' => word.push(letter),
            _ => word.clear(),
        }
        if matches!(letter, '{' | '(' | '[' | '}' | ')' | ']') {
            word.clear();
        }
    }
    names
}

/// Files have it: these values change with [`Identity`]'s form alone, or with what it is made from.
#[test]
fn the_form_is_what_it_was() {
    let found = [
        identity(|_| ()),
        identity(|all| all.light(&light())),
        identity(|all| all.material(&Material::default())),
        identity(|all| all.material(&material())),
    ];
    assert_eq!(found, [3439722301264460078, 7062363012736931838, 6981007650040881228, 9055053703791436083]);
}

/// A field more must be added to the identity, with another form, or left out there on purpose; then its name belongs here.
#[test]
fn all_fields_are_known() {
    let expect = |value: Vec<String>, names: &str| assert_eq!(value.join(" "), names);
    expect(fields(&light()), "name kind intensity falloff surface lamp visible motion");
    expect(
        fields(&material()),
        "name ka kd ks ks_tinted shininess facets emission emission_tinted texture emission_texture normal_texture \
         metallic_roughness_texture catcher lamp one_sided opacity dielectric",
    );
    expect(fields(&material().facets.unwrap()), "roughness metallic grazing");
    expect(fields(&material().opacity.unwrap()), "texture channel factor mode");
    expect(fields(&material().dielectric.unwrap()), "ior thin absorption");
}

#[test]
fn every_part_of_a_light_and_a_material_counts_but_their_names() {
    let changes: [fn(&mut Light); 6] = [
        |light| light.kind = LightKind::Sphere { position: Vec3::X, radius: 0.1 },
        |light| light.intensity.y = 2.5,
        |light| light.falloff = Falloff::None,
        |light| light.surface = None,
        |light| light.lamp = true,
        |light| light.visible = !light.visible,
    ];
    let of = |light: &Light| identity(|all| all.light(light));
    for (number, change) in changes.into_iter().enumerate() {
        let mut changed = light();
        change(&mut changed);
        assert_ne!(of(&changed), of(&light()), "{number}");
    }
    assert_eq!(of(&light().named("other")), of(&light()));

    let changes: [fn(&mut Material); 17] = [
        |material| material.ka.x = 0.0,
        |material| material.kd.x = 0.0,
        |material| material.ks.x = 0.5,
        |material| material.ks_tinted.x = 0.5,
        |material| material.shininess = 21.0,
        |material| material.facets = None,
        |material| material.emission.x = 1.0,
        |material| material.emission_tinted.x = 1.0,
        |material| material.texture = None,
        |material| material.emission_texture = Some(texture_use()),
        |material| material.normal_texture = None,
        |material| material.metallic_roughness_texture = Some(texture_use()),
        |material| material.catcher = true,
        |material| material.lamp = true,
        |material| material.one_sided = true,
        |material| material.opacity = None,
        |material| material.dielectric = None,
    ];
    let of = |material: &Material| identity(|all| all.material(material));
    for (number, change) in changes.into_iter().enumerate() {
        let mut changed = material();
        change(&mut changed);
        assert_ne!(of(&changed), of(&material()), "{number}");
    }
    assert_eq!(of(&material().named("other")), of(&material()));
}
