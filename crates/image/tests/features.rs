//! Formats that are not built into the crate are rejected by name, before anything is written.

use lightmesh_image::{DecodeError, Format, Frame, LoadError, SaveError, check_size, check_writable};

const SIGNATURES: [(Format, &[u8]); 4] = [
    (Format::Bmp, b"BM"),
    (Format::Png, b"\x89PNG\r\n\x1a\n"),
    (Format::Exr, b"\x76\x2f\x31\x01"),
    (Format::Jpg, b"\xff\xd8\xff"),
];

#[test]
fn a_format_is_built_or_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let frame = Frame::new(3, 2, vec![[0.5; 3]; 6]).unwrap();
    for (format, signature) in SIGNATURES {
        let path = folder.path().join(format!("image.{format}"));
        if format.is_built() {
            check_writable(&path).unwrap();
            frame.save(&path).unwrap();
            assert_eq!(Frame::load(&path).unwrap().width(), 3);
            continue;
        }
        for error in [check_writable(&path), check_size(&path, 3, 2), frame.save(&path)].map(Result::unwrap_err) {
            assert!(matches!(error, SaveError::NotBuilt { format: named, .. } if named == format), "{error}");
            let feature = format!("with the feature {}", format.feature());
            assert!(error.to_string().contains(&feature), "{error}");
        }
        assert!(!path.exists());
        std::fs::write(&path, signature).unwrap();
        let error = Frame::load(&path).unwrap_err();
        let named = LoadError::Decode { path, reason: DecodeError::NotBuilt { format } };
        assert_eq!(error.to_string(), named.to_string());
    }
}
