use lightmesh_scene::internals::formats::gltf::{Uri, decode};

#[test]
fn names_of_files_are_decoded() {
    assert_eq!(Uri::new("my%20model.bin"), Uri::File("my model.bin".into()));
    assert_eq!(Uri::new("b%C3%BCro.bin"), Uri::File("büro.bin".into()));
    assert_eq!(Uri::new("ü"), Uri::File("ü".into()));
    assert_eq!(Uri::new("100%.bin"), Uri::File("100%.bin".into()));
}

#[test]
fn data_is_decoded_in_all_its_spellings() {
    let bytes = |uri: &str| match Uri::new(uri) {
        Uri::Data(data) => decode(data),
        Uri::File(name) => panic!("{name}"),
    };
    for uri in [
        "data:application/octet-stream;base64,AQL/",
        "data:;base64,AQL/",
        "DATA:image/png;name=a;BASE64,AQL/",
        "data:;base64,AQ\r\nL/",
        "data:;base64,AQL%2F",
        "data:,%01%02%FF",
    ] {
        assert_eq!(bytes(uri).as_deref(), Some(&[1, 2, 255][..]), "{uri}");
    }
    assert_eq!(bytes("data:;base64,AQ").as_deref(), Some(&[1][..]));
    assert_eq!(bytes("data:;base64,AQ==").as_deref(), Some(&[1][..]));
    assert_eq!(bytes("data:;base64,").as_deref(), Some(&[][..]));
    assert_eq!([bytes("data:"), bytes("data:;base64"), bytes("data:;base64,*")], [None, None, None]);
}
