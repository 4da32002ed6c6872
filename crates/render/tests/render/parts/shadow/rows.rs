use std::sync::Arc;

use lightmesh_layout::constants::{MAX_OF_ROW, MAX_ROWS};
use lightmesh_layout::scene::SampleRows;
use lightmesh_render::internals::shadow::{KnownRows, MAX_KNOWN, Rows};

const NUMBERS: [u32; 12] = [1, 2, 3, 5, 16, 17, 64, 225, 256, 300, 1000, 65535];

#[test]
fn rows_that_are_kept_are_those_of_their_number() {
    let known = KnownRows::default();
    let count = |rows: &Rows| rows.disc.iter().flat_map(|set| set.count).sum::<u32>();
    for samples in (1..=20).chain(1..=20) {
        assert_eq!(count(&known.of(samples)), samples);
    }
    let first = known.of(1);
    assert!(Arc::ptr_eq(&first, &known.of(1)), "rows are found once");
    (2..=MAX_KNOWN as u32 + 1).for_each(|samples| drop(known.of(samples)));
    assert!(!Arc::ptr_eq(&first, &known.of(1)), "no more than these are kept");
}

#[test]
fn renderers_have_rows_of_their_own() {
    let [one, other] = [KnownRows::default(), KnownRows::default()];
    assert!(!Arc::ptr_eq(&one.of(16), &other.of(16)));
}

#[test]
fn every_sample_has_a_bit() {
    for samples in NUMBERS {
        let Rows { disc, rectangle, .. } = Rows::new(samples);
        let total = |sets: &[SampleRows]| sets.iter().flat_map(|set| set.count).sum::<u32>();
        assert_eq!(total(&disc), samples);
        let [first, ..] = rectangle[..] else { panic!("no rows") };
        let count = rectangle[0].count[0];
        assert_eq!(total(&rectangle) - count, samples + first.surplus, "{samples}");
        assert!(first.surplus < first.lines, "{samples}: {}", first.surplus);
        for set in disc.iter().chain(&rectangle) {
            let mut first = 0;
            for word in 0..set.words as usize {
                let rows = first..set.ends[word] as usize;
                let mut bits = 0u32;
                for row in rows {
                    let own = ((1u64 << set.count[row]) - 1) << set.place[row];
                    assert!(own <= u64::from(u32::MAX) && bits & own as u32 == 0 && set.count[row] <= MAX_OF_ROW);
                    bits |= own as u32;
                }
                first = set.ends[word] as usize;
            }
            assert_eq!(first, set.rows as usize);
        }
        for (sets, what) in [(&disc, "disc"), (&rectangle, "rectangle")] {
            if samples <= 256 {
                assert_eq!(sets.len(), 1, "{samples} samples of a {what}");
            }
        }
        let edges = |choose: fn(&SampleRows) -> u32| rectangle.iter().filter(|set| choose(set) < MAX_ROWS).count();
        assert_eq!((edges(|set| set.entering), edges(|set| set.leaving)), (1, 1), "{samples}");
    }
}

#[test]
fn the_usual_numbers_have_few_words() {
    for (samples, words) in [(16, [1, 1]), (64, [2, 3]), (256, [10, 9])] {
        let Rows { disc, rectangle, .. } = Rows::new(samples);
        assert_eq!([disc[0].words, rectangle[0].words], words, "{samples} samples");
    }
    let mut counts = Rows::new(64).disc[0].count;
    counts.sort_unstable_by(|a, b| b.cmp(a));
    assert_eq!(counts[..9], [10, 10, 9, 9, 8, 8, 5, 5, 0]);
}

#[test]
fn rows_halve_their_strips() {
    for samples in [1, 16, 225] {
        let set = &Rows::new(samples).disc[0];
        let rows = 0..set.rows as usize;
        // The mean height of the samples is that of the disc, and so is the mean square, nearly.
        let mean = |f: fn(f32) -> f32| {
            rows.clone().map(|row| set.count[row] as f32 * f(set.y[row])).sum::<f32>() / samples as f32
        };
        assert!(mean(|y| y).abs() < 1e-5, "{samples}");
        assert!((mean(|y| y * y) - 0.25).abs() < if samples > 100 { 0.005 } else { 0.26 }, "{samples}");
    }
}
