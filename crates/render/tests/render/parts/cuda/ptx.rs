use lightmesh_render::internals::cuda::{MODULES, Needs, VERSIONS, Version, capability, directive};

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
    for (name, text) in MODULES {
        let version = directive(text, ".version").unwrap_or_else(|| panic!("{name} has no .version"));
        assert!(VERSIONS.iter().any(|row| row.0 == version), "{name}: PTX {version} is not in the table");
        assert_eq!(Needs::of(text).capability, 75, "{name}");
    }
    assert_eq!(capability(Needs::of_kernels().capability), "7.5");
}
