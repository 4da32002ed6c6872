use lightmesh_render::internals::stages::transposed;

#[test]
fn bits_change_places_with_bytes() {
    for byte in 0..8 {
        for bit in 0..8 {
            assert_eq!(transposed(1 << (8 * byte + bit)), 1 << (8 * bit + byte));
        }
    }
}
