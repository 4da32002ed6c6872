use lightmesh_scene::internals::formats::text::{decoded, number, odd_number, quoted, with_line_feeds};

#[test]
fn line_endings_of_all_systems_are_one() {
    for text in ["a\nb", "\u{feff}a\r\nb", "a\rb"] {
        let mut bytes = text.as_bytes().to_vec();
        let words: Vec<&[u8]> =
            with_line_feeds(&mut bytes).split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).collect();
        assert_eq!(words, [b"a", b"b"], "{text:?}");
    }
}

#[test]
fn names_in_latin_1_stay_different() {
    assert_eq!(decoded(b"gr\xfcn"), "grün");
    assert_ne!(decoded(b"\xe4"), decoded(b"\xf6"));
    assert_eq!(decoded("grün".as_bytes()), "grün");
}

#[test]
fn messages_quote_a_beginning() {
    assert_eq!(quoted(b" v 1\t2\r"), r"v 1\t2");
    assert_eq!(quoted(&[b'x'; 1000]).chars().count(), 25);
    assert_eq!(quoted("ü".repeat(1000).as_bytes()), "ü".repeat(24) + "…");
    assert_eq!(quoted(b"root:x:0:0:root:/root:/bin/bash"), "root:x:0:0:root:/root:/b…");
}

#[test]
fn numbers_are_decimal() {
    assert_eq!([&b"1.5"[..], b"-.5e1", b"+3.", b"7"].map(number), [Some(1.5), Some(-5.0), Some(3.0), Some(7.0)]);
    assert_eq!([&b""[..], b"0x10", b"1,5", b"1\xff"].map(number), [None; 4]);
}

#[test]
fn numbers_of_c_programs_are_known() {
    assert_eq!([&b"1.0f"[..], b"-2.F", b"1e3f"].map(odd_number), [Some(1.0), Some(-2.0), Some(1000.0)]);
    let undefined = [&b"-nan(ind)"[..], b"1.#QNAN0", b"-1.#IND", b"nan(0x1)"].map(odd_number);
    assert!(undefined.iter().all(|number| number.is_some_and(f64::is_nan)), "{undefined:?}");
    assert_eq!(odd_number(b"1.#INF00"), Some(f64::INFINITY));
    assert_eq!([&b"f"[..], b"1,5", b"x", b"", b"0x1f", b"1.0ff", b"1f0"].map(odd_number), [None; 7]);
}
