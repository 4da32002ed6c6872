//! Every shared model renders in all modes.

use glam::Vec3;
use lightmesh_render::{Frame, Mode, Settings};
use lightmesh_scene::Scene;
use lightmesh_testkit::{MODELS, MODES, Picture, mean_difference, render};

const SIZE: [u32; 2] = [48, 48];

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn every_model_is_seen_in_every_mode() {
    for model in MODELS {
        let scene = model.open();
        for mode in MODES {
            let frame = render(&scene, &Settings::default().with_aa(1).with_mode(mode).with_size(SIZE).with_samples(4));
            let picture = Picture::new(&frame);
            assert_eq!(picture.fault(), None, "{}, {mode:?}", model.file);
            let hits = picture.hits().count();
            assert!(20 * hits > SIZE[0] as usize * SIZE[1] as usize, "{}, {mode:?}: {hits} pixels", model.file);
            let lit = frame.image.color().iter().filter(|color| color.iter().any(|&value| value > 0.0)).count();
            assert!(lit >= hits / 4, "{}, {mode:?}: {lit} of {hits} pixels are not black", model.file);
        }
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn no_model_is_speckled() {
    // Details smaller than a pixel cast shadows that are: over all models under 0.1 %, in a single one under 1 %.
    let (mut all_isolated, mut all_looked_at) = (0, 0);
    for model in MODELS {
        let scene = model.open();
        let frame = render(&scene, &Settings::default().with_mode(Mode::RayTrace).with_size([128, 128]));
        let picture = Picture::new(&frame);
        for light in 0..scene.lights.len() {
            let (isolated, looked_at) = picture.isolated(light);
            assert!(isolated <= 1 + looked_at / 100, "{}, light {light}: {isolated} of {looked_at}", model.file);
            (all_isolated, all_looked_at) = (all_isolated + isolated, all_looked_at + looked_at);
        }
    }
    assert!(all_looked_at > 20_000, "{all_looked_at} pixels on smooth pieces of surface");
    assert!(1000 * all_isolated < all_looked_at, "{all_isolated} of {all_looked_at}");
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn files_of_one_mesh_in_two_formats_show_the_same() {
    // One file of each pair was rounded to about 1e-6 when it was written: the triangles agree to that precision, and the images
    // except for pixels on edges.
    for pair in
        [["bunny/bunny.ply", "bunny/stanford-bunny.obj"], ["spider/spider_ascii.stl", "spider/spider_binary.stl"]]
    {
        let [a, b] = pair.map(open);
        let distance = corners(&a).iter().zip(corners(&b)).map(|(a, b)| a.distance(b)).fold(0.0, f32::max);
        assert!(corners(&a).len() == corners(&b).len() && distance < 2e-6, "{pair:?}: {distance}");
        let [a, b] = [a, b].map(|scene| picture(&scene).image.color().as_flattened().to_vec());
        let difference = mean_difference(&a, &b);
        assert!(difference < 2e-4, "{pair:?}: {difference}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn the_same_numbers_in_another_format_give_the_same_picture() {
    for (file, format) in
        [("bunny/bunny.ply", "obj"), ("spider/spider_binary.stl", "stl"), ("spider/spider_binary.stl", "ply")]
    {
        let scene = open(file);
        let path = std::env::temp_dir().join(format!("lightmesh-{}-copy.{format}", std::process::id()));
        std::fs::write(&path, text(&scene, format)).expect("the temporary folder is writable");
        let mut copy = Scene::open(&path).expect("what was just written can be read");
        std::fs::remove_file(&path).expect("the file was just written");
        (copy.cameras, copy.lights) = (scene.cameras.clone(), scene.lights.clone());
        assert!(corners(&copy) == corners(&scene), "{file} as {format}");
        assert!(picture(&copy).image.color() == picture(&scene).image.color(), "{file} as {format}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn an_exported_model_gives_the_same_picture() {
    let folder = std::env::temp_dir().join(format!("lightmesh-{}-exports", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the temporary folder is writable");
    let image = |scene: &Scene| render(scene, &Settings::default().with_aa(1).with_size(SIZE).with_samples(4)).image;
    for model in MODELS {
        let scene = model.open();
        let expected = image(&scene);
        for name in ["copy.glb", "copy.toml"] {
            let path = folder.join(name);
            scene.export(&path).unwrap_or_else(|error| panic!("{error}"));
            let mut copy = Scene::open(&path).unwrap_or_else(|error| panic!("{error}"));
            // Written, its up vector stands at a right angle to the view.
            copy.cameras[0] = scene.cameras[0].clone();
            let copy = image(&copy);
            let [one, other] = [&expected, &copy].map(|image| image.color().as_flattened());
            let largest = one.iter().copied().fold(0.0, f32::max);
            let difference = mean_difference(one, other) / f64::from(largest);
            // Sums over triangles in another order are rounded otherwise, and a sample at an edge may fall to the other side.
            assert!(difference < 1e-5, "{}, {name}: {difference}", model.file);
        }
    }
    std::fs::remove_dir_all(&folder).expect("the files were just written");
}

fn open(file: &str) -> Scene {
    MODELS.iter().find(|model| model.file == file).expect("a shared model").open()
}

fn picture(scene: &Scene) -> Frame {
    render(scene, &Settings::default().with_aa(1).with_mode(Mode::LightMesh).with_size([256, 256]))
}

fn corners(scene: &Scene) -> Vec<Vec3> {
    (0..scene.geometry.mesh.triangles.len()).flat_map(|index| scene.geometry.mesh.corners(index)).collect()
}

/// The triangles in a text format, each with its own vertices, with all digits.
fn text(scene: &Scene, format: &str) -> String {
    let corners = corners(scene);
    let point = |p: &Vec3| format!("{} {} {}\n", p.x, p.y, p.z);
    let triangle = |index: usize| [3 * index, 3 * index + 1, 3 * index + 2];
    let triangles = (0..corners.len() / 3).map(triangle);
    match format {
        "obj" => {
            let points: String = corners.iter().map(|p| format!("v {}", point(p))).collect();
            points + &triangles.map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).collect::<String>()
        }
        "ply" => {
            let coordinates = ["x", "y", "z"].map(|name| format!("property float {name}\n")).concat();
            let (vertices, faces) = (corners.len(), corners.len() / 3);
            let header = format!(
                "ply\nformat ascii 1.0\nelement vertex {vertices}\n{coordinates}element face {faces}\n\
                 property list uchar int vertex_indices\nend_header\n"
            );
            let points: String = corners.iter().map(point).collect();
            header + &points + &triangles.map(|[a, b, c]| format!("3 {a} {b} {c}\n")).collect::<String>()
        }
        _ => {
            let vertices = |triangle: [usize; 3]| triangle.map(|i| format!("vertex {}", point(&corners[i]))).concat();
            let facet = |t| format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", vertices(t));
            format!("solid\n{}endsolid\n", triangles.map(facet).collect::<String>())
        }
    }
}
