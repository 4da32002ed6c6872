use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3, Vec3};
use lightmesh_scene::OwnedPositions;
use lightmesh_scene::internals::animation::{
    Hold, Influences, Interpolation, Kind, Morph, Shape, Skin, Target, Track, cofactors,
};
use lightmesh_scene::internals::builder::normal_placement;

fn shape(morph: Option<Morph>) -> Shape {
    Shape { positions: OwnedPositions::Single(vec![Vec3::X, Vec3::Y]), normals: vec![Vec3::X, Vec3::Z], morph }
}

#[test]
fn morph_targets_are_added_by_their_weights() {
    let target = |by: Vec3| Target { positions: vec![by; 2], normals: Vec::new() };
    let keys = Track::new(Kind::Numbers(2), vec![0.0, 1.0], vec![0.0, 1.0, 2.0, 0.0], Interpolation::Linear);
    let morph = Morph {
        targets: vec![target(Vec3::X), target(Vec3::Z)],
        rest: vec![0.5, 0.0],
        weights: Some(Arc::new(keys.unwrap())),
    };
    let (shape, hold) = (shape(Some(morph)), Hold::Node(0, DMat4::IDENTITY));
    let first = |time| shape.posed(&hold, &[DMat4::IDENTITY], time).0[0];
    assert_eq!(first(None), DVec3::new(1.5, 0.0, 0.0));
    assert_eq!([first(Some(0.0)), first(Some(0.5))], [DVec3::new(1.0, 0.0, 1.0), DVec3::new(2.0, 0.0, 0.5)]);
}

#[test]
fn a_skin_bends_by_its_joints() {
    let skin = Skin { joints: vec![0, 1], inverse_bind: vec![DMat4::IDENTITY; 2] };
    let influences = Influences { per_vertex: 2, joints: vec![0, 1, 1, 0], weights: vec![1.0, 1.0, 3.0, 0.0] };
    let hold = Hold::Skin(Arc::new(skin), Arc::new(influences));
    let places = [DMat4::IDENTITY, DMat4::from_rotation_z(FRAC_PI_2)];
    let (positions, normals) = shape(None).posed(&hold, &places, None);
    // Half of each; a quarter turn alone, by weights that are normalised.
    assert!((positions[0] - DVec3::new(0.5, 0.5, 0.0)).length() < 1e-12, "{positions:?}");
    assert!((positions[1] + DVec3::X).length() < 1e-12 && (normals[1] - Vec3::Z).length() < 1e-6);
}

#[test]
fn normals_stay_at_right_angles_to_their_surface() {
    let squeezed = DMat4::from_scale(DVec3::new(1.0, 0.25, -1.0));
    let by_cofactors = cofactors(&DMat3::from_mat4(squeezed)) * DVec3::new(1.0, 1.0, 1.0);
    let by_inverse = normal_placement(&squeezed)(Vec3::ONE.normalize());
    assert!((by_cofactors.normalize().as_vec3() - by_inverse).length() < 1e-6, "{by_inverse}");
}
