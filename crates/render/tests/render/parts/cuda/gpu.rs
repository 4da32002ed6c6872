use lightmesh_render::internals::cuda::Version;

#[test]
fn the_driver_tells_its_version_as_a_number() {
    assert_eq!(Version::from_code(12040).to_string(), "12.4");
    assert_eq!(Version::from_code(11080).to_string(), "11.8");
    assert!(Version::from_code(9020) < Version::from_code(12000));
    assert_eq!(Version::from_code(-1), Version { major: 0, minor: 0 });
}
