//! Where the method wins and where it loses: sentences that are computed from the rows, for each scene and place.

use super::document::{Block, Finding, Section, Verdict};
use super::layouts::lights::{Contest, contests, lights_text};
use super::layouts::thesis::same_picture;
use super::layouts::{self, BREAK_EVEN, LIGHTS, quality, whole};
use super::numbers;
use super::runs::{Measured, Runs, distinct};

/// Light points a pixel from which on most long rays of plain tracing are cast, and some besides.
const MANY_POINTS: f64 = 0.5;
/// Ratios that are as good as 1.
const EVEN: std::ops::Range<f64> = 0.95..1.05;

/// All that follows from the rows; `None` where nothing does.
pub(crate) fn section(runs: &Runs) -> Option<Section> {
    let rows: Vec<Measured> = runs.all().collect();
    let mut findings = Vec::new();
    findings.extend(against(&rows, "ray-trace"));
    findings.extend(against(&rows, "area"));
    findings.extend(contests(&runs.rows(LIGHTS), &runs.rows(BREAK_EVEN)).iter().map(break_even));
    findings.extend(light_points(&rows));
    findings.extend(quality::findings(runs));
    if findings.is_empty() {
        return None;
    }
    findings.sort_by_key(|finding| finding.verdict);
    let intro = "Each sentence is computed from the rows below: medians of whole pictures, the same scene, size and lights, at the same \
                 place. Ratios of times say nothing of errors: light meshes blur, few shadow rays are noisy. Sentences on equal \
                 errors, where there are any, take both into account.";
    Some(Section::new(
        "Where the method wins, and where it loses",
        vec![Block::Text(intro.to_owned()), Block::Findings(findings)],
    ))
}

/// The method's time against that of another mode, for each scene, number of lights, place and number of samples.
fn against(rows: &[Measured], mode: &str) -> Vec<Finding> {
    // Figure 11 has sentences of its own.
    let others = || rows.iter().filter(|row| row.row.experiment != LIGHTS);
    let rivals: Vec<&Measured> = others().filter(|row| row.is("mode", mode)).collect();
    let subject = |row: &Measured| (row.text("scene"), row.text("lights"), row.text("samples"));
    let mut findings = Vec::new();
    for wanted in distinct(rivals.iter().map(|row| subject(row))) {
        let rivals: Vec<&Measured> = rivals.iter().filter(|row| subject(row) == wanted).copied().collect();
        let ranges = distinct(rivals.iter().map(|row| row.place())).into_iter().filter_map(|place| {
            let here = rivals.iter().filter(|rival| rival.place() == place);
            let ratios = here.flat_map(|rival| {
                let mesh = others().filter(|row| row.is("mode", "light-mesh") && same_picture(row, rival));
                mesh.filter_map(|row| Some(whole(row)? / whole(rival)?))
            });
            Some((Spread::of(ratios)?, place))
        });
        let ranges: Vec<(Spread, String)> = ranges.collect();
        // Places that agree share a sentence.
        for verdict in [Verdict::Wins, Verdict::Loses, Verdict::Open] {
            let times: Vec<String> = ranges
                .iter()
                .filter(|(range, _)| range.verdict() == verdict)
                .map(|(range, place)| format!("{} ({place})", range.text(numbers::ratio)))
                .collect();
            if !times.is_empty() {
                findings.push(Finding::new(verdict, sentence(&wanted, &times.join(", "))));
            }
        }
    }
    findings
}

/// What the method takes of the time of a rival.
fn sentence((scene, lights, samples): &(String, String, String), times: &str) -> String {
    let rival = match samples.as_str() {
        "" => "hard shadows, one shadow ray for each pixel and light".to_owned(),
        "1" => "area shadows with 1 shadow ray for each pixel and light".to_owned(),
        samples => format!("area shadows with {samples} shadow rays for each pixel and light"),
    };
    format!("{}{}: the light mesh takes {times} the time of {rival}.", named(scene), lights_of(lights))
}

fn lights_of(lights: &str) -> String {
    match lights {
        "" => String::new(),
        "1" => ", 1 light".to_owned(),
        _ => format!(", {lights} lights"),
    }
}

/// A scene with a capital letter.
fn named(scene: &str) -> String {
    layouts::title(scene)
}

/// From how many lights on the method is ahead, by the clock and by the model.
fn break_even(contest: &Contest) -> Finding {
    let place = &contest.title;
    let predicted = contest.predicted.map_or_else(
        || "by the cost model never".to_owned(),
        |lights| format!("the cost model says {}", lights_text(lights)),
    );
    let most = contest.most().map(numbers::setting).unwrap_or_default();
    match contest.break_even() {
        Some(lights) => Finding::new(
            Verdict::Open,
            format!(
                "{place}: from {} lights on the light mesh takes less time than hard shadows ({predicted}); with fewer it loses.",
                lights_text(lights)
            ),
        ),
        None => Finding::new(
            Verdict::Loses,
            format!(
                "{place}: with up to {most} lights the light mesh takes more time than hard shadows ({predicted})."
            ),
        ),
    }
}

/// Scenes and steps that need about as many light points as there are pixels.
fn light_points(rows: &[Measured]) -> Vec<Finding> {
    let mesh = rows.iter().filter(|row| row.is("mode", "light-mesh"));
    let shares: Vec<(String, String, f64)> = mesh
        .filter_map(|row| {
            let share = row.value("light_points")? / row.value("pixels")?;
            Some((row.text("scene"), row.text("step"), share))
        })
        .collect();
    let subjects = distinct(shares.iter().map(|(scene, step, _)| (scene, step)));
    let findings = subjects.into_iter().filter_map(|(scene, step)| {
        let of = shares.iter().filter(|share| (&share.0, &share.1) == (scene, step)).map(|share| share.2);
        let range = Spread::of(of)?;
        (range.most >= MANY_POINTS).then(|| {
            Finding::new(
                Verdict::Loses,
                format!(
                    "{}, h = {step}: {} light points a pixel, so that long tests are not much fewer than shadow rays.",
                    named(scene),
                    range.text(|share| numbers::significant(share, 2))
                ),
            )
        })
    });
    findings.collect()
}

/// The least and the most of some figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Spread {
    /// `None` without any.
    pub(crate) fn of(figures: impl Iterator<Item = f64>) -> Option<Spread> {
        figures.fold(None, |spread: Option<Spread>, figure| {
            Some(spread.map_or(Spread { least: figure, most: figure }, |spread| Spread {
                least: spread.least.min(figure),
                most: spread.most.max(figure),
            }))
        })
    }

    /// Both, or one where they read the same.
    pub(crate) fn text(&self, format: impl Fn(f64) -> String) -> String {
        let (least, most) = (format(self.least), format(self.most));
        if least == most { least } else { format!("{least} to {most}") }
    }

    /// Of ratios of times: below 1 wins, above 1 loses; both in one is left open.
    pub(crate) fn verdict(&self) -> Verdict {
        if self.most < EVEN.start {
            Verdict::Wins
        } else if self.least > EVEN.end {
            Verdict::Loses
        } else {
            Verdict::Open
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_wins_or_loses_as_a_whole_alone() {
        let verdict = |figures: [f64; 2]| Spread::of(figures.into_iter()).unwrap().verdict();
        assert_eq!(verdict([0.5, 0.9]), Verdict::Wins);
        assert_eq!(verdict([0.5, 2.0]), Verdict::Open);
        assert_eq!(verdict([1.0, 1.01]), Verdict::Open);
        assert_eq!(verdict([1.2, 9.0]), Verdict::Loses);
        assert_eq!(Spread::of(std::iter::empty()), None);
    }

    #[test]
    fn a_spread_of_one_is_told_once() {
        let spread = Spread { least: 2.01, most: 2.04 };
        assert_eq!(spread.text(numbers::ratio), "2.0×");
        assert_eq!(Spread { most: 3.0, ..spread }.text(numbers::ratio), "2.0× to 3.0×");
    }
}
