use lightmesh_scene::internals::quote::{MESSAGE, QUOTED, abridged, list, quote};

#[test]
fn quotations_are_short_and_seen() {
    assert_eq!(quote(" oak\n"), "oak");
    assert_eq!(quote("a\u{1b}[31m\u{202e}"), r"a\u{1b}[31m\u{202e}");
    assert_eq!(quote(&"ü".repeat(1000)), "ü".repeat(QUOTED) + "…");
}

#[test]
fn lists_are_short() {
    let names: Vec<String> = (0..1_000_000).map(|name| name.to_string()).collect();
    assert_eq!(
        list(names.iter().map(String::as_str)),
        "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19 and 999980 more"
    );
    assert_eq!(list(["a", "b"].into_iter()), "a, b");
}

#[test]
fn messages_of_others_quote_as_little() {
    let long = "secret ".repeat(100);
    let message = abridged(&format!("invalid type: string \"{long}\", expected u32 at line 1"));
    assert_eq!(message, "invalid type: string \"secret secret secret sec…\", expected u32 at line 1");
    assert_eq!(abridged("expected `,` or `]`"), "expected `,` or `]`");
    assert!(abridged(&format!("{long}{long}")).chars().count() <= MESSAGE + 1);
    assert!(abridged(&"\"a".repeat(1000)).chars().count() <= 2 * MESSAGE + 1);
}
