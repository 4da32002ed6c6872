//! Films and pictures by a leader and workers: the files of one process.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use lightmesh::Request;
use lightmesh::render::Unobserved;
use lightmesh::request::cluster::{BandedPicture, FilmLog, Worker, for_workers, seal_beside};
use lightmesh::request::files::Files;
use lightmesh::request::{ClusterError, Error, Order, film};

fn order(folder: &Path, name: &str, settings: &[(&str, &str)]) -> Order {
    let mut request = Request::default();
    for &(setting, value) in [("size", "32x24"), ("quality", "draft"), ("device", "cpu")].iter().chain(settings) {
        request.set(setting, value).unwrap();
    }
    Order {
        scene: "builtin:gazebo".into(),
        request,
        files: Files { output: Some(folder.join(name)), ..Files::default() },
    }
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())).collect()
}

fn worker(order: &Order) -> Worker {
    Worker::open(Order { request: for_workers(&order.request), ..order.clone() }, Some(1), &Unobserved).unwrap()
}

#[test]
fn a_film_by_workers_has_the_files_and_the_manifest_of_one_process() {
    let [one, many] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let settings = [("turntable", "4"), ("exposure", "auto")];
    let alone = order(one.path(), "f.#.png", &settings);
    for frame in film(&alone.scene, &alone.request, alone.files.clone(), &Unobserved).unwrap() {
        frame.unwrap();
    }
    let order = order(many.path(), "f.#.png", &settings);
    let mut log = FilmLog::begin(order.clone(), &Unobserved).unwrap();
    let seal = seal_beside(&many.path().join("f.#.png")).unwrap();
    assert!(log.has_written(&seal) && !log.has_written("0"), "{seal}");
    assert_eq!((log.numbers(), log.kept(), log.last(), log.chosen()), (&[1, 2, 3, 4][..], 0, 4, None));
    let mut workers = [worker(&order), worker(&order)];
    assert_eq!((workers[0].inputs(), workers[0].threads()), (log.inputs(), 1));
    let chosen = workers[0].choose(&Unobserved).unwrap();
    log.choose(chosen);
    // In another order, and one of them twice.
    for (worker, number) in [(0, 4), (1, 1), (1, 3), (0, 3), (0, 2)] {
        let written = workers[worker].frame(number, chosen, &Unobserved).unwrap();
        log.finished(number, written.files).unwrap();
    }
    log.close().unwrap();
    assert_eq!(contents(many.path()), contents(one.path()));
    let resumed = Request { resume: true, ..order.request.clone() };
    let again = FilmLog::begin(Order { request: resumed, ..order }, &Unobserved).unwrap();
    assert_eq!((again.numbers(), again.kept()), (&[][..], 4));
}

#[test]
fn a_picture_by_workers_is_that_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    // What mirrors show is exposed by a first pass.
    let settings = [("size", "32x150"), ("exposure", "auto"), ("bounces", "1")];
    let mut order = order(folder.path(), "many.png", &settings);
    order.request.ground = true;
    lightmesh::render(&order.scene, &order.request).unwrap().save(folder.path().join("one.png")).unwrap();
    let worker = worker(&Order { files: Files::default(), ..order.clone() });
    let picture = BandedPicture::begin(order, Some(1), &Unobserved).unwrap();
    let mut passes = 0;
    let bands = |first: &[(i64, u32)], pass: &_| -> Result<Vec<_>, Error> {
        first.iter().map(|&(first, rows)| worker.band(pass, first, rows, &Unobserved)).collect()
    };
    let rendered = picture.render(&Unobserved, |pass| {
        passes += 1;
        assert_eq!((pass.number + 1, pass.of, pass.area), (passes, 2, [0, 0, 32, 150]));
        bands(&[(80, 70), (0, 80)], pass)
    });
    let (mut frame, stops) = rendered.unwrap();
    picture.save(&mut frame, stops, &Unobserved).unwrap();
    assert_eq!(passes, 2);
    assert_eq!(fs::read(folder.path().join("many.png")).unwrap(), fs::read(folder.path().join("one.png")).unwrap());
    let lacking = picture.render(&Unobserved, |pass| bands(&[(0, 80)], pass)).unwrap_err();
    assert!(matches!(lacking, Error::Cluster(ClusterError::Bands { rows: 150 })), "{lacking}");
    let beyond = picture.render(&Unobserved, |pass| bands(&[(100, 51)], pass)).unwrap_err();
    assert!(matches!(beyond, Error::Cluster(ClusterError::Rows { first: 100, rows: 51 })), "{beyond}");
}

#[test]
fn what_one_process_alone_can_do_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |order: Order| FilmLog::begin(order, &Unobserved).map(|_| ()).unwrap_err().to_string();
    let film = order(folder.path(), "f.#.png", &[("turntable", "2")]);
    let movie = Files { output: Some(folder.path().join("f.mp4")), ..Files::default() };
    assert!(
        refused(Order { files: movie, ..film.clone() }).contains("is one file, and frames come from many processes")
    );
    assert!(refused(Order { files: Files::default(), ..film.clone() }).contains("needs files for its frames"));
    assert!(refused(Order { scene: "-".into(), ..film.clone() }).contains("standard input"));
    fs::write(folder.path().join("manifest.json"), "{}").unwrap();
    assert!(
        refused(film.clone()).contains("manifest.json"),
        "the log of the film would replace what belongs to somebody else"
    );
    let picture = BandedPicture::begin(film, None, &Unobserved).map(|_| ()).unwrap_err().to_string();
    assert!(picture.contains("turntable is not for a picture by many processes"), "{picture}");
}
