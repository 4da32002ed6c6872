use lightmesh_scene::CreaseAngle;

#[test]
fn a_crease_is_an_angle_between_directions() {
    for degrees in [1e-3, 30.0, 180.0] {
        assert_eq!(CreaseAngle::from_degrees(degrees).map(CreaseAngle::degrees), Some(degrees));
    }
    for degrees in [0.0, -1.0, 180.5, f64::NAN, f64::INFINITY] {
        assert_eq!(CreaseAngle::from_degrees(degrees), None, "{degrees}");
    }
}
