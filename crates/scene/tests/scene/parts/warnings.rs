use lightmesh_scene::internals::warnings::{MOST, Warnings};

#[test]
fn very_many_warnings_are_a_short_list() {
    let mut warnings = Warnings::default();
    for number in 0..1_000_000 {
        warnings.push("a".to_owned());
        warnings.push(format!("{}", number % 1000));
    }
    let list = warnings.into_list();
    assert_eq!(list[..2], ["a (1000000 times)", "0 (1000 times)"]);
    assert_eq!((list.len(), list[MOST].as_str()), (MOST + 1, "901000 more warnings are not shown"));
}
