use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::bufread::DeflateDecoder;
use flate2::write::DeflateEncoder;
use glam::{DVec3, UVec3, Vec3};
use lightmesh_memory::Budget;
use lightmesh_render::internals::cache::{
    ColumnKey, Content, HEADER, MAGIC, Places, SavedGathered, Section, Stored, StoredAnswers, StoredColumn, TRAILER,
    decode, load, write,
};
use lightmesh_render::internals::irradiance_cache::{SavedCells, SavedLight, SavedNode, SavedPlace, SavedRecord};
use lightmesh_render::{Acceleration, MeshCache, MeshFault, MeshSaveError, PreparedScene, Unobserved};
use lightmesh_scene::LightKind;
use lightmesh_testkit::pile;
use xxhash_rust::xxh3::xxh3_64;

const LAMP: LightKind = LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.3 };

fn scene(at: f64) -> PreparedScene {
    PreparedScene::new(&pile(DVec3::splat(at), &[LAMP]), &Acceleration::Bvh, &Unobserved).unwrap()
}

/// One light of each kind, with and without samples, and a glowing ball; bricks near and far from each other.
fn section(scene: &PreparedScene) -> Section {
    let at = Vec3::new(0.25, -3.0, 1e-7);
    let kinds = [
        LightKind::Point { position: at, spread: 0.5 },
        LightKind::Directional { direction: Vec3::NEG_Y, angle: 0.01 },
        LightKind::Spot { position: at, direction: Vec3::X, inner: 0.1, outer: 0.2, radius: 0.0 },
        LAMP,
        LightKind::Spot { position: at, direction: Vec3::X, inner: 0.1, outer: 0.2, radius: 0.5 },
        LightKind::Disk { position: at, normal: Vec3::Z, radius: 2.0 },
        LightKind::Rectangle { position: at, half_u: Vec3::X, half_v: Vec3::Y },
        LAMP,
    ];
    let bricks = vec![0, 1, 5, 1 << 20, (1 << 57) - 1];
    let known = [1, u64::MAX, 0b1010, 0, 1 << 63];
    let other = [u64::MAX, 1, 0b1010, 0, 1 << 63];
    let column = |(index, kind): (usize, LightKind)| {
        let sampling = [None, Some((4, 7)), Some((999, u64::MAX))][index % 3];
        let answers = match sampling {
            None => StoredAnswers::Bits(vec![1, 0xff00, 0b1000, 0, 0]),
            Some((samples, _)) => StoredAnswers::Shares((0..68).map(|share| (share % (samples + 1)) as u16).collect()),
        };
        let known = if index == 1 { other } else { known };
        StoredColumn { seen: ColumnKey { kind, glows: index == 7, sampling }, known: known.into(), answers }
    };
    let columns = kinds.into_iter().enumerate().map(column).collect();
    let places = Places { anchor: Vec3::new(0.1, 0.2, 0.3), step: 0.25, number: UVec3::new(7, 2_097_151, 0) };
    Section { geometry: scene.geometry.hash(), places, stored: Stored { bricks, ages: vec![0; 5], columns } }
}

/// Cells with one record and with several, some of which have a value.
fn gathered(scene: &PreparedScene) -> SavedGathered {
    let place = [[1.0, -2.5, 1e-7], [1.0, -2.4, 0.0], [0.0, 1.0, 0.0]];
    let record = |(kind, has_value)| SavedRecord { kind, has_value, place };
    let cells = vec![(0, 1), (5 << 51, 3), ((127 << 51) - 1, 2)];
    let records: Vec<SavedRecord> =
        [(0, true), (1, false), (7, true), (11, false), (2, false), (3, true)].map(record).into();
    let node = |(name, known, place): (u64, u8, SavedPlace)| {
        let mut values = [[0.0; 3]; 12];
        let is_known = usize::from(known) * usize::from(place != SavedPlace::default());
        (1..).zip(&mut values[..is_known]).for_each(|(number, value)| *value = [number as f32; 3]);
        SavedNode { name, place, covered: name != 3, known, values }
    };
    let light = SavedLight {
        fine: SavedCells { cells: cells.clone(), records: records.clone(), values: vec![words(1); 3] },
        coarse: SavedCells { cells: cells[..1].into(), records: records[..1].into(), values: vec![words(2)] },
        nodes: [(3, 1, place), (4 << 55, 12, Default::default()), ((127 << 57) - 1, 12, place)].map(node).into(),
    };
    SavedGathered { geometry: scene.geometry.hash(), sources: 0x1234_5678_9abc_def0, light }
}

/// A value whose words are all different.
fn words<V: bytemuck::Pod>(first: u32) -> V {
    let mut value = V::zeroed();
    let words: &mut [u32] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut value));
    (first..).zip(words).for_each(|(number, word)| *word = number.wrapping_mul(0x0101_0107));
    value
}

fn all(scene: &PreparedScene) -> Content {
    Content { points: vec![section(scene)], gathered: vec![gathered(scene)] }
}

/// A saved mesh as bytes, and a folder to change it in.
fn saved(scene: &PreparedScene) -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.mesh");
    let bytes = write(&path, scene, &all(scene)).unwrap();
    let content = std::fs::read(&path).unwrap();
    assert_eq!(content.len() as u64, bytes);
    (folder, path, content)
}

fn fault(scene: &PreparedScene, path: &Path, bytes: &[u8]) -> MeshFault {
    std::fs::write(path, bytes).unwrap();
    load(path, scene, Budget::default()).unwrap_err().fault
}

fn decoded(bytes: &[u8], scene: &PreparedScene) -> Result<Content, MeshFault> {
    decode(bytes, scene, Budget::default())
}

/// A file with other content, and a hash and a length that are right.
fn with_content(file: &[u8], content: &[u8]) -> Vec<u8> {
    with_packed(file, &packed(content), content.len())
}

fn with_packed(file: &[u8], packed: &[u8], length: usize) -> Vec<u8> {
    let mut bytes = [&file[..HEADER], packed, &(length as u64).to_le_bytes()].concat();
    bytes.extend(xxh3_64(&bytes).to_le_bytes());
    bytes
}

fn packed(content: &[u8]) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

fn content(file: &[u8]) -> Vec<u8> {
    let mut content = Vec::new();
    DeflateDecoder::new(&file[HEADER..file.len() - TRAILER]).read_to_end(&mut content).unwrap();
    content
}

#[test]
fn what_is_loaded_is_what_was_saved() {
    let scene = scene(0.0);
    let (folder, path, bytes) = saved(&scene);
    assert_eq!(load(&path, &scene, Budget::default()).unwrap(), all(&scene));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left next to it");
    let cache = MeshCache::load(&path, &scene, Budget::default()).unwrap();
    assert_eq!((cache.len(), cache.records_read()), (8 * 68, 4));
    // What was not asked for stays.
    let again = cache.save(&path, &scene).unwrap().unwrap();
    assert_eq!((again.values, again.records, again.bytes), (8 * 68, 4, bytes.len() as u64));
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    // Each without the other.
    let light = Content { gathered: vec![gathered(&scene)], ..Content::default() };
    write(&path, &scene, &light).unwrap();
    assert_eq!(load(&path, &scene, Budget::default()).unwrap(), light);
    let cache = MeshCache::load(&path, &scene, Budget::default()).unwrap();
    assert!(!cache.is_empty() && cache.memory() > 2000);
    assert_eq!(cache.len(), 0);
    assert_eq!(cache.save(&path, &scene).unwrap().map(|saved| (saved.values, saved.records)), Some((0, 4)));
    let points = Content { points: vec![section(&scene)], ..Content::default() };
    write(&path, &scene, &points).unwrap();
    assert_eq!(load(&path, &scene, Budget::default()).unwrap(), points);
    assert_eq!(MeshCache::new().save(folder.path().join("none"), &scene).unwrap(), None);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is known, nothing is written");
}

#[test]
fn every_changed_byte_is_noticed() {
    let scene = scene(0.0);
    let (_folder, _, bytes) = saved(&scene);
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        assert!(decoded(&changed, &scene).is_err(), "byte {at}");
    }
}

#[test]
fn cut_off_and_longer_files_are_refused() {
    let scene = scene(0.0);
    let (_folder, path, bytes) = saved(&scene);
    for length in 0..bytes.len() {
        // Files are slow: most are given as bytes.
        let fault = match length {
            0..64 => fault(&scene, &path, &bytes[..length]),
            _ => decoded(&bytes[..length], &scene).unwrap_err(),
        };
        // What begins as something else may be something else.
        assert_eq!(fault.is_replaceable(), length >= MAGIC.len(), "{length} bytes: {fault}");
    }
    assert!(matches!(fault(&scene, &path, &[&bytes[..], &[0]].concat()), MeshFault::Damaged(_)));
}

#[test]
fn each_fault_has_its_name() {
    let scene = scene(0.0);
    let (folder, path, bytes) = saved(&scene);
    let other = fault(&scene, &path, b"P6 640 480 255");
    assert!(matches!(other, MeshFault::NotAMesh) && !other.is_replaceable());
    for found in [1, 2, 3, 5] {
        let mut other = bytes.clone();
        other[8] = found;
        let fault = fault(&scene, &path, &other);
        assert!(matches!(fault, MeshFault::Version { found: version } if version == u32::from(found)), "{fault}");
    }
    std::fs::write(&path, &bytes).unwrap();
    let moved = self::scene(0.5);
    let error = load(&path, &moved, Budget::default()).unwrap_err();
    let triangles = scene.geometry.triangles.stored().len();
    match error.fault {
        MeshFault::OtherGeometry { found, expected } => assert_eq!((found as usize, expected), (triangles, triangles)),
        ref other => panic!("{other}"),
    }
    let message = error.to_string();
    assert!(message.contains("scene.mesh") && message.contains("save the mesh again"), "{message}");
    let error = load(folder.path(), &scene, Budget::default()).unwrap_err();
    assert!(error.to_string().contains("not a regular file") && !error.fault.is_replaceable(), "{error}");
    assert!(matches!(write(&path.join("below"), &scene, &Content::default()).unwrap_err(), MeshSaveError::Target(_)));
}

/// A hash is easy to forge: what follows it must be harmless.
#[test]
fn forged_content_is_refused_or_harmless() {
    let scene = scene(0.0);
    let (_folder, _, bytes) = saved(&scene);
    let content = content(&bytes);
    assert_eq!(decoded(&with_content(&bytes, &content), &scene).unwrap(), all(&scene));
    let mut refused = 0;
    for at in 0..content.len() {
        for value in [0, 1, 0x7f, 0x80, 0xff] {
            let mut forged = content.clone();
            forged[at] = value;
            refused += u32::from(decoded(&with_content(&bytes, &forged), &scene).is_err());
        }
        assert!(decoded(&with_content(&bytes, &content[..at]), &scene).is_err(), "{at} bytes");
    }
    assert!(refused > 100, "{refused}");
    assert!(decoded(&with_content(&bytes, &[&content[..], &[0]].concat()), &scene).is_err());
    // Nothing follows what is compressed, and it has an end.
    let packed = packed(&content);
    assert!(decoded(&with_packed(&bytes, &packed, content.len()), &scene).is_ok());
    assert!(decoded(&with_packed(&bytes, &[&packed[..], &[0]].concat(), content.len()), &scene).is_err());
    for length in 0..packed.len() {
        assert!(decoded(&with_packed(&bytes, &packed[..length], content.len()), &scene).is_err(), "{length} bytes");
    }
}

/// Where the first light's known values begin in the content of [`all`]: after five bricks, and a point's kind, numbers and samples.
const KNOWN: usize = 52 + 1 + 1 + 1 + 3 + 9 + 17 + 12;

#[test]
fn lights_share_what_is_known_of_their_places() {
    let scene = scene(0.0);
    let (_folder, _, bytes) = saved(&scene);
    let content = content(&bytes);
    assert_eq!(content[KNOWN], 0);
    assert_eq!(content[KNOWN + 1..][..8], 1u64.to_le_bytes());
    let mut first = content;
    first[KNOWN] = 1;
    match decoded(&with_content(&bytes, &first), &scene) {
        Err(MeshFault::Damaged(why)) => assert!(why.contains("of no light"), "{why}"),
        other => panic!("{other:?}"),
    }
}

/// Lights that take memory one by one are in `tests/mesh_bomb.rs`.
#[test]
fn sizes_beyond_the_content_allocate_nothing() {
    let scene = scene(0.0);
    let (_folder, path, bytes) = saved(&scene);
    // The number of bricks.
    let mut forged = content(&bytes);
    forged[44..52].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(matches!(fault(&scene, &path, &with_content(&bytes, &forged)), MeshFault::Damaged(_)));
    // A bomb: gigabytes of bricks in a small file.
    let mut bomb = content(&bytes)[..52].to_vec();
    bomb[44..52].copy_from_slice(&(1u64 << 26).to_le_bytes());
    bomb.resize(64 << 20, 1);
    assert_too_large(&with_content(&bytes, &bomb), &scene);
}

/// Decodes a small file with much in it.
fn assert_too_large(bomb: &[u8], scene: &PreparedScene) {
    assert!(bomb.len() < 1 << 20, "{} bytes", bomb.len());
    let found = || {
        let limit = lightmesh_memory::held() + (32 << 20);
        decode(bomb, scene, Budget::new(Some(limit))).unwrap_err()
    };
    // What other tests free meanwhile leaves more: then it is found to be damaged, or to end early.
    let is_refused = |found: &MeshFault| matches!(found, MeshFault::Memory(_)) && !found.is_replaceable();
    let found: Vec<MeshFault> = (0..8).map(|_| found()).take_while(|found| !is_refused(found)).collect();
    assert!(found.len() < 8, "{}", found[0]);
}

/// The content of a file with nothing but this of gathered light.
fn of_gathered(rest: &[&[u8]]) -> Vec<u8> {
    [&[0, 0, 0, 0, 1][..], &7u64.to_le_bytes(), &rest.concat()].concat()
}

#[test]
fn gathered_light_that_cannot_be_is_refused() {
    let scene = scene(0.0);
    let (_folder, _, file) = saved(&scene);
    let number = |count: u64| count.to_le_bytes();
    let refused = |rest: &[&[u8]]| match decoded(&with_content(&file, &of_gathered(rest)), &scene) {
        Err(MeshFault::Damaged(why)) => why,
        other => panic!("{other:?}"),
    };
    let none = number(0);
    assert!(decoded(&with_content(&file, &of_gathered(&[&none, &none, &none])), &scene).is_ok());
    assert!(refused(&[&number(u64::MAX)]).contains("more cells than there can be"));
    assert!(refused(&[&none, &none, &number(1 << 40)]).contains("more cells than there can be"));
    assert!(refused(&[&number(2), &[9, 1, 0, 1]]).contains("not in order"));
    for beyond in [&[0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x08, 1][..], &[0xff; 12]] {
        assert!(refused(&[&number(1), beyond]).contains("not in order"));
    }
    assert!(refused(&[&number(1), &[9, 0]]).contains("more than it can have"));
    assert!(refused(&[&number(1), &[9, 13]]).contains("more than it can have"));
    assert!(refused(&[&none, &none, &number(1), &[9, 13]]).contains("more than it can have"));
    assert!(refused(&[&number(1), &[9, 1], &[12]]).contains("of no kind"));
    assert!(refused(&[&number(1), &[9, 1], &[0x20]]).contains("of no kind"));
    for place in [[f32::NAN; 9], [0.0; 9], [1.0; 9]] {
        assert!(refused(&[&number(1), &[9, 1], &[0], bytemuck::cast_slice(&place)]).contains("nowhere"));
    }
    assert!(decoded(&with_content(&file, &[0, 0, 0, 0, 2]), &scene).is_err());
}

#[test]
fn gathered_light_takes_no_more_memory_than_there_is() {
    let scene = scene(0.0);
    let (_folder, _, file) = saved(&scene);
    // Many cells; many records; many nodes.
    let cells = [&(1u64 << 26).to_le_bytes()[..], &[1; 64 << 20]].concat();
    assert_too_large(&with_content(&file, &of_gathered(&[&cells])), &scene);
    let many = 1u64 << 20;
    let place: Vec<u8> =
        [0f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0].iter().flat_map(|axis| axis.to_le_bytes()).collect();
    let cells = [&many.to_le_bytes()[..], &[1; 2 << 20], &[0; 1 << 20], &place.repeat(1 << 20)].concat();
    assert_too_large(&with_content(&file, &of_gathered(&[&cells])), &scene);
    let none = 0u64.to_le_bytes();
    let nodes = [&many.to_le_bytes()[..], &[1; 2 << 20], &[0; 64 << 20]].concat();
    assert_too_large(&with_content(&file, &of_gathered(&[&none, &none, &nodes])), &scene);
}
