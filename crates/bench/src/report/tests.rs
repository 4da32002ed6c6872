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

fn timed(experiment: &str, keys: &[(&'static str, Key)], seconds: f64) -> Row {
    let mut row = Row::new(experiment, keys.iter().cloned());
    row.seconds.insert("render".into(), Samples(vec![seconds, 1.1 * seconds, 1.2 * seconds]));
    row.values.extend([("pixels".to_owned(), 1e6), ("light_points".to_owned(), 7e5)]);
    row
}

/// The method takes `mesh` seconds, hard shadows one; figure 11 crosses at 8 lights; one row has no layout.
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
            let keys = |mode: &str| {
                [
                    ("scene", "childpark".into()),
                    ("lights", lights.into()),
                    ("mode", mode.into()),
                    ("device", "cuda".into()),
                ]
            };
            rows.push(timed("figure 11", &keys("light-mesh"), 5.0));
            rows.push(timed("figure 11", &keys("ray-trace"), hard));
        }
        rows.push(timed("something | new", &[("kind", "<odd>".into())], 0.5));
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
        png: png(16, &[], value),
    }
}

/// A grey image, 8 pixels high, with other values for single pixels.
fn png(width: u32, others: &[(usize, f32)], value: f32) -> Vec<u8> {
    let mut color = vec![[value; 3]; 8 * width as usize];
    for &(place, other) in others {
        color[place] = [other; 3];
    }
    Frame::new(width, 8, color).unwrap().to_png().unwrap()
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
    for name in ["table", "svg", "image", "use", "figure", "polyline", "dl", "details"] {
        assert!(names.contains(name), "{name} in {names:?}");
    }
    for address in ["http:", "https:", "src=", "url(", "@import"] {
        let known = html.replace("http://www.w3.org/", "");
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
fn the_page_begins_with_figures_plots_and_pictures() {
    let html = report(thesis(2.0)).unwrap().html();
    let place = |text: &str| html.find(text).unwrap_or_else(|| panic!("no {text}"));
    assert_eq!(html.matches("<dd>").count(), 3);
    let order =
        ["<dl class=\"figures\">", "<nav>", "<figure class=\"plot\">", "<figure class=\"pair\">", "<h2>What was run"];
    assert!(order.map(place).is_sorted(), "{:?}", order.map(place));
    // In a section, too: the table of figure 11 follows its plot.
    let section = &html[place("<h2>Figure 11")..];
    assert!(section.find("class=\"plot\"") < section.find("<table>"));
}

#[test]
fn every_table_folds_and_has_numbers_to_sort_by() {
    let html = report(thesis(2.0)).unwrap().html();
    let tables = html.matches("<table>").count();
    assert_eq!(html.matches("<details class=\"table").count(), tables);
    let folded = html.matches("<details class=\"table\">").count();
    assert!(0 < folded && folded < tables, "{folded} of {tables}");
    // Milliseconds are shown, seconds are behind them.
    assert!(html.contains("<td class=\"number\" data-value=\"2.2\">2200</td>"), "{html}");
}

#[test]
fn ratios_to_the_thesis_say_that_its_scenes_are_others() {
    let report = report(thesis(2.0)).unwrap();
    for text in [report.html().replace("&#39;", "'"), report.markdown()] {
        assert!(text.contains(layouts::thesis::SCENES), "{text}");
    }
    let captions = report.tables().filter(|table| table.columns.iter().any(|column| column.name.contains("faster")));
    assert!(captions.into_iter().all(|table| table.caption.contains(layouts::thesis::SCENES)));
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
    let text = report(results).unwrap().markdown();
    let rows = text.split_once("## Some").unwrap().1;
    let lines: Vec<&str> =
        rows.lines().filter(|line| line.starts_with("| CPU") || line.starts_with("| Some GPU")).collect();
    let starts = ["| CPU | a |", "| Some GPU | a |", "| CPU | b |", "| Some GPU | b |"];
    assert_eq!(lines.len(), 4, "{text}");
    assert!(lines.iter().zip(starts).all(|(line, start)| line.starts_with(start)), "{lines:?}");
}

#[test]
fn print_is_light_and_has_no_sliders() {
    let style = include_str!("report.css");
    // Dark mode and sliders are for screens only.
    for (rule, _) in style.match_indices(".sliding .stack").chain(style.match_indices("prefers-color-scheme: dark")) {
        let media = style[..rule + 1].rfind("@media").map(|begin| &style[begin..]);
        assert!(media.is_some_and(|media| media.starts_with("@media screen")), "{}", &style[rule..rule + 30]);
    }
    assert!(style.contains(".stack { display: none; }") && style.contains("@media print"));
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
}

#[test]
fn sentences_follow_from_the_rows() {
    let sentences = |mesh| report(thesis(mesh)).unwrap().markdown();
    let lost = sentences(2.0);
    let hard = "Garden, 1 light: compared with hard shadows, the light mesh takes";
    assert!(
        lost.contains(&format!("- **loses**: {hard} 2.0× the time on Some GPU (1 image, h = 0.1, R = 2.1).")),
        "{lost}"
    );
    assert!(
        lost.contains("- **depends**: Childpark, on Some GPU: from 8.0 lights on the light mesh takes less time"),
        "{lost}"
    );
    let won = sentences(0.5);
    assert!(won.contains(&format!("- **wins**: {hard} 0.50× the time on Some GPU")), "{won}");
}

#[test]
fn light_points_are_told_of_pictures_that_have_many() {
    let results = results("thesis", |rows| {
        for (size, points) in [(512.0, 4e5), (512.0, 7e5), (1024.0, 6e5)] {
            let keys = [("size", size.into()), ("step", 1.0.into()), ("radius", (points / 1e5).into())];
            let mut row =
                Row::new("t", keys.into_iter().chain([("scene", "garden".into()), ("mode", "light-mesh".into())]));
            row.values.extend([("pixels".to_owned(), 1e6), ("light_points".to_owned(), points)]);
            rows.push(row);
        }
    });
    let text = report(results).unwrap().markdown();
    let wanted =
        "- **loses**: Garden: 0.70 (size 512, h = 1, R = 7) and 0.60 (size 1024, h = 1, R = 6) light points per pixel";
    assert!(text.contains(wanted), "{text}");
}

#[test]
fn two_runs_have_ratios() {
    let (mut old, mut new) = (thesis(2.0), thesis(3.0));
    old.rows.truncate(2);
    new.pictures[1] = picture("p: test \"1\"", Some("p: reference"), 0.5);
    let report = Report::new(vec![("old/a.json".into(), old), ("new/a.json".into(), new)]).unwrap();
    let text = report.markdown();
    assert!(text.contains("Geometric mean: a 2 takes 1.2× the time of a."), "{text}");
    assert!(text.contains("| median, ms: a | median, ms: a 2 | ratio to a: a 2 |"), "{text}");
    assert!(text.contains("| 2200 | 3300 | 1.5× |"), "{text}");
    assert!(text.contains("Of the common images, 1 is identical; 1 differs and is shown below."), "{text}");
    tags(&report.html());
}

/// Two runs, with images `change`d in the second.
fn two(change: impl FnOnce(&mut [Picture], &mut [Picture])) -> Report {
    let (mut first, mut second) = (thesis(2.0), thesis(2.0));
    change(&mut first.pictures, &mut second.pictures);
    Report::new(vec![("a.json".into(), first), ("b.json".into(), second)]).unwrap()
}

#[test]
fn pictures_that_are_alike_are_shown_once() {
    let once = two(|_, _| ());
    let text = once.markdown();
    // Test, reference and difference.
    assert_eq!((text.matches("<img").count(), once.html().matches("<image ").count()), (3, 3), "{text}");
    assert!(text.contains("Of the common images, 2 are identical."), "{text}");
    assert!(text.contains("Images of a. Of the images of b, 2 are identical."), "{text}");

    // A difference of 1/255 in one pixel.
    let nearly = two(|first, second| {
        for pictures in [&mut *first, &mut *second] {
            pictures.iter_mut().for_each(|picture| picture.png = png(128, &[], 0.6));
        }
        second[1].png = png(128, &[(0, 0.604)], 0.6);
    });
    let text = nearly.markdown();
    assert_eq!(text.matches("<img").count(), 3, "{text}");
    assert!(
        text.contains("1 differs by a mean FLIP below 0.0001 (b: p: test \"1\", 1 of 1024 pixels, mean FLIP "),
        "{text}"
    );
    assert!(text.contains("Of the images of b, 1 is identical, 1 is nearly identical."), "{text}");
}

#[test]
fn pictures_of_other_sizes_are_shown_but_not_compared() {
    let report = two(|_, pictures| pictures.iter_mut().for_each(|picture| picture.png = png(8, &[], 0.6)));
    let text = report.markdown();
    assert!(text.contains("Of the common images, 2 have different sizes and cannot be compared."), "{text}");
    assert_eq!(text.matches("<img").count(), 6, "{text}");
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
