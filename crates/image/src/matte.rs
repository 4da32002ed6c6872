//! What pixels see, by name: objects or materials.

/// The most ranks of a matte.
pub const MAX_RANKS: usize = 6;

/// Which of some named things, objects or materials, pixels see. Things are numbered from 1; 0 is nothing. All fields are empty if nothing is
/// known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matte {
    /// The names: that of thing n is number n − 1. Some may be the same: Cryptomattes, which tell things by name, do not tell these apart.
    pub names: Vec<String>,
    /// What the nearest sample of each pixel sees.
    pub nearest: Vec<u32>,
    /// What the samples of each pixel see, from the largest share to the smallest: at most [`MAX_RANKS`].
    pub ranks: Vec<Rank>,
}

/// One thing that each pixel sees.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rank {
    /// Its number; 0 if a pixel sees no more things.
    pub number: Vec<u32>,
    /// The share of the pixel that it covers, in [0, 1].
    pub share: Vec<f32>,
}

impl Matte {
    /// A matte of `ranks` ranks in which `pixels` pixels see nothing.
    pub fn nothing(names: Vec<String>, ranks: usize, pixels: usize) -> Matte {
        let rank = Rank { number: vec![0; pixels], share: vec![0.0; pixels] };
        Matte { names, nearest: vec![0; pixels], ranks: vec![rank; ranks] }
    }

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.nearest.is_empty() && self.ranks.is_empty()
    }

    /// The share of each pixel that one thing covers.
    ///
    /// ```
    /// use lightmesh_image::Matte;
    ///
    /// let mut matte = Matte::nothing(vec!["floor".to_owned(), "box".to_owned()], 2, 1);
    /// (matte.ranks[0].number[0], matte.ranks[0].share[0]) = (2, 0.75);
    /// (matte.ranks[1].number[0], matte.ranks[1].share[0]) = (1, 0.25);
    /// assert_eq!((matte.of(1), matte.of(2)), (vec![0.25], vec![0.75]));
    /// ```
    pub fn of(&self, number: u32) -> Vec<f32> {
        let mut shares = vec![0.0; self.ranks.first().map_or(0, |rank| rank.share.len())];
        for rank in &self.ranks {
            for ((sum, &found), &share) in shares.iter_mut().zip(&rank.number).zip(&rank.share) {
                if found == number {
                    *sum += share;
                }
            }
        }
        shares
    }

    /// Sorts what a pixel sees: large shares first, equal ones by number.
    pub fn sort(&mut self, pixel: usize) {
        let mut seen = [(0, 0.0); MAX_RANKS];
        let seen = &mut seen[..self.ranks.len().min(MAX_RANKS)];
        for (seen, rank) in seen.iter_mut().zip(&self.ranks) {
            *seen = (rank.number[pixel], rank.share[pixel]);
        }
        // What is nothing comes last.
        seen.sort_by(|a, b| b.1.total_cmp(&a.1).then((a.0 == 0).cmp(&(b.0 == 0))).then(a.0.cmp(&b.0)));
        for (seen, rank) in seen.iter().zip(&mut self.ranks) {
            (rank.number[pixel], rank.share[pixel]) = *seen;
        }
    }

    /// The planes with their names and lengths.
    pub(crate) fn lengths(&self, name: &str) -> Vec<(String, usize)> {
        let ranks = self.ranks.iter().enumerate().flat_map(|(number, rank)| {
            let of = |plane: &str, length| (format!("{name}.ranks[{number}].{plane}"), length);
            [of("number", rank.number.len()), of("share", rank.share.len())]
        });
        let nearest = (!self.nearest.is_empty()).then(|| (format!("{name}.nearest"), self.nearest.len()));
        nearest.into_iter().chain(ranks).collect()
    }

    /// The same with the pixels that `cut` takes out of planes.
    pub(crate) fn cut(&self, numbers: impl Fn(&[u32]) -> Vec<u32>, shares: impl Fn(&[f32]) -> Vec<f32>) -> Matte {
        let ranks = self.ranks.iter().map(|rank| Rank { number: numbers(&rank.number), share: shares(&rank.share) });
        Matte { names: self.names.clone(), nearest: numbers(&self.nearest), ranks: ranks.collect() }
    }
}
