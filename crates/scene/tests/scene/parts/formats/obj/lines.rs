use lightmesh_scene::internals::formats::obj::Lines;

#[test]
fn a_backslash_joins_lines_but_not_behind_a_comment() {
    let mut lines = Lines::new(b"f 1 \\\r\n2 \\\n 3\n# C:\\models\\\n\nv 1\\");
    let mut all = Vec::new();
    while let Some((number, line)) = lines.next_line() {
        all.push(format!("{number} {}", String::from_utf8_lossy(line)));
    }
    assert_eq!(all, ["3 f 1  2  3", "4 # C:\\models\\", "5 ", "6 v 1"]);
}
