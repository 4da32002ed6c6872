use std::collections::BTreeSet;

use glam::IVec3;
use lightmesh_render::light_mesh::{BrickKey, BrickMap, UsedPoints, brick_of, point_bit, point_key, point_of};

#[test]
fn a_point_comes_back_from_its_brick_and_bit() {
    for index in [[0, 0, 0], [3, 2, 1], [4, 7, 1001], [-1, -4, -5], [1_048_575, -1_048_576, 1_048_573]] {
        let index = IVec3::from_array(index);
        assert_eq!(point_of(point_key(index)), index);
        assert_eq!(point_key(index) >> 6, brick_of(index));
    }
}

#[test]
fn the_map_finds_what_is_there_and_nothing_else() {
    let keys: BTreeSet<BrickKey> = (0..5000u64).map(|i| i * i * 7919 % (1 << 63)).collect();
    let map = BrickMap::new(keys.iter().copied().collect());
    for (index, &key) in keys.iter().enumerate() {
        assert_eq!(map.find(key), Some(index));
    }
    assert_eq!((0..20_000).filter(|key| map.find(*key).is_some()).count(), keys.range(..20_000).count());
    assert_eq!(BrickMap::new(Vec::new()).find(0), None);
}

#[test]
fn ranks_count_the_used_points_before() {
    let points = [[0, 0, 0], [1, 0, 0], [3, 3, 3], [4, 0, 0], [5, 1, 0], [0, 0, 9]].map(IVec3::from_array);
    let keys: BTreeSet<BrickKey> = points.iter().map(|&point| brick_of(point)).collect();
    let bricks = BrickMap::new(keys.into_iter().collect());
    let mut used = vec![0; bricks.keys().len()];
    for &point in &points {
        used[bricks.find(brick_of(point)).unwrap()] |= 1 << point_bit(point);
    }
    let used = UsedPoints::new(bricks, used);
    assert_eq!(used.count(), points.len());
    let listed: Vec<IVec3> = (0..used.used().len()).flat_map(|brick| used.points(brick)).collect();
    for (rank, &point) in listed.iter().enumerate() {
        let brick = used.bricks().find(brick_of(point)).unwrap();
        assert_eq!(used.rank(brick, point_bit(point)), rank);
    }
    assert_eq!(listed.iter().map(IVec3::to_array).collect::<BTreeSet<_>>().len(), points.len());
}
