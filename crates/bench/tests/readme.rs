//! Every table in the documents that names its results matches them.

use std::path::Path;

use lightmesh_bench::readme;

#[test]
fn tables_of_documents_are_what_their_results_say() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for document in ["docs/results/README.md", "docs/method/thesis.md"] {
        let path = root.join(document);
        let text = std::fs::read_to_string(&path).unwrap();
        let tables =
            readme::tables(&text, path.parent().unwrap()).unwrap_or_else(|error| panic!("{document}, {error}"));
        assert!(tables.differing.is_empty(), "lines {:?} of {document}: run `cargo xtask readme`", tables.differing);
        assert!(tables.count > 0, "{document} has no table from results");
    }
}
