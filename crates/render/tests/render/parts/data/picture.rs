use lightmesh_render::Picture;

#[test]
fn what_is_not_covered_loses_its_background() {
    let mut picture = Picture::new([3, 1], None);
    picture.color = vec![[0.2, 0.4, 0.8], [0.6, 0.5, 0.4], [0.25; 3]];
    picture.coverage = Some(vec![0.0, 1.0, 0.5]);
    picture.take_out(glam::Vec3::new(0.2, 0.4, 0.8));
    let frame = picture.into_frame();
    assert_eq!(frame.alpha(), Some(&[0.0, 1.0, 0.5][..]));
    let half = [0.25_f32 - 0.5 * 0.2, 0.25 - 0.5 * 0.4, 0.0];
    assert_eq!(frame.color(), [[0.0; 3], [0.6, 0.5, 0.4], half]);
}
