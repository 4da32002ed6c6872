use super::*;
use crate::report::tests::results;
use crate::{Row, Samples};

const COMMENT: &str = "<!-- from runs/a.json: any; where scene=garden; columns step, render ms as ms -->";

/// A folder with results.
fn root() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let results = results("any", |rows| {
        for (scene, step, seconds) in [("garden", 0.1, 0.0056), ("garden", 0.05, 0.0078), ("gazebo, small", 2.0, 0.002)]
        {
            let mut row = Row::new("any", [("scene", scene.into()), ("step", step.into())]);
            row.seconds.insert("render".to_owned(), Samples(vec![seconds]));
            rows.push(row);
        }
    });
    std::fs::create_dir(folder.path().join("runs")).unwrap();
    std::fs::write(folder.path().join("runs/a.json"), serde_json::to_string(&results).unwrap()).unwrap();
    folder
}

fn document(table: &str) -> String {
    format!("# Title\n\n{COMMENT}\n{table}\nText.\n")
}

const TABLE: &str = "| step | ms |\n|--:|--:|\n| 0.1 | 5.60 |\n| 0.05 | 7.80 |\n";

#[test]
fn a_missing_table_is_written_and_then_as_it_should_be() {
    let root = root();
    let written = tables(&document(""), root.path()).unwrap();
    assert_eq!((written.text.as_str(), &written.differing[..], written.count), (&*document(TABLE), &[3][..], 1));
    let again = tables(&written.text, root.path()).unwrap();
    assert_eq!((again.text, again.differing), (written.text, vec![]));
}

#[test]
fn a_doctored_table_is_found_and_corrected() {
    let root = root();
    for (honest, doctored) in [("5.60", "5.59"), ("| 0.05 | 7.80 |\n", ""), ("| ms |", "| s |"), ("--:|\n", "---|\n")] {
        let found = tables(&document(&TABLE.replacen(honest, doctored, 1)), root.path()).unwrap();
        assert_eq!((found.differing, found.text), (vec![3], document(TABLE)), "{doctored}");
    }
}

#[test]
fn values_may_hold_commas() {
    let root = root();
    let text = format!("{}\n", COMMENT.replace("scene=garden", "scene=gazebo, small, step=2"));
    let expected = format!("{text}| step | ms |\n|--:|--:|\n| 2 | 2.00 |\n");
    assert_eq!(tables(&text, root.path()).unwrap().text, expected);
}

#[test]
fn other_tables_and_examples_are_left_alone() {
    let root = root();
    let text = format!("| a |\n|---|\n| 1 |\n\n```text\n{COMMENT}\n```\nno end of line");
    assert_eq!(tables(&text, root.path()).unwrap(), Tables { text, differing: vec![], count: 0 });
}

#[test]
fn what_cannot_be_followed_is_refused_with_its_line() {
    let root = root();
    let refused = |from: &str, to: &str| {
        let text = format!("\n{}\n", COMMENT.replace(from, to));
        tables(&text, root.path()).unwrap_err().to_string()
    };
    assert!(refused("scene=", "scene ").contains("is not of the form"));
    assert!(refused("where ", "for ").starts_with("line 2: `<!-- from runs/a.json"));
    assert!(refused("a.json", "b.json").contains("b.json"));
    let unknown = refused("any;", "none;");
    assert!(unknown.contains("there is no table `none`") && unknown.contains("any"), "{unknown}");
    let column = refused("columns step", "columns steps");
    assert!(column.contains("no column `steps`") && column.contains("scene, step, render ms"), "{column}");
    assert!(refused("scene=garden", "scene=none").contains("no row with scene=none"));
}
