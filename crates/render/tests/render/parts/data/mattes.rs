use lightmesh_image::Matte;
use lightmesh_render::internals::data::{Counted, count, take_away};
use rayon::prelude::*;

fn seen(matte: &Matte, pixel: usize) -> Vec<(u32, f32)> {
    matte.ranks.iter().map(|rank| (rank.number[pixel], rank.share[pixel])).collect()
}

/// Counts samples of the last pixel.
fn count_all(counted: &mut Counted, all: impl IntoIterator<Item = [u32; 2]>) {
    let mut pixels: Vec<_> = counted.pixels().collect();
    let slots = pixels.last_mut().unwrap();
    all.into_iter().for_each(|ids| count(slots, ids));
}

#[test]
fn samples_are_counted_by_what_they_see() {
    let mut counted = Counted::none(16, 2);
    count_all(&mut counted, [3, 2, 2, 7, 3, 2, 9].map(|object| [object, 1]));
    let mut mattes = [6, 6].map(|ranks| Matte::nothing(Vec::new(), ranks, 3));
    let [objects, materials] = &mut mattes;
    counted.write([objects, materials], 1);
    let share = |count: u32| count as f32 / 16.0;
    let rest = [(0, 0.0); 5];
    assert_eq!(seen(objects, 2), [(2, share(3)), (3, share(2)), (7, share(1)), (9, share(1)), rest[0], rest[1]]);
    assert_eq!((seen(materials, 2)[0], &seen(materials, 2)[1..]), ((1, share(7)), &rest[..]));
    assert!(seen(objects, 0).iter().chain(&seen(objects, 1)).all(|seen| *seen == (0, 0.0)));
}

#[test]
fn the_largest_six_of_eight_are_kept_and_others_are_not_counted() {
    let mut counted = Counted::none(64, 1);
    count_all(&mut counted, (1..=9).flat_map(|object| (0..object).map(move |_| [object, 0])));
    let mut mattes = [6, 6].map(|ranks| Matte::nothing(Vec::new(), ranks, 1));
    let [objects, materials] = &mut mattes;
    counted.write([objects, materials], 0);
    assert_eq!(seen(objects, 0).iter().map(|seen| seen.0).collect::<Vec<_>>(), [8, 7, 6, 5, 4, 3]);
}

#[test]
fn what_is_caught_is_taken_away() {
    let mut matte = Matte::nothing(Vec::new(), 3, 1);
    for (rank, seen) in matte.ranks.iter_mut().zip([(4, 0.5), (2, 0.375), (5, 0.125)]) {
        (rank.number[0], rank.share[0]) = seen;
    }
    take_away(&mut matte, &[4, 5], 0, 0.25);
    assert_eq!(seen(&matte, 0), [(2, 0.375), (4, 0.25), (5, 0.125)]);
    take_away(&mut matte, &[4, 5], 0, 0.3125);
    assert_eq!(seen(&matte, 0), [(2, 0.375), (5, 0.0625), (0, 0.0)]);
}
