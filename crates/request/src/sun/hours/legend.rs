//! What is beside and below the colours: a scale with hours, and what the image shows.

use super::colors::viridis;
use super::letters::{LARGE, Letters, SMALL};

/// Paper and ink.
const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];
/// Hours between marks, of which the first that leaves room for its labels is taken.
const MARKS: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 12.0];
/// Letters are at most one part in this many of the image's shorter side, unless they could not be read.
const LETTERS: usize = 36;
/// Scales are not shorter than so many letters are high, however low the image.
const SHORTEST: usize = 5;

/// What stands above a scale.
const HEADING: &str = "hours";
/// Letters that its bar is wide.
const BAR: usize = 2;

/// A scale of hours.
struct Scale {
    /// Those of the most hours, and of none.
    rows: [usize; 2],
    most: f64,
    /// The hours that have a mark.
    labels: Vec<f64>,
}

impl Scale {
    /// With marks as close as numbers of `high` rows allow.
    fn new(rows: [usize; 2], most: f64, high: usize) -> Scale {
        let length = (rows[1] - rows[0]) as f64;
        let mark = MARKS.into_iter().find(|mark| mark / most * length >= 1.5 * high as f64).unwrap_or(24.0);
        let labels = (0..).map(|number| f64::from(number) * mark).take_while(|hours| *hours <= most).collect();
        let mut scale = Scale { rows, most, labels };
        // The end, unless a mark is too close.
        if scale.labels.last().is_some_and(|&last| scale.row_of(last) >= rows[0] + high) {
            scale.labels.push(most);
        }
        scale
    }

    fn row_of(&self, hours: f64) -> usize {
        let [top, bottom] = self.rows;
        bottom - (hours / self.most * (bottom - top) as f64).round() as usize
    }
}

/// An image in sRGB codes that grows by a legend.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    codes: Vec<[u8; 3]>,
    /// Pixels per dot of a letter.
    scale: usize,
    letters: Letters,
}

impl Canvas {
    /// The codes row by row.
    pub(super) fn new(width: usize, codes: Vec<[u8; 3]>) -> Canvas {
        let height = codes.len() / width;
        let high = width.min(height) / LETTERS;
        let letters = if high < LARGE.height { SMALL } else { LARGE };
        // Between the two, small letters stay as they are: twice as large, they are no smaller than large ones.
        let scale = if high < LARGE.height { 1 } else { high / LARGE.height };
        Canvas { width, height, codes, scale, letters }
    }

    /// With a scale for values from 0 to `most` on its right, and `caption` below.
    pub(super) fn with_legend(self, most: f64, caption: &str) -> Canvas {
        let (width, [wide, high]) = (self.width, self.letter());
        let height = self.height.max((SHORTEST + 3) * high);
        let scale = Scale::new([2 * high, height - high], most, high);
        // Either the heading is the widest, or bar, marks and the longest label.
        let labels = scale.labels.iter().map(|&hours| self.columns(&number(hours))).max().unwrap_or_default();
        let strip = self.columns(HEADING).max(BAR * wide + wide + labels);
        let mut all = self.grown(width + strip + 2 * wide, height);
        all.draw(&scale, width + wide);
        // Below everything, in as many lines as are needed.
        let lines = wrapped(caption, (all.width.saturating_sub(high) / wide).max(8));
        let top = all.height;
        let size = [all.width, all.height + high / 2 + lines.len() * high + high / 2];
        let mut all = all.grown(size[0], size[1]);
        for (number, line) in lines.iter().enumerate() {
            all.text(line, [high / 2, top + high / 2 + number * high]);
        }
        all
    }

    /// Width, and height and codes row by row.
    pub(super) fn into_codes(self) -> ([usize; 2], Vec<[u8; 3]>) {
        ([self.width, self.height], self.codes)
    }

    /// A bar of all colours from column `left` on, with marks and numbers.
    fn draw(&mut self, scale: &Scale, left: usize) {
        let [wide, high] = self.letter();
        self.text(HEADING, [left, high / 2]);
        let Scale { rows: [top, bottom], labels, .. } = scale;
        let bar = BAR * wide;
        for row in *top..*bottom {
            let color = viridis((bottom - row) as f64 / (bottom - top) as f64);
            self.fill([left, row], [bar, 1], color);
        }
        for &hours in labels {
            let row = scale.row_of(hours);
            self.fill([left + bar, row.min(bottom - 1)], [wide / 2, self.scale], BLACK);
            self.text(&number(hours), [left + bar + wide, row - high / 2]);
        }
    }

    /// Width and height of a letter in pixels.
    fn letter(&self) -> [usize; 2] {
        [self.letters.width * self.scale, self.letters.height * self.scale]
    }

    fn columns(&self, text: &str) -> usize {
        text.len() * self.letter()[0]
    }

    /// White is added to the right and below.
    fn grown(self, width: usize, height: usize) -> Canvas {
        let mut codes = vec![WHITE; width * height];
        for (to, from) in codes.chunks_exact_mut(width).zip(self.codes.chunks_exact(self.width)) {
            to[..self.width].copy_from_slice(from);
        }
        Canvas { width, height, codes, ..self }
    }

    fn fill(&mut self, [left, top]: [usize; 2], [width, height]: [usize; 2], color: [u8; 3]) {
        for row in top..(top + height).min(self.height) {
            self.codes[row * self.width..][left..(left + width).min(self.width)].fill(color);
        }
    }

    /// Writes a line from its upper left corner on, as far as there is room.
    fn text(&mut self, text: &str, [left, top]: [usize; 2]) {
        let ([wide, _], scale) = (self.letter(), self.scale);
        for (number, letter) in text.chars().enumerate() {
            let dots: Vec<[usize; 2]> = self.letters.dots(letter).collect();
            for [x, y] in dots {
                let place = [left + number * wide + x * scale, top + y * scale];
                if place[0] < self.width {
                    self.fill(place, [scale; 2], BLACK);
                }
            }
        }
    }
}

/// Hours with two digits after the point at most.
fn number(hours: f64) -> String {
    let text = format!("{hours:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Lines of at most so many letters, as far as words are shorter.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= letters => *line = format!("{line} {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_image_stays_as_it_is_beside_its_legend() {
        for side in [1, 7, 400, 2500] {
            let image: Vec<[u8; 3]> = (0..side * side).map(|pixel| [pixel as u8, 7, (pixel / side) as u8]).collect();
            let canvas = Canvas::new(side, image.clone()).with_legend(13.4, "a caption of several words");
            let ([width, height], codes) = canvas.into_codes();
            assert!(width > side && height > side && codes.len() == width * height);
            let inside = codes.chunks(width).take(side).flat_map(|row| &row[..side]);
            assert!(inside.eq(&image), "{side}");
            let rest = codes.chunks(width).flat_map(|row| &row[side..]);
            assert!(rest.filter(|code| **code == [0; 3]).count() > 50, "{side}: there is text");
        }
    }

    /// Neither large beside a small image, nor too small to be read.
    #[test]
    fn the_legend_is_of_the_size_of_its_image() {
        let added = |side: usize| {
            let canvas = Canvas::new(side, vec![BLACK; side * side]);
            let letter = canvas.letter()[1];
            let ([width, _], _) = canvas.with_legend(13.4, "a caption").into_codes();
            (width - side, letter)
        };
        for side in [240, 360, 512, 719, 720, 1024, 1440, 2160, 4000] {
            let (strip, letter) = added(side);
            assert!(
                5 * strip <= side && letter >= 10 && LETTERS * letter <= side.max(360),
                "{side}: {strip}, {letter}"
            );
            assert!(100 * letter >= side, "{side}: {letter}");
        }
        let (strip, letter) = added(16);
        assert!(strip < 60 && letter == 10, "{strip}, {letter}");
    }

    #[test]
    fn lines_are_broken_between_words() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("incredible", 3), ["incredible"]);
        assert_eq!([13.4, 2.0, 0.25, 10.0].map(number), ["13.4", "2", "0.25", "10"]);
    }
}
