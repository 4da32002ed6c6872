//! Ctrl-C.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::run::Place;

#[test]
fn an_interrupted_render_leaves_nothing_behind() {
    let place = Place::new();
    let flags = ["--mode", "area", "--size", "3000x3000", "--progress", "json", "--light", "3,5,2;1;0.5"];
    let mut command = place.command(&[&["render", "room.toml", "-o", "a.png"], &flags[..]].concat());
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    let tracing = lines.find(|line| line.contains(r#""begin","stage":"long_tests""#));
    assert!(tracing.is_some());

    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let last = lines.last().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(last, "interrupted: nothing was written");
    assert_eq!(place.files(), ["room.toml"]);
}
