//! Where files can be saved and where not, and what is left behind.

use std::fs;
use std::path::Path;

use crate::pictures::{coded, layered, plain, ramp};
use lightmesh_files::TargetError;
use lightmesh_image::{SaveError, check_writable};
use tempfile::tempdir;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn unknown_extensions_list_the_known_ones() {
    for name in ["a.tga", "a", "png"] {
        let error = check_writable(name).unwrap_err();
        assert!(matches!(error, SaveError::UnknownExtension { .. }), "{error}");
        assert!(error.to_string().contains("bmp, png, exr, jpg, jpeg"), "{error}");
        assert!(matches!(coded(1, 1).save(name), Err(SaveError::UnknownExtension { .. })));
        assert!(!Path::new(name).exists());
    }
}

#[test]
fn directories_are_checked() {
    let folder = tempdir().unwrap();
    let target = folder.path().join("pictures.png");
    fs::create_dir(&target).unwrap();
    assert!(matches!(check_writable(&target), Err(SaveError::Target(TargetError::IsDirectory { .. }))));

    let error = check_writable(folder.path().join("missing/a.png")).unwrap_err();
    assert!(matches!(error, SaveError::Target(TargetError::NoDirectory { .. })), "{error}");
    assert!(error.to_string().contains("missing does not exist"), "{error}");

    assert!(check_writable(folder.path().join("a.png")).is_ok());
    assert_eq!(names(folder.path()), ["pictures.png"], "the check leaves nothing");
}

/// No user, not even root, can create files in /proc.
#[cfg(target_os = "linux")]
#[test]
fn unwritable_directories_are_found() {
    let error = check_writable("/proc/a.png").unwrap_err();
    assert!(matches!(error, SaveError::Target(TargetError::Unwritable { .. })), "{error}");
    assert!(matches!(coded(1, 1).save("/proc/a.png"), Err(SaveError::Target(TargetError::Unwritable { .. }))));
}

#[test]
fn a_failed_save_leaves_the_earlier_file() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("wide.jpg");
    fs::write(&path, "earlier").unwrap();
    let error = plain(65_536, 1, [0.5; 3]).save(&path).unwrap_err();
    assert!(matches!(error, SaveError::TooLarge { limit: "65535 pixels per side", .. }), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"earlier");
    assert_eq!(names(folder.path()), ["wide.jpg"], "no temporary file is left");
}

#[test]
fn layers_need_an_exr_and_a_frame_that_has_them() {
    let folder = tempdir().unwrap();
    let error = layered(2, 2).save_layers(folder.path().join("a.png")).unwrap_err();
    assert!(matches!(error, SaveError::LayersNeedExr { .. }), "{error}");
    let error = ramp(2, 2).save_layers(folder.path().join("a.exr")).unwrap_err();
    assert!(matches!(error, SaveError::NoLayers { .. }), "{error}");
    assert!(names(folder.path()).is_empty());
}

#[cfg(unix)]
#[test]
fn saved_files_have_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;

    let folder = tempdir().unwrap();
    let (plain, picture) = (folder.path().join("plain"), folder.path().join("picture.png"));
    fs::write(&plain, "").unwrap();
    coded(2, 2).save(&picture).unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&picture), mode(&plain));
}

#[cfg(unix)]
#[test]
fn links_are_followed() {
    let folder = tempdir().unwrap();
    let (real, link) = (folder.path().join("real.png"), folder.path().join("link.png"));
    fs::write(&real, "earlier").unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    coded(2, 2).save(&link).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::read(&real).unwrap().starts_with(b"\x89PNG"));
}
