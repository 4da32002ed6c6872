use lightmesh_render::Acceleration;

#[test]
fn structures_are_read_and_written_with_what_belongs_to_them() {
    let more =
        [Acceleration::Grid(Some([3, 4, 5])), Acceleration::GridFile("a:b.grid".into()), Acceleration::BruteForce];
    for structure in Acceleration::ALL.iter().chain(&more) {
        assert_eq!(structure.to_string().parse().as_ref(), Ok(structure));
    }
    for text in ["", "grid:", "grid:3x4", "grid:0x1x1", "grid-file:", "octree", "bvh:2"] {
        assert!(text.parse::<Acceleration>().is_err(), "{text}");
    }
}
