//! Curves as SVG.
//!
//! Colours are those of Okabe and Ito, which are distinguishable with colour blindness; each curve also has its own marker.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::document::Image;
use super::escape::escaped;
use super::numbers;

/// Size in pixels.
const SIZE: (u32, u32) = (760, 400);
/// Space for the names of curves on the right.
const NAMES: u32 = 190;
/// Distance between names.
const LINE: i32 = 19;
const TEXT: i32 = 13;
const MARK: i32 = 4;

/// Blue, vermilion, green, purple, orange, sky.
const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Grid lines.
const FAINT: RGBColor = RGBColor(204, 204, 204);

/// Curves over two axes.
#[derive(Clone, Debug)]
pub(crate) struct Plot<'a> {
    pub(crate) caption: String,
    /// Titles of both axes.
    pub(crate) axes: [&'a str; 2],
    /// Whether both are logarithmic; else they begin at 0, so that lengths can be compared.
    pub(crate) log: bool,
    pub(crate) curves: Vec<Curve>,
    /// Vertical lines at some x, with a label.
    pub(crate) marks: Vec<(f64, String)>,
}

/// A curve: points in order of x.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Separate points, without a line between them.
    pub(crate) scattered: bool,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

impl Plot<'_> {
    /// The plot in a file with that name; `None` without a point that the axes can show.
    pub(crate) fn image(mut self, name: &str) -> Option<Image> {
        let least = if self.log { f64::MIN_POSITIVE } else { 0.0 };
        let fits = |value: f64| value.is_finite() && value >= least;
        self.curves.iter_mut().for_each(|curve| curve.points.retain(|&(x, y)| fits(x) && fits(y)));
        let points = || self.curves.iter().flat_map(|curve| curve.points.iter().copied());
        let x = Scale::over(points().map(|point| point.0), self.log)?;
        let y = Scale::over(points().map(|point| point.1), self.log)?;
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        // Drawing to a string does no I/O and only fails because of a bug: then there is no plot.
        self.draw(&area, x, y).ok()?;
        drop(area);
        Some(Image::plot(name, self.caption.clone(), labelled(&svg, &self.caption)))
    }

    fn draw(&self, area: &Area, x: Scale, y: Scale) -> DrawResult {
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(area)
            .margin_top(12)
            .margin_left(10)
            .margin_right(NAMES)
            .x_label_area_size(46)
            .y_label_area_size(68)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .light_line_style(TRANSPARENT)
            .bold_line_style(FAINT)
            .axis_style(FAINT)
            .label_style(("sans-serif", TEXT))
            .axis_desc_style(("sans-serif", TEXT))
            .draw()?;
        for (index, (x, name)) in self.marks.iter().enumerate() {
            chart.draw_series([PathElement::new([(*x, y.low), (*x, y.high)], BLACK)])?;
            let (left, top) = chart.backend_coord(&(*x, y.high));
            // One below the other, as marks may be close to each other.
            area.draw(&Text::new(name.clone(), (left + 5, top + 3 + LINE * index as i32), ("sans-serif", TEXT)))?;
        }
        let left = (SIZE.0 - NAMES) as i32 + 14;
        for (index, curve) in self.curves.iter().filter(|curve| !curve.points.is_empty()).enumerate() {
            if !curve.scattered {
                let line = COLORS[index % COLORS.len()].stroke_width(2);
                chart.draw_series(LineSeries::new(curve.points.iter().copied(), line))?;
            }
            for point in &curve.points {
                draw_mark(area, index, chart.backend_coord(point))?;
            }
            let height = 20 + LINE * index as i32;
            draw_mark(area, index, (left, height))?;
            let style = ("sans-serif", TEXT).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(curve.name.clone(), (left + 12, height), style))?;
        }
        area.present()
    }
}

/// An axis with ticks at round numbers.
#[derive(Clone, Copy, Debug)]
struct Scale {
    low: f64,
    high: f64,
    log: bool,
}

impl Scale {
    /// An axis that shows all values, with a margin; `None` without values.
    fn over(values: impl Iterator<Item = f64> + Clone, log: bool) -> Option<Scale> {
        let low = values.clone().min_by(f64::total_cmp)?;
        let high = values.max_by(f64::total_cmp)?;
        let linear = if high > 0.0 { 1.04 * high } else { 1.0 };
        Some(if log {
            Scale { low: low / 1.15, high: 1.15 * high, log }
        } else {
            Scale { low: 0.0, high: linear, log }
        })
    }

    /// 1, 2 and 5 times powers of ten, over more than 2.5 decades only those; or about six multiples of such a number.
    fn ticks(&self) -> Vec<f64> {
        let factors: &[f64] = if self.log && (self.high / self.low).log10() > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let mut round = (-20..20).flat_map(|power| factors.iter().map(move |factor| factor * 10_f64.powi(power)));
        if self.log {
            return round.filter(|tick| (self.low..=self.high).contains(tick)).collect();
        }
        let step = round.find(|step| 6.0 * step >= self.high).unwrap_or(self.high);
        (0..=(self.high / step) as u32).map(|index| f64::from(index) * step).collect()
    }
}

impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let place = |value: f64| if self.log { value.ln() } else { value };
        let share = (place(*value) - place(self.low)) / (place(self.high) - place(self.low));
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Scale {
    fn format_ext(&self, value: &f64) -> String {
        let text = numbers::significant(*value, 3);
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

/// A marker with the shape of its curve.
fn draw_mark(area: &Area, curve: usize, at: (i32, i32)) -> DrawResult {
    let style = COLORS[curve % COLORS.len()].filled();
    match curve % 4 {
        0 => area.draw(&Circle::new(at, MARK, style)),
        1 => area.draw(&Rectangle::new([(at.0 - MARK, at.1 - MARK), (at.0 + MARK, at.1 + MARK)], style)),
        2 => area.draw(&TriangleMarker::new(at, MARK + 2, style)),
        _ => area.draw(&Cross::new(at, MARK, style.stroke_width(2))),
    }
}

/// With a label for screen readers, scaled to its container, and without the prolog, which has no place within a page.
fn labelled(svg: &str, caption: &str) -> String {
    let fixed = format!("<svg width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    let head = format!("<svg role=\"img\" aria-label=\"{}\"", escaped(caption));
    svg.find("<svg").map_or_else(String::new, |start| svg[start..].replacen(&fixed, &head, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<(f64, f64)>, log: bool) -> Option<String> {
        let curves = vec![Curve { name: "a < b".to_owned(), points, scattered: false }];
        let marks = vec![(2.0, "break-even".to_owned())];
        let plot = Plot { caption: "A \"plot\"".into(), axes: ["lights", "ms"], log, curves, marks };
        plot.image("p").map(|image| String::from_utf8(image.bytes).unwrap())
    }

    #[test]
    fn a_plot_has_its_names_and_no_prolog() {
        let svg = plot(vec![(1.0, 2.0), (10.0, 30.0)], true).unwrap();
        assert!(svg.starts_with("<svg role=\"img\" aria-label=\"A &quot;plot&quot;\""), "{svg}");
        for text in ["a &lt; b", "break-even", "lights", "#0072B2"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
    }

    #[test]
    fn ticks_are_round_and_within_the_axis() {
        let texts = |values: [f64; 2], log| {
            let scale = Scale::over(values.into_iter(), log).unwrap();
            scale.ticks().iter().map(|tick| scale.format_ext(tick)).collect::<Vec<_>>()
        };
        assert_eq!(texts([3.0, 97.0], false), ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(texts([0.3, 40.0], true), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(texts([0.3, 4000.0], true), ["1", "10", "100", "1000"]);
        assert_eq!(texts([0.0, 0.0], false).len(), 6);
    }

    #[test]
    fn points_that_an_axis_lacks_are_left_out() {
        assert!(plot(vec![(0.0, 1.0), (1.0, f64::NAN)], true).is_none());
        assert!(plot(vec![(0.0, 1.0)], false).is_some());
        assert!(plot(vec![], false).is_none());
    }
}
