use lightmesh_render::internals::stages::blocks_of_pixels;

#[test]
fn blocks_hold_every_pixel_of_their_rows_once() {
    for (width, rows) in [(1, 0..1), (7, 3..6), (33, 0..35), (64, 16..48)] {
        let mut pixels = blocks_of_pixels(width, rows.clone());
        pixels.sort_unstable();
        assert!(pixels.into_iter().eq(rows.start * width..rows.end * width));
    }
    assert_eq!(blocks_of_pixels(32, 0..2)[..9], [0, 1, 2, 3, 32, 33, 34, 35, 4]);
}
