//! Reports on handmade results.

use std::collections::BTreeSet;
use std::path::Path;

use lightmesh::image::Frame;

use super::*;
use crate::{Gpu, Key, Machine, Picture, Program, Row, Samples};

/// Results with rows that `fill` adds.
pub(crate) fn results(suite: &str, fill: impl FnOnce(&mut Vec<Row>)) -> Results {
    let gpu = Gpu { name: "Some GPU".into(), memory_bytes: 1 << 34, driver: "CUDA 13.0".into() };
    let mut rows = Vec::new();
    fill(&mut rows);
    Results {
        version: Results::VERSION,
        suite: suite.into(),
        quick: true,
        program: Program {
            name: "lightmesh".into(),
            version: "0.1.0".into(),
            commit: Some("c0ffee".into()),
            command: "lightmesh bench thesis --quick".into(),
        },
        machine: Machine {
            cpu: "Some CPU".into(),
            threads: 8,
            memory_bytes: 1 << 35,
            os: "Linux".into(),
            gpus: vec![gpu],
        },
        started: "2026-01-31T12:00:00Z".into(),
        seconds: 100.0,
        rows,
        pictures: vec![],
        notes: vec!["A <b>note</b> & more".into()],
    }
}

/// Runs with the names 0, 1, …
pub(crate) fn runs(results: Vec<Results>) -> Runs {
    named(results.into_iter().enumerate().map(|(index, run)| (format!("{index}.json").into(), run)).collect())
}

fn timed(experiment: &str, keys: &[(&'static str, Key)], seconds: f64) -> Row {
    let mut row = Row::new(experiment, keys.iter().cloned());
    row.seconds.insert("render".into(), Samples(vec![seconds, 1.1 * seconds, 1.2 * seconds]));
    row.values.extend([("pixels".to_owned(), 1e6), ("light_points".to_owned(), 7e5)]);
    row
}

/// The light mesh takes `mesh` seconds, hard shadows one; figure 11 has 1 to 64 lights; one experiment is unknown.
pub(crate) fn thesis(mesh: f64) -> Results {
    let mut results = results("thesis", |rows| {
        let common = |mode: &str| {
            vec![("scene", "garden".into()), ("lights", 1.0.into()), ("mode", mode.into()), ("device", "cuda".into())]
        };
        let step = |keys: Vec<(&'static str, Key)>| [keys, vec![("step", 0.1.into()), ("radius", 2.1.into())]].concat();
        rows.push(timed("timings", &common("ray-trace"), 1.0));
        rows.push(timed("timings", &step(common("light-mesh")), mesh));
        rows[1].values.insert("thesis_gpu_seconds".into(), 0.63);
        for (lights, hard) in [(1.0, 1.0), (8.0, 5.0), (64.0, 33.0)] {
            let keys = |mode: &str| [("lights", lights.into()), ("mode", mode.into()), ("device", "cuda".into())];
            rows.push(timed("figure 11", &keys("light-mesh"), 5.0));
            rows.push(timed("figure 11", &keys("ray-trace"), hard));
        }
        rows.push(timed("something | new", &[("kind", "<odd>".into())], 0.5));
        rows.last_mut().unwrap().values.insert("hard_seconds_per_light".into(), 0.002);
        let mut points = Row::new("table 2", [("scene", "garden".into())]);
        points.values.extend([("light_points".to_owned(), 2.2e5), ("thesis_light_points".to_owned(), 1.1e5)]);
        rows.push(points);
    });
    results.pictures = vec![picture("p: reference", None, 0.2), picture("p: test \"1\"", Some("p: reference"), 0.6)];
    results
}

fn picture(id: &str, reference: Option<&str>, value: f32) -> Picture {
    Picture {
        id: id.into(),
        experiment: "p".into(),
        title: id.into(),
        reference: reference.map(str::to_owned),
        file: String::new(),
        png: png(16, value),
    }
}

/// A grey image, 8 pixels high.
fn png(width: u32, value: f32) -> Vec<u8> {
    Frame::new(width, 8, vec![[value; 3]; 8 * width as usize]).unwrap().to_png().unwrap()
}

fn report(results: Results) -> Result<Report, ReportError> {
    Report::new(vec![("runs/a.json".into(), results)])
}

/// Checks that all tags are closed in order; returns their names.
fn tags(html: &str) -> BTreeSet<String> {
    // Scripts and styles contain no markup.
    let mut rest = html.to_owned();
    for raw in ["script", "style"] {
        let (open, close) = (format!("<{raw}>"), format!("</{raw}>"));
        while let Some(begin) = rest.find(&open) {
            let end = rest[begin..].find(&close).unwrap_or_else(|| panic!("no {close}")) + begin;
            rest.replace_range(begin..end + close.len(), "");
        }
    }
    let (mut names, mut open) = (BTreeSet::new(), Vec::new());
    for piece in rest.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').unwrap_or_else(|| panic!("a tag without an end: {piece}"));
        assert!(!text.contains('>'), "a stray > in {text}");
        let name: String =
            tag.trim_start_matches('/').chars().take_while(|letter| letter.is_ascii_alphanumeric()).collect();
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "</{name}>");
        } else if !tag.starts_with('!') && !tag.ends_with('/') {
            open.push(name.clone());
        }
        names.insert(name);
    }
    assert_eq!(open, Vec::<String>::new());
    names
}

#[test]
fn the_page_is_whole_and_asks_for_nothing() {
    let html = report(thesis(2.0)).unwrap().html();
    let names = tags(&html);
    for name in ["table", "svg", "img", "figure", "polyline", "dl", "details"] {
        assert!(names.contains(name), "{name} in {names:?}");
    }
    let known = html.replace("http://www.w3.org/", "").replace("src=\"data:image/png;base64,", "");
    for address in ["http:", "https:", "src=", "url(", "@import"] {
        assert!(!known.contains(address), "{address}");
    }
    // Every link has a target in the page.
    for target in html.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(html.contains(&format!("id=\"{target}\"")), "{target}");
    }
    assert!(html.contains("A &lt;b&gt;note&lt;/b&gt; &amp; more") && !html.contains("<odd>"));
    for fact in ["Some CPU, 8 threads", "Some GPU, 16.0\u{a0}GiB, CUDA 13.0", "c0ffee", "bench thesis --quick"] {
        assert!(html.contains(fact), "{fact}");
    }
}

#[test]
fn figures_and_sections_of_the_default_come_first() {
    let mut results = thesis(2.0);
    results.rows.push(timed("whole frames", &[("method", "lists".into())], 1.0));
    let text = report(results.clone()).unwrap().markdown();
    let headings: Vec<&str> = text.lines().filter(|line| line.starts_with("## ")).collect();
    assert_eq!(
        (headings[0], headings.last()),
        ("## Whole frames by occluder lists, the default, and others", Some(&"## Notes"))
    );
    assert!(headings[1].starts_with("## Full frames"), "{headings:?}");
    let html = report(results).unwrap().html();
    let place = |text: &str| html.find(text).unwrap_or_else(|| panic!("no {text}"));
    assert!(["<dl class=\"figures\">", "<nav>", "<h2>Whole frames", "<h2>Runs and machines"].map(place).is_sorted());
    assert_eq!(html.matches("<dd>").count(), 2);
}

#[test]
fn cells_have_numbers_to_sort_by_and_repeat_quietly() {
    let html = report(thesis(2.0)).unwrap().html();
    // Milliseconds are shown, seconds are behind them.
    assert!(html.contains("<td class=\"number\" data-value=\"2.2\">2200</td>"), "{html}");
    let results = results("new", |rows| {
        for step in [1.0, 2.0] {
            rows.push(timed("some", &[("scene", "a".into()), ("step", step.into())], step));
            rows.push(timed("some", &[("scene", "b".into()), ("step", step.into())], step));
        }
    });
    let html = report(results).unwrap().html();
    assert!(html.contains("<tr><td>b</td><td class=\"number\" data-value=\"1\">1</td>"), "{html}");
    assert!(html.contains("<tr><td>a</td><td class=\"number\" data-value=\"2\">2</td>"), "{html}");
    assert_eq!(html.matches("<details").count(), html.matches("<table").count());
}

#[test]
fn ratios_to_the_thesis_say_that_its_scenes_are_others() {
    let report = report(thesis(2.0)).unwrap();
    let compared = |table: &&Table| {
        table.columns.iter().any(|column| column.name == "faster" || column.name == "light_points by thesis")
    };
    assert_eq!(report.tables().filter(compared).count(), 2);
    assert!(report.tables().filter(compared).all(|table| table.caption.contains(thesis::SCENES)));
    assert!(report.markdown().contains("| garden | 220\u{202f}000 | 110\u{202f}000 | 2.0× |"), "{}", report.markdown());
}

#[test]
fn devices_stand_side_by_side_under_their_names() {
    let results = results("new", |rows| {
        for (device, seconds) in [("cpu", 4.0), ("cuda", 1.0)] {
            for scene in ["a", "b"] {
                rows.push(timed("some", &[("scene", scene.into()), ("device", device.into())], seconds));
            }
        }
    });
    let report = report(results).unwrap();
    let table = report.tables().next().unwrap();
    let cells: Vec<[&str; 2]> = table.rows.iter().map(|row| [&*row[0].text, &*row[1].text]).collect();
    assert_eq!(cells, [["a", "CPU"], ["a", "Some GPU"], ["b", "CPU"], ["b", "Some GPU"]]);
}

#[test]
#[should_panic(expected = "</div>")]
fn tags_that_cross_are_found() {
    tags("<div><p></div></p>");
}

#[test]
fn markdown_shows_files_that_are_there() {
    let folder = tempfile::tempdir().unwrap();
    let (report, place) = (report(thesis(2.0)).unwrap(), folder.path().join("new/report"));
    report.write(&place).unwrap();
    let text = std::fs::read_to_string(place.join("report.md")).unwrap();
    let files = text.split("src=\"").chain(text.split("](")).filter_map(|rest| rest.split(['"', ')']).next());
    let files: BTreeSet<&str> =
        files.filter(|file| Path::new(file).extension().is_some_and(|end| end == "png" || end == "svg")).collect();
    assert_eq!(files.len(), 4, "{files:?}");
    for file in files {
        assert!(place.join(file).is_file(), "{file}");
    }
    assert_eq!(std::fs::read_to_string(place.join("report.html")).unwrap(), report.html());
    assert!(text.contains("Something \\| new") && text.contains("0.63"), "{text}");
    assert!(text.contains("| hard ms per light | S\\_total |") && text.contains("| 2.00 | 700\u{202f}000 |"), "{text}");
}

#[test]
fn two_runs_have_ratios() {
    let (mut old, new) = (thesis(2.0), thesis(3.0));
    old.rows.truncate(2);
    let report = Report::new(vec![("old/a.json".into(), old), ("new/a.json".into(), new)]).unwrap();
    let text = report.markdown();
    assert!(text.contains("Geometric mean: a 2 takes 1.2× the time of a."), "{text}");
    assert!(text.contains("| median, ms: a | median, ms: a 2 | ratio to a: a 2 |"), "{text}");
    assert!(text.contains("| 2200 | 3300 | 1.5× |"), "{text}");
    tags(&report.html());
}

#[test]
fn pictures_of_two_runs_are_shown_where_they_differ() {
    let two = |change: &dyn Fn(&mut Picture)| {
        let mut second = thesis(2.0);
        second.pictures.iter_mut().for_each(change);
        let report = Report::new(vec![("a.json".into(), thesis(2.0)), ("b.json".into(), second)]).unwrap();
        assert_eq!(report.html().matches("<img").count(), report.markdown().matches("<img").count());
        report.markdown()
    };
    // Reference, test and difference of the first run; then image and difference of the second.
    let same = two(&|_| ());
    assert!(same.contains("2 are identical, 0 differ") && same.matches("<img").count() == 3, "{same}");
    let one =
        two(&|picture| picture.png = if picture.reference.is_some() { png(16, 0.5) } else { picture.png.clone() });
    assert!(one.contains("1 are identical, 1 differ") && one.matches("<img").count() == 5, "{one}");
    let sizes = two(&|picture| picture.png = png(8, 0.6));
    assert!(sizes.contains("2 have different sizes") && sizes.matches("<img").count() == 3, "{sizes}");
}

#[test]
fn long_notes_end_early() {
    let mut results = thesis(2.0);
    results.notes = vec![(0..100).map(|row| format!("row {row}; ")).collect(), "short".to_owned()];
    let text = report(results).unwrap().markdown();
    assert!(text.contains("row 28; row 29") && !text.contains("row 40"), "{text}");
    assert!(text.ends_with("; and more, which the result file lists.\n\nshort\n"), "{text}");
}

#[test]
fn gpus_are_named_with_memory_and_driver() {
    let gpus = |gpus: Vec<Gpu>| {
        let mut results = thesis(2.0);
        results.machine.gpus = gpus;
        report(results).unwrap().markdown()
    };
    let gpu = Gpu { name: "A name".into(), memory_bytes: 1 << 30, driver: "CUDA 13.0".into() };
    assert!(gpus(vec![gpu]).contains("| GPU, driver | A name, 1.00\u{a0}GiB, CUDA 13.0 |"));
    assert!(gpus(vec![]).contains("| GPU, driver | none |"));
}

#[test]
fn doctored_results_are_refused() {
    let refused = |change: fn(&mut Results)| {
        let mut results = thesis(2.0);
        change(&mut results);
        report(results).unwrap_err().to_string()
    };
    assert!(
        refused(|results| results.rows.push(results.rows[0].clone()))
            .contains("a.json has two rows with the id `timings: ")
    );
    assert!(refused(|results| results.pictures[1].id = results.pictures[0].id.clone()).contains("two images"));
    assert!(refused(|results| results.pictures[0].png = b"GIF89a".into()).contains("it is not a PNG file"));
    assert!(refused(|results| results.pictures[0].png.truncate(48)).contains("png data is damaged"));
    assert!(
        refused(|results| drop(results.pictures.remove(0))).contains("its reference image `p: reference` is missing")
    );
}
