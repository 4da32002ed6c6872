//! What is at the target, and beside it, whatever happens.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::{Output, Ready, TargetError, check_folder, check_writable, identity, publish, publish_record};

fn ready(path: &Path, bytes: &[u8]) -> Ready {
    Ready::with(path, bytes).unwrap()
}

fn put(path: &Path, bytes: &[u8]) {
    publish([ready(path, bytes)]).unwrap();
}

fn count(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn a_file_is_replaced_whole_and_nothing_is_left_beside() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    check_writable(&path).unwrap();
    assert!(!path.exists());
    put(&path, b"first");
    put(&path, b"2nd");
    assert_eq!((fs::read(&path).unwrap(), count(folder.path())), (b"2nd".to_vec(), 1));
}

#[test]
fn an_unfinished_or_unpublished_file_leaves_the_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    put(&path, b"first");
    Output::to(&path).unwrap().write_all(b"half of the sec").unwrap();
    drop(ready(&path, b"second"));
    assert_eq!((fs::read(&path).unwrap(), count(folder.path())), (b"first".to_vec(), 1));
}

#[test]
fn outputs_appear_together() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    let outputs = [ready(&a, b"a"), ready(&b, b"b")];
    assert!(!a.exists() && !b.exists());
    publish(outputs).unwrap();
    assert!(a.exists() && b.exists() && count(folder.path()) == 2);
}

#[test]
fn another_program_can_write_an_output_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    let output = Output::to(&path).unwrap();
    fs::write(output.temporary_path().unwrap(), "by another").unwrap();
    assert!(!path.exists());
    output.commit().unwrap();
    assert_eq!((fs::read_to_string(&path).unwrap(), count(folder.path())), ("by another".to_owned(), 1));
}

#[test]
fn a_record_is_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record");
    for text in ["a", "ab"] {
        publish_record(ready(&path, text.as_bytes())).unwrap();
        assert_eq!((fs::read_to_string(&path).unwrap(), count(folder.path())), (text.to_owned(), 1));
    }
}

#[test]
fn an_output_that_fails_says_which_are_there() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name));
    let outputs = [ready(&a, b"a"), ready(&b, b"b"), ready(&c, b"c")];
    fs::create_dir(&b).unwrap();
    let error = publish(outputs).unwrap_err();
    assert_eq!((error.path.clone(), &error.written[..]), (b, &[a.clone()][..]));
    assert!(
        error.to_string().ends_with(&format!("; of the outputs, only these were written: {}", a.display())),
        "{error}"
    );
    assert!(a.exists() && !c.exists() && count(folder.path()) == 2);
}

#[test]
fn two_outputs_of_a_run_are_two_files() {
    let folder = tempfile::tempdir().unwrap();
    let [a, same] = ["a", "./a"].map(|name| folder.path().join(name));
    let error = publish([ready(&a, b"a"), ready(&same, b"b")]).unwrap_err();
    assert!(error.to_string().contains("is the same file; nothing was written"), "{error}");
    assert_eq!(count(folder.path()), 0);
}

#[test]
fn what_is_no_file_name_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| check_writable(folder.path().join(name)).unwrap_err();
    fs::write(folder.path().join("file"), "").unwrap();
    assert!(matches!(at("."), TargetError::IsDirectory { .. }));
    assert!(matches!(at("no/a"), TargetError::NoDirectory { .. }));
    assert!(matches!(at("file/a"), TargetError::NotADirectory { .. }), "{}", at("file/a"));
    assert!(matches!(at("new/"), TargetError::NoName { .. }));
    assert!(matches!(check_writable("").unwrap_err(), TargetError::NoName { .. }));
    assert_eq!(count(folder.path()), 1);
}

#[test]
fn a_missing_folder_is_checked_without_creating_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    check_folder(folder.path()).unwrap();
    check_folder(folder.path().join("a/b")).unwrap();
    check_folder("a/b").unwrap();
    assert!(matches!(check_folder(folder.path().join("file/b")), Err(TargetError::NotADirectory { .. })));
    assert_eq!(count(folder.path()), 1);
}

#[test]
fn a_file_has_one_identity_by_whatever_path() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| identity(folder.path().join(name));
    fs::write(folder.path().join("a"), "").unwrap();
    assert_eq!(at("a"), at("./a"));
    assert_eq!(at("new"), at("./new"));
    assert_ne!(at("a"), at("new"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_in_which_nobody_may_write_is_found_before_the_work() {
    let error = check_writable("/proc/a.json").unwrap_err();
    assert!(matches!(error, TargetError::Unwritable { .. }), "{error}");
}

#[cfg(unix)]
mod unix {
    use std::io::Read;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
    use std::process::Command;
    use std::time::{Duration, SystemTime};

    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o7777
    }

    #[test]
    fn a_new_file_is_open_to_whom_new_files_are() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, usual) = (folder.path().join("ours"), folder.path().join("usual"));
        put(&ours, b"");
        fs::write(&usual, b"").unwrap();
        assert_eq!(mode(&ours), mode(&usual));
    }

    #[test]
    fn an_existing_file_keeps_its_mode_also_while_it_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for kept in [0o600, 0o640, 0o666, 0o755] {
            fs::write(&path, "").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(kept)).unwrap();
            let next = ready(&path, b"new");
            let temporary = temporaries(folder.path()).pop().unwrap();
            assert_eq!(mode(&temporary), kept);
            publish([next]).unwrap();
            assert_eq!((mode(&path), fs::read(&path).unwrap()), (kept, b"new".to_vec()));
        }
    }

    #[test]
    fn the_file_behind_links_is_replaced_or_created() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("file"), b"old").unwrap();
        symlink(at("file"), at("link")).unwrap();
        symlink("../next", at("sub/first")).unwrap();
        symlink("sub/new", at("next")).unwrap();
        assert_eq!((identity(at("link")), identity(at("sub/first"))), (identity(at("file")), identity(at("sub/new"))));
        for (link, file) in [("link", "file"), ("sub/first", "sub/new")] {
            put(&at(link), b"new");
            assert_eq!(fs::read(at(file)).unwrap(), b"new");
            assert!(fs::symlink_metadata(at(file)).unwrap().is_file());
            assert!(fs::symlink_metadata(at(link)).unwrap().is_symlink());
        }
        assert!(fs::symlink_metadata(at("next")).unwrap().is_symlink());
        symlink("round", at("round")).unwrap();
        assert!(matches!(check_writable(at("round")), Err(TargetError::Protected { .. })));
    }

    #[test]
    fn hard_links_are_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&a, "").unwrap();
        fs::hard_link(&a, &b).unwrap();
        assert_eq!(identity(&a), identity(&b));
        assert_eq!(identity("/dev/null"), None);
    }

    #[test]
    fn a_pipe_is_written_through_and_not_before_all_is_ready() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        check_writable(&pipe).unwrap(); // does not wait for a reader
        let bytes: Vec<u8> = (0..1_000_000u32).map(|index| index as u8).collect();
        let output = ready(&pipe, &bytes);
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || fs::read(pipe).unwrap())
        };
        publish([output]).unwrap();
        assert!(reader.join().unwrap() == bytes);
        assert!(!fs::metadata(&pipe).unwrap().is_file() && count(folder.path()) == 1);
    }

    #[test]
    fn a_reader_that_leaves_early_is_no_error() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let output = ready(&pipe, &vec![7; 1_000_000]);
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || fs::File::open(pipe).unwrap().read_exact(&mut [0; 10]).unwrap())
        };
        publish([output]).unwrap();
        reader.join().unwrap();
    }

    #[test]
    fn devices_are_written_through_and_a_full_one_stops_all_outputs() {
        let folder = tempfile::tempdir().unwrap();
        let device = fs::metadata("/dev/null").unwrap().ino();
        put(Path::new("/dev/null"), b"gone");
        assert_eq!(fs::metadata("/dev/null").unwrap().ino(), device);
        if cfg!(target_os = "linux") {
            let path = folder.path().join("a");
            let error = publish([ready(&path, b"a"), ready(Path::new("/dev/full"), b"b")]).unwrap_err();
            assert!(error.written.is_empty() && error.to_string().contains("; nothing was written"), "{error}");
            assert_eq!(count(folder.path()), 0);
        }
    }

    /// Temporary files in a folder.
    fn temporaries(folder: &Path) -> Vec<PathBuf> {
        let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        paths.filter(|path| path.extension().is_some_and(|ending| ending == "tmp")).collect()
    }

    #[test]
    fn what_dead_runs_left_is_removed_and_what_living_ones_write_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let living = ready(&folder.path().join("a"), b"a");
        let [name] = &temporaries(folder.path())[..] else { panic!("one temporary file") };
        let name = name.file_name().unwrap().to_str().unwrap();
        let dead = folder.path().join(format!("{}dead.tmp", &name[..name.rfind('-').unwrap() + 1]));
        let [foreign, old] = ["1-a", "1-b"].map(|id| folder.path().join(format!(".lightmesh-zzzzzzzz-{id}.tmp")));
        for path in [&dead, &foreign, &old] {
            fs::write(path, "half").unwrap();
        }
        let days = SystemTime::now() - Duration::from_secs(3 * 24 * 60 * 60);
        fs::File::options().write(true).open(&old).unwrap().set_modified(days).unwrap();
        crate::stale::remove_all_stale(folder.path());
        assert!(!dead.exists() && foreign.exists() && !old.exists());
        publish([living]).unwrap();
        assert_eq!(fs::read(folder.path().join("a")).unwrap(), b"a");
    }
}
