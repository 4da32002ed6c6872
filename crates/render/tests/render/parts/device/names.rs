use lightmesh_render::Device;

#[test]
fn names_of_devices_are_read_and_written() {
    for word in ["auto", "cpu", "cuda", "cuda:0", "cuda:17", "cuda:all", "cuda:0,1", "cuda:all,cpu", "cuda:2,5,cpu"] {
        assert_eq!(word.parse::<Device>().unwrap().to_string(), word);
    }
    for (word, same) in [("cuda:1,0", "cuda:0,1"), ("cuda:0,cuda:1", "cuda:0,1"), ("cpu,cuda:all", "cuda:all,cpu")] {
        assert_eq!(word.parse::<Device>().unwrap().to_string(), same);
    }
    let wrong = [
        "",
        "gpu",
        "cuda:",
        "cuda:x",
        "cuda:-1",
        "cuda:0,0",
        "cuda:all,0",
        "0,1",
        "cpu,1",
        "cpu,cpu",
        "cuda:64,1",
        "cuda:0,",
        "auto,cpu",
    ];
    for word in wrong {
        assert!(word.parse::<Device>().is_err(), "{word}");
    }
}
