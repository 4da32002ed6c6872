use lightmesh_scene::internals::smooth::Buckets;

#[test]
fn corners_are_listed_by_key() {
    let keys = [Some(2), None, Some(0), Some(2), Some(3)];
    let mut lists = Vec::new();
    Buckets::new(5, keys.len(), |corner| keys[corner as usize]).each(|_, list| lists.push(list.to_vec()));
    assert_eq!(lists, [vec![2], vec![], vec![0, 3], vec![4], vec![]]);
}
