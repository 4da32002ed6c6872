//! What is said where memory is short: the settings by which this image would take less, and no others.

use lightmesh_render::Setting::{self, Aa, AmbientLight, Layers, MemoryLimit, Radius, Size, Step};
use lightmesh_render::{AmbientSource, Lookup, Mode, RenderError, Settings, Unobserved};
use lightmesh_testkit::half_plane;

use crate::{prepared, renderer};

/// Whatever memory the settings leave is too little.
fn refused(settings: &Settings) -> RenderError {
    let settings = settings.clone().with_memory_limit(1);
    let refused = renderer().render_prepared(&prepared(&half_plane()), &settings, &Unobserved);
    refused.map(|_| ()).expect_err("one byte cannot suffice")
}

fn plain() -> Settings {
    Settings::default().with_size([64, 48]).with_aa(1).with_ambient_light(AmbientSource::Constant)
}

#[test]
fn only_what_helps_is_advised() {
    let lists = plain().with_lookup(Lookup::Lists);
    let cases: [(Settings, &[Setting]); 8] = [
        (lists.clone(), &[Size]),
        (lists.clone().with_aa(8), &[Size, Aa]),
        (lists.clone().with_layers(true), &[Size, Layers]),
        (lists.clone().with_ambient_light(AmbientSource::Mesh), &[Size, AmbientLight]),
        (lists.with_ambient_light(AmbientSource::Rays).with_aa(4), &[Size, AmbientLight, Aa]),
        (plain().with_lookup(Lookup::HalfBall), &[Size, Step, Radius]),
        (plain().with_mode(Mode::Area), &[Size]),
        (plain().with_mode(Mode::RayTrace).with_ambient_light(AmbientSource::Mesh), &[Size, AmbientLight]),
    ];
    for (settings, expected) in cases {
        let error = refused(&settings);
        assert_eq!(error.settings(), [&[MemoryLimit], expected].concat(), "{settings:?}");
    }
}

#[test]
fn the_message_says_so_in_words() {
    let said = |settings: &Settings| refused(settings).to_string();
    let gathered = plain().with_aa(8).with_ambient_light(AmbientSource::Mesh);
    let end = "; raise the limit, or choose a smaller image, constant ambient light or fewer samples of a pixel";
    assert!(said(&gathered).ends_with(end), "{}", said(&gathered));
    assert!(said(&plain()).ends_with("; raise the limit, or choose a smaller image"), "{}", said(&plain()));
}

#[test]
fn points_have_no_image_that_could_be_smaller() {
    let (scene, normals) = (prepared(&half_plane()), [glam::Vec3::Y]);
    let settings = plain().with_memory_limit(1);
    let refused = renderer().visibility(&scene, &[glam::Vec3::ZERO], &normals, &settings, &Unobserved);
    let Err(error) = refused else { panic!("one byte cannot suffice") };
    assert_eq!(error.settings(), [MemoryLimit]);
    assert!(error.to_string().ends_with("; raise the limit"), "{error}");
}
