use lightmesh_render::internals::cuda::{MODULES, Module, Needs, VERSIONS, Version, capability, directive};

#[test]
fn newer_ptx_needs_newer_drivers() {
    assert!(VERSIONS.is_sorted_by(|a, b| a.0 < b.0 && a.1 < b.1 && a.2 < b.2));
    let text = "//\n// Generated\n//\n\n.version 8.4\n.target sm_75, debug\n.address_size 64\n";
    let needs = Needs { cuda: Version { major: 12, minor: 4 }, driver: 550, capability: 75 };
    assert_eq!(Needs::of(text), needs);
    assert_eq!(Needs::of(".version 8.0\n.target sm_90\n").and(needs), Needs { capability: 90, ..needs });
    assert_eq!(Needs::of("").cuda, Version { major: 12, minor: 0 });
}

#[test]
fn all_kernels_are_for_devices_from_7_5_on_and_their_version_is_in_the_table() {
    for Module { name, head, .. } in MODULES {
        let version = directive(head, ".version").unwrap_or_else(|| panic!("{name} has no .version"));
        assert!(VERSIONS.iter().any(|row| row.0 == version), "{name}: PTX {version} is not in the table");
        assert_eq!(Needs::of(head).capability, 75, "{name}");
    }
    assert_eq!(capability(Needs::of_kernels().capability), "7.5");
}

#[test]
fn modules_are_unpacked_as_they_are_committed() {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../kernels/src/cuda/ptx"));
    for module in MODULES {
        let committed = std::fs::read(folder.join(format!("{}.ptx", module.name))).unwrap();
        let unpacked = module.unpacked().unwrap();
        assert!(unpacked.split_last() == Some((&0, &committed[..])), "{}", module.name);
        assert!(!committed.contains(&0) && module.packed.len() < committed.len(), "{}", module.name);
    }
    let files = std::fs::read_dir(folder).unwrap().filter(|file| {
        file.as_ref().is_ok_and(|file| file.path().extension().is_some_and(|extension| extension == "ptx"))
    });
    assert_eq!(files.count(), MODULES.len());
}

#[test]
fn damaged_modules_are_errors() {
    let whole = MODULES.first().unwrap();
    let cut = Module { packed: &whole.packed[..whole.packed.len() / 2], ..*whole };
    let longer = Module { bytes: whole.bytes + 1, ..*whole };
    let shorter = Module { bytes: whole.bytes - 1, ..*whole };
    for damaged in [cut, longer, shorter] {
        let why = damaged.unpacked().unwrap_err();
        assert!(why.contains(whole.name) && why.contains("damaged"), "{why}");
    }
}
