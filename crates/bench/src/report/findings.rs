//! Where the method wins and where it loses: statements computed from the rows, for each scene and device.

use super::document::{Block, Finding, Section, Verdict};
use super::layouts::lights::{Contest, contests, lights_text};
use super::layouts::{self, BREAK_EVEN, LIGHTS, quality};
use super::runs::{Measured, Runs, distinct};
use super::spread::Spread;
use super::{numbers, rivals, settings};

/// Light points per pixel at which the method casts at least half as many long rays as plain ray tracing.
const MANY_POINTS: f64 = 0.5;

/// All statements that follow from the rows; `None` if there are none.
pub(crate) fn section(runs: &Runs) -> Option<Section> {
    let rows: Vec<Measured> = runs.all().collect();
    let mut findings = Vec::new();
    findings.extend(rivals::findings(&rows, "ray-trace"));
    findings.extend(rivals::findings(&rows, "area"));
    findings.extend(contests(&runs.rows(LIGHTS), &runs.rows(BREAK_EVEN)).iter().map(break_even));
    findings.extend(light_points(&rows));
    findings.extend(quality::findings(runs));
    if findings.is_empty() {
        return None;
    }
    findings.sort_by_key(|finding| finding.verdict);
    let intro = "Each statement is computed from the rows below: medians of full frames, for the same scene, size and lights, on the same \
                 device; a range covers the images that are named. Wins and loses refer to time, and to errors if the statement gives \
                 them. Without errors they say nothing about quality: light meshes give soft shadows and blur; hard shadows, one shadow \
                 ray per pixel and light, have no soft edges; few shadow rays are noisy.";
    Some(Section::new(
        "Where the method wins and where it loses",
        vec![Block::Text(intro.to_owned()), Block::Findings(findings)],
    ))
}

/// The number of lights from which on the method is ahead, as measured and by the model.
fn break_even(contest: &Contest) -> Finding {
    let place = format!("{}, on {}", contest.subject, contest.place);
    let predicted = contest.predicted.map_or_else(
        || "never, according to the cost model".to_owned(),
        |lights| format!("the cost model predicts {}", lights_text(lights)),
    );
    let most = contest.most().map(numbers::setting).unwrap_or_default();
    let at_most = contest.ratio_at_most().map(numbers::ratio).unwrap_or_default();
    match contest.break_even() {
        Some(lights) => Finding::new(
            Verdict::Depends,
            format!(
                "{place}: from {} lights on the light mesh takes less time than hard shadows ({predicted}), {at_most} with {most}; \
                 with fewer it takes more.",
                lights_text(lights)
            ),
        ),
        None => Finding::new(
            Verdict::Loses,
            format!(
                "{place}: with up to {most} lights the light mesh takes more time than hard shadows ({predicted}), {at_most} with {most}."
            ),
        ),
    }
}

/// Images that need about as many light points as there are pixels: a statement per scene. They are the same on every device.
fn light_points(rows: &[Measured]) -> Vec<Finding> {
    let share = |row: &Measured| Some(row.value("light_points")? / row.value("pixels")?);
    let many: Vec<(Measured, f64)> = rows
        .iter()
        .filter(|row| row.is("mode", "light-mesh"))
        .filter_map(|row| Some((*row, share(row)?)))
        .filter(|(_, share)| *share >= MANY_POINTS)
        .collect();
    let scenes = distinct(many.iter().map(|(row, _)| row.text("scene")));
    let sentence = |scene: String| {
        let of_scene: Vec<&(Measured, f64)> = many.iter().filter(|(row, _)| row.text("scene") == scene).collect();
        let group = |row: &Measured| (row.text("size"), row.text("step"));
        let parts = distinct(of_scene.iter().map(|(row, _)| group(row))).into_iter().filter_map(|wanted| {
            let part: Vec<&&(Measured, f64)> = of_scene.iter().filter(|(row, _)| group(row) == wanted).collect();
            let range = Spread::of(part.iter().map(|(_, share)| *share))?;
            let rows: Vec<Measured> = part.iter().map(|(row, _)| *row).collect();
            let settings = settings::text(&rows, &rows);
            Some(format!("{} ({settings})", range.text(|share| numbers::significant(share, 2))))
        });
        let parts = settings::enumerated(&parts.collect::<Vec<_>>());
        let text = format!(
            "{}: {parts} light points per pixel, so there are at least half as many long tests as shadow rays for hard shadows.",
            layouts::title(&scene)
        );
        Finding::new(Verdict::Loses, text)
    };
    scenes.into_iter().map(sentence).collect()
}
