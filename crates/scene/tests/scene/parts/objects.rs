use lightmesh_scene::internals::objects::append;
use lightmesh_scene::{ObjectKey, Objects, UNNAMED};

fn objects(runs: &[(usize, &str)]) -> Objects {
    let mut objects = Objects::default();
    runs.iter().for_each(|&(first, name)| objects.begin(first, name));
    objects
}

#[test]
fn every_triangle_has_an_object() {
    let none = Objects::default();
    assert_eq!((none.count(), none.name(none.of(7)), none.runs()), (1, UNNAMED, (&[][..], &[][..])));
    let late = objects(&[(3, "a"), (5, "")]);
    assert_eq!([0, 2, 3, 4, 5].map(|triangle| late.of(triangle)), [0, 0, 1, 1, 0]);
    assert_eq!(late.names().collect::<Vec<_>>(), [UNNAMED, "a"]);
}

#[test]
fn objects_of_one_name_are_one() {
    let found = objects(&[(0, "a"), (2, "b"), (4, "a"), (6, "a"), (8, "c"), (8, "a")]);
    assert_eq!([0, 2, 4, 6, 9].map(|triangle| found.of(triangle)), [0, 1, 0, 0, 0]);
    assert_eq!(found.runs(), (&[0, 2, 4][..], &[0, 1, 0][..]));
}

#[test]
fn runs_without_triangles_leave_no_trace_in_runs() {
    let found = objects(&[(0, "a"), (2, "b"), (2, "c"), (1, "d")]);
    assert_eq!((found.runs().0, found.name(found.of(2)), found.name(found.of(1))), (&[0, 2][..], "d", "a"));
}

#[test]
fn a_mesh_continues_another() {
    let mut whole = objects(&[(0, "a")]);
    // Of its triangles 0 to 5, the second and third are left out.
    append(&mut whole, 10, &objects(&[(0, "b"), (1, "c"), (3, "a")]), |triangle| [0, 1, 1, 1, 2, 3][triangle as usize]);
    assert_eq!([9, 10, 11, 12].map(|triangle| whole.name(whole.of(triangle))), ["a", "b", "a", "a"]);
}

#[test]
fn objects_with_keys_of_their_own_share_a_name() {
    let mut found = Objects::default();
    for (first, key) in [(0, ObjectKey::numbered("a", 1)), (1, ObjectKey::numbered("a", 2)), (2, "a".into())] {
        found.begin(first, key);
    }
    found.begin(3, ObjectKey::numbered("a", 1));
    assert_eq!([0, 1, 2, 3].map(|triangle| found.of(triangle)), [0, 1, 2, 0]);
    assert_eq!(found.names().collect::<Vec<_>>(), ["a"; 3]);
    let mut whole = objects(&[(0, "a")]);
    append(&mut whole, 1, &found, |triangle| triangle as usize);
    assert_eq!([0, 1, 2, 3, 4].map(|triangle| whole.of(triangle)), [0, 1, 2, 0, 1]);
}
