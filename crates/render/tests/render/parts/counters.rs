use lightmesh_layout::counters::Counters;
use lightmesh_render::{Counts, Tally};

#[test]
fn what_is_done_again_is_not_counted_twice() {
    let tally = Tally::default();
    Tally::add(&tally.rays, 3);
    let before = tally.snapshot();
    Tally::add(&tally.rays, 4);
    tally.restore(&before);
    tally.add_all(&Counters { rays: 5, overruns: 1, ..before });
    assert_eq!((Tally::get(&tally.rays), Tally::get(&tally.overruns)), (8, 1));
}

#[test]
fn means_are_over_the_surface_points() {
    let counters = Counters { surface_points: 4, used: 10, hits: 3, ..Tally::default().snapshot() };
    let counts = Counts::new(16, 88, &counters);
    assert_eq!((counts.pixels, counts.template, counts.hits, counts.used_mean), (16, 88, 3, 2.5));
    assert_eq!(counts.values().len(), Counters::NAMES.len() + 3);
    assert_eq!(Counts::new(1, 0, &Tally::default().snapshot()).used_mean, 0.0);
}
