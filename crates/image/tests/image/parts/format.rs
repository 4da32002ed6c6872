use std::path::Path;

use lightmesh_image::Format;
use lightmesh_image::internals::format::{from_signature, known, signature};

#[test]
fn extensions_name_formats() {
    assert_eq!(Format::from_path(Path::new("a/b.PNG")), Some(Format::Png));
    assert_eq!(Format::from_path(Path::new("b.jpeg")), Some(Format::Jpg));
    assert_eq!(Format::from_path(Path::new("b.tga")), None);
    assert_eq!(Format::from_path(Path::new("png")), None);
    assert!(Format::ALL.iter().all(|format| known().contains(format.extensions()[0]) == format.is_built()));
}

#[test]
fn signatures_name_formats() {
    for &format in Format::ALL {
        let mut bytes = signature(format).to_vec();
        bytes.push(0);
        assert_eq!(from_signature(&bytes), Some(format));
        assert_eq!(from_signature(&signature(format)[1..]), None);
    }
}
