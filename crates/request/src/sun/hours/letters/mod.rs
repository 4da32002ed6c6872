//! Letters as dots: `misc-fixed` of the X Window System, which is in the public domain (`6x10.bdf` and `10x20.bdf`, collected by M. Kuhn,
//! <https://gitlab.freedesktop.org/xorg/font/misc-misc>).

/// Letters of one size: the printable ones of ASCII, in an image with 16 in a row.
pub(super) struct Letters {
    /// Columns of dots per letter.
    pub(super) width: usize,
    /// Rows of dots per letter.
    pub(super) height: usize,
    /// The image, of which each bit is a dot, and each byte begins with its highest bit.
    dots: &'static [u8],
}

pub(super) const SMALL: Letters = Letters::new(6, 10, include_bytes!("6x10.pbm"), b"P4\n96 60\n");
pub(super) const LARGE: Letters = Letters::new(10, 20, include_bytes!("10x20.pbm"), b"P4\n160 120\n");

const PER_ROW: usize = 16;
/// The first letter of the image.
const FIRST: char = ' ';
const LAST: char = '\x7f';
/// Stands for letters that are not in the image.
const OTHER: char = '?';

impl Letters {
    /// From a file of PBM after its header.
    const fn new(width: usize, height: usize, file: &'static [u8], header: &[u8]) -> Letters {
        let (_, dots) = file.split_at(header.len());
        assert!(8 * dots.len() == width * height * (LAST as usize + 1 - FIRST as usize));
        Letters { width, height, dots }
    }

    /// Column and row of each dot of a letter.
    pub(super) fn dots(&self, letter: char) -> impl Iterator<Item = [usize; 2]> {
        let letter = if (FIRST..=LAST).contains(&letter) { letter } else { OTHER };
        let number = letter as usize - FIRST as usize;
        let (left, top) = (number % PER_ROW * self.width, number / PER_ROW * self.height);
        (0..self.width * self.height).map(|dot| [dot % self.width, dot / self.width]).filter(move |[x, y]| {
            let bit = (top + y) * PER_ROW * self.width + left + x;
            self.dots[bit / 8] >> (7 - bit % 8) & 1 == 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(letters: &Letters, letter: char) -> Vec<String> {
        let mut rows = vec![vec!['.'; letters.width]; letters.height];
        letters.dots(letter).for_each(|[x, y]| rows[y][x] = '#');
        rows.into_iter().map(String::from_iter).collect()
    }

    #[test]
    #[rustfmt::skip]
    fn letters_are_drawn_as_published() {
        assert_eq!(drawn(&SMALL, 'h'), [
            "......",
            "#.....",
            "#.....",
            "#.##..",
            "##..#.",
            "#...#.",
            "#...#.",
            "#...#.",
            "......",
            "......",
        ]);
        assert_eq!(drawn(&SMALL, '7'), [
            "......",
            "#####.",
            "....#.",
            "...#..",
            "...#..",
            "..#...",
            ".#....",
            ".#....",
            "......",
            "......",
        ]);
        assert_eq!(drawn(&LARGE, '7'), [
            "..........",
            "..........",
            "..........",
            ".########.",
            ".......##.",
            ".......##.",
            "......##..",
            "......##..",
            ".....##...",
            ".....##...",
            "....##....",
            "....##....",
            "...##.....",
            "...##.....",
            "..##......",
            "..##......",
            "..........",
            "..........",
            "..........",
            "..........",
        ]);
        assert!(SMALL.dots(' ').next().is_none());
        assert_eq!(drawn(&SMALL, 'é'), drawn(&SMALL, '?'));
    }
}
