use lightmesh_render::{LightGroup, LightGroups};

#[test]
fn every_light_is_in_one_group() {
    let ranges = |lights, at_once| {
        let groups = LightGroups { lights, at_once };
        assert!(groups.iter().all(|group| group.of(lights).len() <= groups.held()));
        groups.iter().map(|group| (group.of(lights).start, group.of(lights).end)).collect::<Vec<_>>()
    };
    assert_eq!(ranges(0, 4), [(0, 0)]);
    assert_eq!(ranges(3, 4), [(0, 3)]);
    assert_eq!(ranges(8, 4), [(0, 4), (4, 8)]);
    assert_eq!(ranges(9, 4), [(0, 4), (4, 8), (8, 9)]);
    assert_eq!(ranges(9, usize::MAX), [(0, 9)]);
    assert_eq!(LightGroup::ALL.of(9), 0..9);
}
