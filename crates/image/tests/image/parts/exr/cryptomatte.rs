use lightmesh_image::internals::exr::{MATERIALS, Manifest, Naming, OBJECTS, identifier, manifest, murmur3};

#[test]
fn hashes_have_their_known_values() {
    // Of the reference implementation, seed 0.
    for (text, hash) in [
        ("", 0),
        ("a", 0x3c25_69b2),
        ("abc", 0xb3dd_93fa),
        ("test", 0xba6b_d213),
        ("Hello, world!", 0xc036_3e43),
        ("The quick brown fox jumps over the lazy dog", 0x2e4f_f723),
    ] {
        assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
    }
}

#[test]
fn identifiers_have_their_known_values() {
    // Of the tests of Psyop's implementation.
    for (name, value) in
        [("hello", 6.070_563e-17_f32), ("cube", -4.084_619e15), ("sphere", 2.790_186e15), ("plane", 3.665_576_2e-11)]
    {
        let found = f32::from_bits(identifier(name));
        assert!((found / value - 1.0).abs() < 1e-6, "{name}: {found:e}");
    }
    // The empty name would be zero, which is nothing.
    assert_eq!(identifier(""), 1 << 23);
    let names = (0..100_000).map(|number| format!("name {number}"));
    assert!(names.map(|name| f32::from_bits(identifier(&name))).all(f32::is_normal));
}

#[test]
fn a_manifest_keeps_names_and_their_order() {
    let names = ["b", "a", "zwölf \"Kühe\"\\\n", "", "日本"].map(str::to_owned).to_vec();
    assert_eq!(serde_json::from_str::<Manifest>(&manifest(&names)).unwrap().0, names);
    assert_eq!(manifest(&names[1..2]), "{\"a\":\"3c2569b2\"}");
    for broken in ["", "[]", "{\"a\"}", "{\"a\":1}", "{\"a\":{}}"] {
        assert!(serde_json::from_str::<Manifest>(broken).is_err(), "{broken}");
    }
}

#[test]
fn attributes_are_those_of_the_specification() {
    let naming = Naming { layer: "uCryptoAsset", nearest: "" };
    assert!(naming.attribute("name").starts_with("cryptomatte/"));
    assert_eq!(naming.attribute("hash").len(), "cryptomatte/0123456/hash".len());
    assert_eq!(OBJECTS.channels(0), ["CryptoObject00.R", "CryptoObject00.G"]);
    assert_eq!(MATERIALS.channels(5), ["CryptoMaterial02.B", "CryptoMaterial02.A"]);
}
