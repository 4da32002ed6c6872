use lightmesh_image::Matte;

#[test]
fn large_shares_come_first_and_nothing_last() {
    let mut matte = Matte::nothing(vec![String::new(); 9], 4, 1);
    for (rank, seen) in matte.ranks.iter_mut().zip([(7, 0.25), (0, 0.0), (3, 0.5), (2, 0.25)]) {
        (rank.number[0], rank.share[0]) = seen;
    }
    matte.sort(0);
    let seen: Vec<(u32, f32)> = matte.ranks.iter().map(|rank| (rank.number[0], rank.share[0])).collect();
    assert_eq!(seen, [(3, 0.5), (2, 0.25), (7, 0.25), (0, 0.0)]);
}
