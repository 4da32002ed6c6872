//! A small mesh file whose lights take gigabytes, each a little, is refused: alone in its process, since the allocator counts what all tests hold.

use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use glam::{DVec3, UVec3, Vec3};
use lightmesh_memory::{Budget, Counting, held};
use lightmesh_render::internals::cache::{Content, HEADER, Places, Section, Stored, decode, write};
use lightmesh_render::{Acceleration, MeshFault, PreparedScene, Unobserved};
use lightmesh_testkit::pile;
use xxhash_rust::xxh3::xxh3_64;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const BRICKS: u64 = 1 << 13;
const LIGHTS: u32 = 1000;
const LIMIT: u64 = 32 << 20;

#[test]
fn lights_that_know_as_much_as_the_first_take_memory_nonetheless() {
    let scene = PreparedScene::new(&pile(DVec3::ZERO, &[]), &Acceleration::Bvh, &Unobserved).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.mesh");
    let places = Places { anchor: Vec3::ZERO, step: 0.25, number: UVec3::splat(7) };
    let stored = Stored { bricks: vec![], ages: vec![], columns: vec![] };
    let section = Section { geometry: scene.geometry.hash(), places, stored };
    write(&path, &scene, &Content { points: vec![section], gathered: vec![] }).unwrap();
    let whole = std::fs::read(&path).unwrap();
    assert!(decode(&whole, &scene, Budget::new(Some(held() + LIMIT))).is_ok());

    // 1. The numbers of the section: one geometry, its hash, anchor and step, places in all; then lights and bricks.
    let mut content = [&1u32.to_le_bytes()[..], &scene.geometry.hash().to_le_bytes()].concat();
    content.extend([0.0f32, 0.0, 0.0, 0.25].iter().flat_map(|number| number.to_le_bytes()));
    content.extend([7u32; 3].iter().flat_map(|number| number.to_le_bytes()));
    content.extend(LIGHTS.to_le_bytes());
    content.extend(BRICKS.to_le_bytes());
    // 2. Keys that ascend by one.
    content.push(0);
    content.resize(content.len() + BRICKS as usize - 1, 1);
    // 3. Points without samples: kind, position, spread; samples, seed; whether they know what the one before knows; a word for each brick.
    let light = |known: &[u8]| [&[0; 1 + 16 + 12][..], known, &[0; 8 * BRICKS as usize]].concat();
    content.extend(light(&[0; 1 + 8 * BRICKS as usize]));
    let lights = |content: &mut Vec<u8>| content.extend(light(&[1]).repeat(LIGHTS as usize - 1));
    lights(&mut content);
    content.push(0);
    // 4. The file: a header, the content compressed, its length, and a hash.
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&content).unwrap();
    let mut file = [&whole[..HEADER], &encoder.finish().unwrap(), &(content.len() as u64).to_le_bytes()].concat();
    file.extend(xxh3_64(&file).to_le_bytes());
    drop(content);

    assert!(file.len() < 1 << 20, "{} bytes", file.len());
    assert!(decode(&file, &scene, Budget::default()).is_ok(), "it is a right file");
    let refused = decode(&file, &scene, Budget::new(Some(held() + LIMIT))).unwrap_err();
    assert!(matches!(refused, MeshFault::Memory(_)) && !refused.is_replaceable(), "{refused}");
}
