//! Loading speed of scene files in megabytes per second, and peak memory as a multiple of the file size.
//!
//! `cargo bench -p lightmesh --bench load [-- MEGABYTES] [RUNS]`: creates one file of each kind in a temporary folder, of 100 MB
//! by default, and reads each in a separate process on one thread, from the system's cache; the median of the runs is printed.
//! The mesh is a rolling landscape with as many digits as modellers write. Peak memory is `VmHWM` of that process, so it is only
//! known on Linux.
#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::{fmt::Write as _, fs, path::Path, process::Command, time::Instant};

use lightmesh::Scene;

/// The argument with which this program reads one file and prints its cost.
const READ: &str = "--read";

const MEGABYTE: f64 = 1e6;

/// A kind of file: its name, its extension, and its writer for an approximate size.
struct Kind {
    name: &'static str,
    ending: &'static str,
    encode: fn(&Landscape) -> Vec<u8>,
    /// Bytes per vertex with its two triangles, to estimate the size of the grid.
    bytes_per_vertex: usize,
}

/// All rows of the table: each format has its rows here and its writer below.
const KINDS: [Kind; 6] = [
    Kind { name: "obj, positions only", ending: "obj", encode: obj_plain, bytes_per_vertex: 80 },
    Kind { name: "obj, v/vt/vn", ending: "obj", encode: obj_full, bytes_per_vertex: 190 },
    Kind { name: "ply, binary", ending: "ply", encode: ply, bytes_per_vertex: 38 },
    Kind { name: "stl, binary", ending: "stl", encode: stl, bytes_per_vertex: 100 },
    Kind { name: "glb, positions only", ending: "glb", encode: glb_plain, bytes_per_vertex: 36 },
    Kind { name: "glb, with normals and uvs", ending: "glb", encode: glb_full, bytes_per_vertex: 56 },
];

/// A square grid of vertices with heights.
struct Landscape {
    edge: usize,
}

impl Landscape {
    /// With about this many vertices.
    fn of(vertices: usize) -> Landscape {
        Landscape { edge: (vertices as f64).sqrt().ceil().max(2.0) as usize }
    }

    fn vertices(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.edge * self.edge).map(|index| {
            let [x, z] = [index % self.edge, index / self.edge].map(|cell| 0.0713 * cell as f64 - 17.0);
            [x, 2.0 * (0.7 * x).sin() + (0.9 * z).cos(), z]
        })
    }

    fn normals(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.vertices().map(|[x, _, z]| {
            let [a, b] = [-1.4 * (0.7 * x).cos(), 0.9 * (0.9 * z).sin()];
            let length = (a * a + b * b + 1.0).sqrt();
            [a / length, 1.0 / length, b / length]
        })
    }

    fn uvs(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.vertices().map(|[x, _, z]| [x / 40.0 + 0.5, z / 40.0 + 0.5])
    }

    fn triangles(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let cells = self.edge - 1;
        (0..cells * cells).flat_map(move |cell| {
            let a = cell / cells * self.edge + cell % cells;
            let [b, c, d] = [a + 1, a + self.edge, a + self.edge + 1];
            [[a, c, b], [b, c, d]]
        })
    }
}

fn obj_positions(landscape: &Landscape) -> String {
    let mut text = String::from("# a landscape\no ground\n");
    for [x, y, z] in landscape.vertices() {
        writeln!(text, "v {x:.6} {y:.6} {z:.6}").expect("writing to memory does not fail");
    }
    text
}

fn obj_plain(landscape: &Landscape) -> Vec<u8> {
    let mut text = obj_positions(landscape);
    for corners in landscape.triangles() {
        let [a, b, c] = corners.map(|corner| corner + 1);
        writeln!(text, "f {a} {b} {c}").expect("writing to memory does not fail");
    }
    text.into_bytes()
}

fn obj_full(landscape: &Landscape) -> Vec<u8> {
    let mut text = obj_positions(landscape);
    for [u, v] in landscape.uvs() {
        writeln!(text, "vt {u:.6} {v:.6}").expect("writing to memory does not fail");
    }
    for [x, y, z] in landscape.normals() {
        writeln!(text, "vn {x:.4} {y:.4} {z:.4}").expect("writing to memory does not fail");
    }
    for corners in landscape.triangles() {
        let [a, b, c] = corners.map(|corner| corner + 1);
        writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").expect("writing to memory does not fail");
    }
    text.into_bytes()
}

fn glb_plain(landscape: &Landscape) -> Vec<u8> {
    glb(landscape, &[("POSITION", "VEC3", landscape.vertices().flat_map(floats).collect())])
}

fn glb_full(landscape: &Landscape) -> Vec<u8> {
    let attributes = [
        ("POSITION", "VEC3", landscape.vertices().flat_map(floats).collect()),
        ("NORMAL", "VEC3", landscape.normals().flat_map(floats).collect()),
        ("TEXCOORD_0", "VEC2", landscape.uvs().flat_map(floats).collect()),
    ];
    glb(landscape, &attributes)
}

/// One primitive with these attributes, by name, type and bytes, and 32-bit indices.
fn glb(landscape: &Landscape, attributes: &[(&str, &str, Vec<u8>)]) -> Vec<u8> {
    let count = landscape.edge * landscape.edge;
    let indices: Vec<u8> = landscape.triangles().flatten().flat_map(|corner| (corner as u32).to_le_bytes()).collect();
    let (mut views, mut accessors, mut names) = (Vec::new(), Vec::new(), Vec::new());
    let mut bin = Vec::new();
    for (index, (name, kind, bytes)) in attributes.iter().enumerate() {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bin.len(), bytes.len()));
        accessors.push(format!(r#"{{"bufferView":{index},"componentType":5126,"count":{count},"type":"{kind}"}}"#));
        names.push(format!(r#""{name}":{index}"#));
        bin.extend(bytes);
    }
    views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bin.len(), indices.len()));
    let (view, corners) = (attributes.len(), indices.len() / size_of::<u32>());
    accessors.push(format!(r#"{{"bufferView":{view},"componentType":5125,"count":{corners},"type":"SCALAR"}}"#));
    bin.extend(indices);
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{{}}},"indices":{view}}}]}}],"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
        names.join(","),
        accessors.join(","),
        views.join(","),
        bin.len(),
    );
    json.extend(std::iter::repeat_n(' ', json.len().next_multiple_of(4) - json.len()));
    let mut file = b"glTF".to_vec();
    for word in [2, 28 + json.len() + bin.len(), json.len()] {
        file.extend((word as u32).to_le_bytes());
    }
    file.extend([b"JSON".as_slice(), json.as_bytes()].concat());
    file.extend((bin.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(bin);
    file
}

fn ply(landscape: &Landscape) -> Vec<u8> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        landscape.vertices().count(),
        landscape.triangles().count()
    );
    let mut bytes = header.into_bytes();
    bytes.extend(landscape.vertices().flat_map(floats));
    for corners in landscape.triangles() {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|&corner| (corner as u32).to_le_bytes()));
    }
    bytes
}

fn stl(landscape: &Landscape) -> Vec<u8> {
    let positions: Vec<[f64; 3]> = landscape.vertices().collect();
    let mut bytes = vec![b' '; 80];
    bytes.extend((landscape.triangles().count() as u32).to_le_bytes());
    for corners in landscape.triangles() {
        bytes.extend(floats([0.0, 1.0, 0.0]));
        bytes.extend(corners.iter().flat_map(|&corner| floats(positions[corner])));
        bytes.extend([0; 2]);
    }
    bytes
}

/// The bytes of a single-precision vector.
fn floats<const N: usize>(vector: [f64; N]) -> impl Iterator<Item = u8> {
    vector.into_iter().flat_map(|value| (value as f32).to_le_bytes())
}

/// Seconds and peak bytes of reading once in this process.
fn read(path: &str) {
    let start = Instant::now();
    let scene = Scene::open(path).expect("what was just written can be read");
    let seconds = start.elapsed().as_secs_f64();
    println!("{seconds} {} {}", peak_bytes().unwrap_or(f64::NAN), scene.geometry.mesh.triangles.len());
}

/// Peak memory of this process so far.
fn peak_bytes() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

/// The same in a separate process: seconds, peak bytes and triangles.
fn measured(path: &Path) -> [f64; 3] {
    let this = std::env::current_exe().expect("a running program has a file");
    let output = Command::new(this).arg(READ).arg(path).output().expect("this program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let numbers: Vec<f64> = text.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

fn print_row(kind: &Kind, megabytes: f64, runs: usize, folder: &Path) {
    let path = folder.join("landscape").with_extension(kind.ending);
    let vertices = megabytes * MEGABYTE / kind.bytes_per_vertex as f64;
    let bytes = (kind.encode)(&Landscape::of(vertices as usize));
    fs::write(&path, &bytes).expect("the temporary folder has space");
    let size = bytes.len() as f64;
    drop(bytes);
    let mut results: Vec<[f64; 3]> = (0..runs).map(|_| measured(&path)).collect();
    results.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let [seconds, peak, triangles] = results[runs / 2];
    let (megabytes, speed) = (size / MEGABYTE, size / MEGABYTE / seconds);
    println!("{:22} {megabytes:8.1} {triangles:11} {seconds:8.3} {speed:8.0} {:8.2}", kind.name, peak / size);
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = words.iter().position(|word| word == READ) {
        return read(&words[at + 1]);
    }
    let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let megabytes = numbers.first().copied().unwrap_or(100.0);
    let runs = numbers.get(1).map_or(5, |&runs| runs.max(1.0) as usize);
    let folder = tempfile::tempdir().expect("the system has a temporary folder");
    println!("file                         MB   triangles        s     MB/s peak/file");
    for kind in &KINDS {
        print_row(kind, megabytes, runs, folder.path());
    }
}
