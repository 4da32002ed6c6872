//! Pairwise coverage: few combinations of choices, in which every pair of two choices occurs.
//!
//! Greedy, as in AETG (Cohen, Dalal, Fredman and Patton, "The AETG System", 1997): of some random rows, take the one that covers most pairs
//! that no row has covered yet.

use std::collections::BTreeSet;

use lightmesh_testkit::Random;

/// Random rows from which each is chosen.
const CANDIDATES: usize = 40;

/// Two factors with the level of each.
type Pair = [(usize, usize); 2];

/// Rows with a level for each factor, below its number of `levels`: every two levels of two factors are in a row.
pub(crate) fn rows(levels: &[usize], seed: u64) -> Vec<Vec<usize>> {
    let mut random = Random::new(seed);
    let mut open = BTreeSet::new();
    for (first, &levels_of_first) in levels.iter().enumerate() {
        for (second, &levels_of_second) in levels.iter().enumerate().skip(first + 1) {
            open.extend(
                (0..levels_of_first).flat_map(|a| (0..levels_of_second).map(move |b| [(first, a), (second, b)])),
            );
        }
    }
    let mut rows = Vec::new();
    while let Some(&pair) = open.iter().next() {
        let candidates: Vec<_> = (0..CANDIDATES).map(|_| candidate(levels, pair, &mut random)).collect();
        let best = candidates.into_iter().max_by_key(|row| pairs(row).filter(|pair| open.contains(pair)).count());
        let row = best.expect("there are candidates");
        open.retain(|pair| !pairs(&row).any(|covered| covered == *pair));
        rows.push(row);
    }
    rows
}

/// A random row that has a pair.
fn candidate(levels: &[usize], pair: Pair, random: &mut Random) -> Vec<usize> {
    let mut row: Vec<usize> = levels.iter().map(|&count| (random.unit() * count as f64) as usize).collect();
    pair.into_iter().for_each(|(factor, level)| row[factor] = level);
    row
}

fn pairs(row: &[usize]) -> impl Iterator<Item = Pair> + '_ {
    let factors = || row.iter().copied().enumerate();
    factors().flat_map(move |first| factors().skip(first.0 + 1).map(move |second| [first, second]))
}
