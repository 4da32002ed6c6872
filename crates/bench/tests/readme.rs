//! Every table of the README that names its results says what they say.

use std::path::Path;

use lightmesh_bench::readme;

#[test]
fn tables_of_the_readme_are_what_their_results_say() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("README.md")).unwrap();
    let tables = readme::tables(&text, &root).unwrap_or_else(|error| panic!("README.md, {error}"));
    assert!(tables.differing.is_empty(), "lines {:?} of README.md: run `cargo xtask readme`", tables.differing);
}
