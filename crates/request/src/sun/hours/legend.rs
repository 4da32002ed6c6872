//! What is beside and below the colours: a scale with hours, and what the image shows.

use super::colors::viridis;
use super::letters::{LARGE, Letters, SMALL};

/// Paper and ink.
const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];
/// Hours between marks, of which the first that leaves room for its labels is taken.
const MARKS: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 12.0];
/// Shorter images get small letters.
const SHORT: usize = 360;
/// Scales are not shorter, however low the image.
const SHORTEST: usize = 80;

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
        let letters = if width.min(height) < SHORT { SMALL } else { LARGE };
        Canvas { width, height, codes, scale: (width.min(height) / 1200).max(1), letters }
    }

    /// With a scale for values from 0 to `most` on its right, and `caption` below.
    pub(super) fn with_legend(self, most: f64, caption: &str) -> Canvas {
        let (image, [_, high]) = ([self.width, self.height], self.letter());
        let strip = self.columns("000.0") + 4 * high;
        let mut all = self.grown(image[0] + strip, image[1].max(SHORTEST + 4 * high));
        let image = [image[0], all.height];
        all.scale_of_hours(image, most);
        // Below everything, in as many lines as are needed.
        let lines = wrapped(caption, (all.width.saturating_sub(high) / all.letter()[0]).max(8));
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

    /// A bar of all colours to the right of an image of this size, with marks and numbers.
    fn scale_of_hours(&mut self, [width, height]: [usize; 2], most: f64) {
        let [_, high] = self.letter();
        self.text("hours", [width + high, high / 2]);
        let (left, bar) = (width + high, high);
        let (top, bottom) = (2 * high, height - high);
        let length = bottom - top;
        let row_of = |hours: f64| bottom - (hours / most * length as f64).round() as usize;
        for row in top..bottom {
            let color = viridis((bottom - row) as f64 / length as f64);
            self.fill([left, row], [bar, 1], color);
        }
        let mark = MARKS.into_iter().find(|mark| mark / most * length as f64 >= 1.5 * high as f64).unwrap_or(24.0);
        let mut labels: Vec<f64> =
            (0..).map(|number| f64::from(number) * mark).take_while(|hours| *hours <= most).collect();
        // The end, unless a mark is too close.
        if labels.last().is_some_and(|&last| row_of(last) >= top + high) {
            labels.push(most);
        }
        for hours in labels {
            let row = row_of(hours);
            self.fill([left + bar, row.min(bottom - 1)], [high / 3, self.scale], BLACK);
            self.text(&number(hours), [left + bar + high / 2, row - high / 2]);
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

    #[test]
    fn lines_are_broken_between_words() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("incredible", 3), ["incredible"]);
        assert_eq!([13.4, 2.0, 0.25, 10.0].map(number), ["13.4", "2", "0.25", "10"]);
    }
}
