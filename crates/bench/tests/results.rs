//! Committed results contain only rows, as written by `lightmesh bench --json`.

use std::path::Path;

use lightmesh_bench::Results;

#[test]
fn committed_results_are_what_the_command_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/results");
    let written = tempfile::tempdir().unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if name == "README.md" {
            continue;
        }
        assert!(name.ends_with(".json"), "{name} is not a result file: pages and images are generated from those");
        let results = Results::load(&path).unwrap();
        assert!(results.pictures.is_empty(), "{name} has images");
        // Those of the peers are written by Python.
        if results.suite != "peers" {
            let again = written.path().join(name);
            results.save(&again).unwrap();
            let [committed, again] = [&path, &again].map(|path| std::fs::read_to_string(path).unwrap());
            let differs = committed.lines().zip(again.lines()).find(|(committed, again)| committed != again);
            assert_eq!(differs, None, "{name} is not as written by the program");
            assert_eq!(committed.len(), again.len(), "{name} is not as written by the program");
        }
        count += 1;
    }
    assert!(count > 0, "no results in {}", folder.display());
}
