use lightmesh_render::Device;

#[test]
fn names_of_devices_are_read_and_written() {
    for word in ["auto", "cpu", "cuda", "cuda:0", "cuda:17"] {
        assert_eq!(word.parse::<Device>().unwrap().to_string(), word);
    }
    for word in ["", "gpu", "cuda:", "cuda:x", "cuda:-1"] {
        assert!(word.parse::<Device>().is_err(), "{word}");
    }
}
