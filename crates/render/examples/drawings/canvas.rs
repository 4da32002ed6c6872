//! A page to draw on: shapes in world coordinates, y up, and text. Their style is defined by classes of `style.css`.
//!
//! Elements are written as text: the `svg` crate puts visible white space between the parts of a label.

use std::fmt::Write;

use glam::{Vec2, vec2};

/// The part of a label that its position refers to.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A drawing under construction.
pub(crate) struct Canvas {
    svg: String,
    /// Pixels per world unit.
    scale: f32,
    /// Pixel of the world's origin.
    origin: Vec2,
}

impl Canvas {
    /// An empty page of `size` pixels. `title` is the text for screen readers.
    pub(crate) fn new(title: &str, [width, height]: [u32; 2]) -> Canvas {
        let view = format!(r#"viewBox="0 0 {width} {height}" width="{width}" height="{height}""#);
        let page = format!(r#"<rect class="page" width="{width}" height="{height}"/>"#);
        let style = include_str!("style.css");
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" {view} role=\"img\">\n<title>{}</title>\n<style>\n{style}</style>\n{page}\n",
            escaped(title)
        );
        Canvas { svg, scale: 1.0, origin: Vec2::ZERO }
    }

    /// Subsequent shapes are in a world of `scale` pixels per unit, whose origin is at the pixel `origin`.
    pub(crate) fn place(&mut self, scale: f32, origin: Vec2) {
        (self.scale, self.origin) = (scale, origin);
    }

    pub(crate) fn line(&mut self, class: &str, from: Vec2, to: Vec2) {
        let (a, b) = (self.pixel(from), self.pixel(to));
        self.element(class, &format!(r#"line x1="{}" y1="{}" x2="{}" y2="{}""#, a.x, a.y, b.x, b.y));
    }

    pub(crate) fn polygon(&mut self, class: &str, corners: &[Vec2]) {
        let points = corners.iter().map(|&corner| self.pixel(corner)).map(|pixel| format!("{},{}", pixel.x, pixel.y));
        let points = points.collect::<Vec<_>>().join(" ");
        self.element(class, &format!(r#"polygon points="{points}""#));
    }

    /// A rectangle between two opposite corners.
    pub(crate) fn rectangle(&mut self, class: &str, low: Vec2, high: Vec2) {
        self.polygon(class, &[low, vec2(high.x, low.y), high, vec2(low.x, high.y)]);
    }

    /// A disk with its radius in pixels.
    pub(crate) fn dot(&mut self, class: &str, middle: Vec2, radius: f32) {
        let middle = self.pixel(middle);
        self.element(class, &format!(r#"circle cx="{}" cy="{}" r="{radius}""#, middle.x, middle.y));
    }

    /// A disk with its radius in world units.
    pub(crate) fn disk(&mut self, class: &str, middle: Vec2, radius: f32) {
        self.dot(class, middle, rounded(radius * self.scale));
    }

    /// The half of a disk on the side of the unit vector `up`.
    pub(crate) fn half_disk(&mut self, class: &str, middle: Vec2, radius: f32, up: Vec2) {
        let (a, b) = (self.pixel(middle + radius * up.perp()), self.pixel(middle - radius * up.perp()));
        let radius = rounded(radius * self.scale);
        self.element(class, &format!(r#"path d="M{} {}A{radius} {radius} 0 0 1 {} {}Z""#, a.x, a.y, b.x, b.y));
    }

    /// A line with an arrowhead at its end.
    pub(crate) fn arrow(&mut self, from: Vec2, to: Vec2) {
        let back = (from - to).normalize() / self.scale;
        self.line("arrow", from, to + 8.0 * back);
        self.polygon("head", &[to, to + 10.0 * back + 4.0 * back.perp(), to + 10.0 * back - 4.0 * back.perp()]);
    }

    /// A label at a world point, offset by some pixels. Text between asterisks is set as mathematics, where `_` begins an
    /// index.
    pub(crate) fn label(&mut self, at: Vec2, offset: [f32; 2], anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let Vec2 { x, y } = self.pixel(at) + Vec2::from(offset);
        let spans: String = text.split('*').enumerate().map(|(number, part)| spans(number % 2 == 1, part)).collect();
        let place = format!(r#"x="{}" y="{}" text-anchor="{anchor}""#, rounded(x), rounded(y));
        self.put(format_args!("<text {place} class=\"label\">{spans}</text>\n"));
    }

    /// The file's text.
    pub(crate) fn finish(self) -> String {
        self.svg + "</svg>\n"
    }

    /// The pixel of a world point, to a tenth.
    fn pixel(&self, world: Vec2) -> Vec2 {
        let pixel = self.origin + self.scale * vec2(world.x, -world.y);
        vec2(rounded(pixel.x), rounded(pixel.y))
    }

    fn element(&mut self, class: &str, element: &str) {
        self.put(format_args!("<{element} class=\"{class}\"/>\n"));
    }

    fn put(&mut self, text: std::fmt::Arguments) {
        // Writing to a string does not fail.
        let _ = self.svg.write_fmt(text);
    }
}

/// A part of a label.
fn spans(mathematics: bool, text: &str) -> String {
    let text = escaped(text);
    if !mathematics {
        return text;
    }
    let (base, index) = text.split_once('_').unwrap_or((&text, ""));
    let base = format!(r#"<tspan class="math">{base}</tspan>"#);
    // The second span returns to the baseline.
    let index = if index.is_empty() {
        String::new()
    } else {
        format!("<tspan class=\"sub\" dy=\"4\">{index}</tspan><tspan dy=\"-4\">\u{200b}</tspan>")
    };
    base + &index
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Rounded to a tenth, without a negative zero.
fn rounded(pixels: f32) -> f32 {
    (10.0 * pixels).round() / 10.0 + 0.0
}
