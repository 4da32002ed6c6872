//! Curves as SVG.
//!
//! Colours are those of Okabe and Ito, which are distinguishable with colour blindness; each curve also has its own marker, and
//! its name at its end. For dark mode, pages that embed a plot, and the style of a plot in a separate file, replace colours by
//! attribute selectors (`[stroke="#0072B2"]`).

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::scale::Scale;

/// Size in pixels.
const SIZE: (u32, u32) = (760, 400);
/// Space for the names of curves on the right.
const NAMES: u32 = 190;
/// Minimum distance between names.
const LINE: i32 = 17;
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

/// For plots in separate files.
const STYLE: &str = "<style>svg{color-scheme:light dark}@media(prefers-color-scheme:dark){\
[fill=\"#000000\"]{fill:#ddd}[stroke=\"#000000\"]{stroke:#999}[stroke=\"#CCCCCC\"]{stroke:#444}\
[stroke=\"#0072B2\"]{stroke:#4aa8e0}[fill=\"#0072B2\"]{fill:#4aa8e0}}</style>";

/// Curves over two axes.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// File name without extension.
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) curves: Vec<Curve>,
    /// Vertical lines at some x, with a label.
    pub(crate) marks: Vec<(f64, String)>,
}

/// An axis of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub(crate) title: String,
    pub(crate) log: bool,
}

/// A curve: points in order of x.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Separate points, without a line between them.
    pub(crate) scattered: bool,
}

type DrawResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

impl Plot {
    /// The plot as SVG; `None` without a point that can be shown.
    pub(crate) fn svg(&self) -> Option<String> {
        let shown = self.shown();
        let points = || shown.iter().flat_map(|curve| curve.points.iter().copied());
        let x = Scale::over(points().map(|point| point.0), self.x.log)?;
        let y = Scale::over(points().map(|point| point.1), self.y.log)?;
        let mut svg = String::new();
        // Drawing to a string does no I/O and only fails because of a bug: then there is no plot.
        self.draw(&shown, x, y, SVGBackend::with_string(&mut svg, SIZE)).ok()?;
        Some(labelled(&svg, &self.caption))
    }

    /// The plot as a file.
    pub(crate) fn file(&self) -> Option<String> {
        let svg = self.svg()?;
        let (head, rest) = svg.split_once('>')?;
        Some(format!("{head}>{STYLE}{rest}"))
    }

    /// Curves with only the points that the axes can show.
    fn shown(&self) -> Vec<Curve> {
        let fits = |value: f64, axis: &Axis| value.is_finite() && (!axis.log || value > 0.0);
        let mut curves = self.curves.clone();
        for curve in &mut curves {
            curve.points.retain(|&(x, y)| fits(x, &self.x) && fits(y, &self.y));
        }
        curves
    }

    fn draw(&self, curves: &[Curve], x: Scale, y: Scale, backend: SVGBackend) -> DrawResult {
        let area = backend.into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin_top(12)
            .margin_left(10)
            .margin_right(NAMES)
            .x_label_area_size(46)
            .y_label_area_size(68)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(&self.x.title)
            .y_desc(&self.y.title)
            .light_line_style(TRANSPARENT)
            .bold_line_style(FAINT)
            .axis_style(FAINT)
            .label_style(("sans-serif", TEXT))
            .axis_desc_style(("sans-serif", TEXT))
            .draw()?;
        for (place, _) in &self.marks {
            chart.draw_series([PathElement::new([(*place, y.low()), (*place, y.high())], BLACK)])?;
        }
        for (curve, color) in curves.iter().zip(COLORS.iter().cycle()) {
            if !curve.scattered {
                chart.draw_series(LineSeries::new(curve.points.iter().copied(), color.stroke_width(2)))?;
            }
        }
        let place = |point: &(f64, f64)| chart.backend_coord(point);
        for (index, curve) in curves.iter().enumerate() {
            for point in &curve.points {
                draw_mark(&area, index, place(point))?;
            }
        }
        for (index, (mark, name)) in self.marks.iter().enumerate() {
            let (left, top) = place(&(*mark, y.high()));
            // One below the other, as marks may be close to each other.
            let top = top + 3 + LINE * index as i32;
            area.draw(&Text::new(name.clone(), (left + 5, top), ("sans-serif", TEXT)))?;
        }
        let ends: Vec<_> = curves.iter().map(|curve| curve.points.last().map(place)).collect();
        draw_names(&area, curves, &ends)?;
        area.present()
    }
}

/// A marker with the shape of its curve.
fn draw_mark<B: DrawingBackend>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    curve: usize,
    at: (i32, i32),
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let style = COLORS[curve % COLORS.len()].filled();
    match curve % 4 {
        0 => area.draw(&Circle::new(at, MARK, style)),
        1 => area.draw(&Rectangle::new([(at.0 - MARK, at.1 - MARK), (at.0 + MARK, at.1 + MARK)], style)),
        2 => area.draw(&TriangleMarker::new(at, MARK + 2, style)),
        _ => area.draw(&Cross::new(at, MARK, style.stroke_width(2))),
    }
}

/// Names at the ends of curves, moved apart if they would overlap.
fn draw_names<B: DrawingBackend>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    curves: &[Curve],
    ends: &[Option<(i32, i32)>],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let left = (SIZE.0 - NAMES) as i32 + 12;
    let mut order: Vec<(usize, i32)> =
        ends.iter().enumerate().filter_map(|(index, end)| Some((index, end.as_ref()?.1))).collect();
    order.sort_by_key(|&(_, height)| height);
    let heights = apart(&order.iter().map(|&(_, height)| height).collect::<Vec<_>>());
    for (&(index, _), height) in order.iter().zip(heights) {
        draw_mark(area, index, (left, height))?;
        let style = ("sans-serif", TEXT).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(curves[index].name.clone(), (left + 12, height), style))?;
    }
    Ok(())
}

/// Heights in order, at least a line apart and within the page.
fn apart(heights: &[i32]) -> Vec<i32> {
    let mut placed: Vec<i32> = Vec::with_capacity(heights.len());
    for &height in heights {
        placed.push(placed.last().map_or(height, |last| height.max(last + LINE)));
    }
    // Names beyond the edge move up again, and push those above.
    let mut limit = SIZE.1 as i32 - LINE / 2;
    for height in placed.iter_mut().rev() {
        *height = (*height).min(limit);
        limit = *height - LINE;
    }
    placed
}

/// With a label for screen readers, and scaled to its container.
fn labelled(svg: &str, caption: &str) -> String {
    let fixed = format!("<svg width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    let head = format!("<svg role=\"img\" aria-label=\"{}\"", super::html::escaped(caption));
    let svg = svg.replacen(&fixed, &head, 1);
    // Without the prolog, which has no place within a page.
    svg.find("<svg").map_or(svg.clone(), |start| svg[start..].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<(f64, f64)>, log: bool) -> Plot {
        let axis = |title: &str| Axis { title: title.to_owned(), log };
        let curve = Curve { name: "a < b".to_owned(), points, scattered: false };
        let marks = vec![(2.0, "break-even".to_owned())];
        Plot {
            name: "p".into(),
            caption: "A \"plot\"".into(),
            x: axis("lights"),
            y: axis("ms"),
            curves: vec![curve],
            marks,
        }
    }

    #[test]
    fn a_plot_has_its_names_and_no_prolog() {
        let svg = plot(vec![(1.0, 2.0), (10.0, 30.0)], true).svg().unwrap();
        assert!(svg.starts_with("<svg role=\"img\" aria-label=\"A &quot;plot&quot;\""), "{svg}");
        for text in ["a &lt; b", "break-even", "lights", "#0072B2"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
    }

    #[test]
    fn points_that_an_axis_lacks_are_left_out() {
        assert!(plot(vec![(0.0, 1.0), (1.0, f64::NAN)], true).svg().is_none());
        assert!(plot(vec![(0.0, 1.0)], false).svg().is_some());
        assert!(plot(vec![], false).svg().is_none());
    }

    #[test]
    fn names_keep_apart_and_on_the_page() {
        assert_eq!(apart(&[10, 12, 200]), [10, 27, 200]);
        let low = SIZE.1 as i32;
        let placed = apart(&[low, low, low]);
        assert!(placed.windows(2).all(|pair| pair[1] - pair[0] >= LINE) && placed[2] < low, "{placed:?}");
    }
}
