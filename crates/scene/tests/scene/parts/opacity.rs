use lightmesh_scene::internals::opacity::suggested_by;
use lightmesh_scene::{OpacityChannel, Texture};

#[test]
fn luminance_of_greys_is_the_grey() {
    for grey in 0..=u8::MAX {
        assert_eq!(OpacityChannel::of([grey, grey, grey, 7], OpacityChannel::Luminance), grey);
    }
    let texel = [1, 2, 3, 4];
    let values = OpacityChannel::ALL.iter().map(|&channel| OpacityChannel::of(texel, channel));
    assert_eq!(values.collect::<Vec<_>>(), [4, 1, 2, 3, 2]);
}

#[test]
fn alpha_counts_where_there_is_any() {
    let texture = |alpha| Texture { name: String::new(), size: [2, 1], texels: vec![[9, 9, 9, 255], [9, 9, 9, alpha]] };
    assert_eq!(suggested_by(&texture(255)), OpacityChannel::Luminance);
    assert_eq!(suggested_by(&texture(254)), OpacityChannel::Alpha);
}
