use lightmesh_scene::internals::formats::gltf::{Component, Strided};

fn strided(bytes: &[u8], count: usize, stride: usize, component: Component, normalized: bool) -> Strided<'_> {
    Strided { bytes, count, size: component.size(), stride, component, normalized }
}

#[test]
fn some_elements_are_those_of_all() {
    let bytes = [1, 0, 9, 2, 0, 9, 3, 0, 9, 4, 0];
    let (all, mut packed) = (strided(&bytes, 4, 3, Component::U16, false), Vec::new());
    assert_eq!(all.integers(), [1, 2, 3, 4]);
    assert_eq!(all.packed(&[1, 3], &mut packed).integers(), [2, 4]);
    assert_eq!(packed, [2, 0, 4, 0]);
}

#[test]
fn normalized_integers_reach_their_ends() {
    let ends = |bytes: &[u8], component, stride| strided(bytes, 1, stride, component, true).numbers::<2>();
    assert_eq!(ends(&[0, 255], Component::U8, 2), [[0.0, 1.0]]);
    // Both -128 and -127 are -1.
    assert_eq!(ends(&[0x80, 0x7f], Component::I8, 2), [[-1.0, 1.0]]);
    assert_eq!(ends(&[0x81, 0], Component::I8, 2), [[-1.0, 0.0]]);
    assert_eq!(ends(&[0, 0, 0xff, 0xff], Component::U16, 4), [[0.0, 1.0]]);
    assert_eq!(ends(&[0, 0x80, 0xff, 0x7f], Component::I16, 4), [[-1.0, 1.0]]);
}

#[test]
fn integers_that_are_not_normalized_stay_what_they_are() {
    assert_eq!(strided(&[0xfe, 2, 0, 7], 2, 2, Component::I8, false).numbers(), [[-2.0], [0.0]]);
    assert_eq!(strided(&[1, 0, 0, 1], 1, 4, Component::U32, false).numbers(), [[16_777_217_f32]]);
    assert_eq!(strided(&[1, 9, 2], 2, 2, Component::U8, false).integers(), [1, 2]);
    assert_eq!(strided(&[1, 1, 2, 0], 2, 2, Component::U16, false).integers(), [257, 2]);
}

#[test]
fn the_last_element_may_end_with_the_bytes() {
    let bytes: Vec<u8> = [1f32, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(strided(&bytes, 2, 8, Component::F32, false).numbers(), [[1.0], [3.0]]);
    assert!(strided(&bytes, 2, 8, Component::F32, false).borrowed::<f32>().is_none());
}
