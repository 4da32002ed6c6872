//! The method's time compared with that of other modes: a statement for each scene, number of lights and number of samples.
//!
//! A mode may be faster and less accurate. If rows have errors, less time only counts as a win if the error is no larger, and
//! more time only as a loss if the error is no smaller.

use super::document::{Finding, Verdict};
use super::layouts::thesis::same_picture;
use super::layouts::{self, LIGHTS, whole};
use super::runs::{Measured, distinct};
use super::spread::{Spread, verdict};
use super::{numbers, settings};

/// The same image with the method and with a competing mode, on one device.
#[derive(Clone, Copy)]
struct Duel<'a> {
    mesh: Measured<'a>,
    /// The method's time over the competitor's.
    ratio: f64,
    /// Mean FLIP of both, if the method's is known. A competitor without one is the reference.
    errors: Option<(f64, f64)>,
}

/// Scene, lights and samples of a competitor.
type Subject = (String, String, String);

/// Statements on the method compared with `mode`.
pub(crate) fn findings(rows: &[Measured], mode: &str) -> Vec<Finding> {
    // Figure 11 has its own statements.
    let others: Vec<Measured> = rows.iter().filter(|row| row.row.experiment != LIGHTS).copied().collect();
    let rivals: Vec<Measured> = others.iter().filter(|row| row.is("mode", mode)).copied().collect();
    let subject = |row: &Measured| (row.text("scene"), row.text("lights"), row.text("samples"));
    let mut findings = Vec::new();
    for wanted in distinct(rivals.iter().map(subject)) {
        let rivals = rivals.iter().filter(|row| subject(row) == wanted);
        let duels: Vec<Duel> = rivals.flat_map(|rival| duels(rival, &others)).collect();
        let places = distinct(duels.iter().map(|duel| duel.mesh.place()));
        let of_place = |place: &String| duels.iter().filter(|duel| duel.mesh.place() == *place).copied().collect();
        let places: Vec<Vec<Duel>> = places.iter().map(of_place).collect();
        // Devices with the same verdict share a statement.
        for wanted_verdict in [Verdict::Wins, Verdict::Loses, Verdict::Open] {
            let agreeing: Vec<&[Duel]> =
                places.iter().filter(|duels| by_time(duels) == wanted_verdict).map(Vec::as_slice).collect();
            findings.extend((!agreeing.is_empty()).then(|| agreed(&wanted, &agreeing)));
        }
        let divided = places.iter().filter(|duels| by_time(duels) == Verdict::Depends);
        findings.extend(divided.map(|duels| self::divided(&wanted, duels)));
    }
    findings
}

/// A competitor's image and each corresponding image of the method.
fn duels<'a>(rival: &Measured, rows: &[Measured<'a>]) -> Vec<Duel<'a>> {
    let mesh = rows.iter().filter(|row| row.is_half_ball() && same_picture(row, rival));
    let duel = |mesh: &Measured<'a>| {
        let errors = mesh.value("mean_flip").map(|error| (error, rival.value("mean_flip").unwrap_or(0.0)));
        Some(Duel { mesh: *mesh, ratio: whole(mesh)? / whole(rival)?, errors })
    };
    mesh.filter_map(duel).collect()
}

fn by_time(duels: &[Duel]) -> Verdict {
    ratios(duels).map_or(Verdict::Open, |ratios| ratios.verdict())
}

/// Time and error: less time with a larger error is not a win, nor more time with a smaller one a loss.
fn by_both(duels: &[Duel]) -> Verdict {
    let errors = || duels.iter().filter_map(|duel| duel.errors);
    match by_time(duels) {
        Verdict::Wins if errors().any(|(mesh, rival)| mesh > rival) => Verdict::Depends,
        Verdict::Loses if errors().any(|(mesh, rival)| mesh < rival) => Verdict::Depends,
        verdict => verdict,
    }
}

fn ratios(duels: &[Duel]) -> Option<Spread> {
    Spread::of(duels.iter().map(|duel| duel.ratio))
}

/// One statement for devices with the same verdict on all images.
fn agreed(subject: &Subject, places: &[&[Duel]]) -> Finding {
    let all: Vec<Duel> = places.concat();
    let groups = places.chunk_by(|a, b| pictures(a) == pictures(b)).map(|group| {
        let times: Vec<String> =
            group.iter().map(|duels| format!("{} the time on {}", times(duels), duels[0].mesh.place())).collect();
        let of = pictures(group[0]);
        let each = if group.len() > 1 { "each: " } else { "" };
        format!("{} ({each}{of})", settings::enumerated(&times))
    });
    let groups: Vec<String> = groups.collect();
    let text = format!(
        "{}: compared with {}, the light mesh takes {}.{}",
        named(subject),
        rival(subject),
        groups.join("; "),
        errors(&all)
    );
    Finding::new(by_both(&all), text)
}

/// A statement for a device on which the method takes less time for some images but not for others.
fn divided(subject: &Subject, duels: &[Duel]) -> Finding {
    let parts = [(Verdict::Wins, "less time for"), (Verdict::Open, "as much for"), (Verdict::Loses, "more for")];
    let parts = parts.map(|(wanted, words)| {
        let of: Vec<Duel> = duels.iter().filter(|duel| verdict(duel.ratio) == wanted).copied().collect();
        (words, of)
    });
    let mut parts: Vec<(&str, Vec<Duel>)> = parts.into_iter().filter(|(_, part)| !part.is_empty()).collect();
    // The largest part comes last, as "the others".
    parts.sort_by_key(|(_, part)| part.len());
    let last = parts.len() - 1;
    let parts = parts.iter().enumerate().map(|(index, (words, part))| match index == last {
        true => format!("{words} the other {} ({})", part.len(), times(part)),
        false => {
            format!("{words} {} ({}; {})", count(part), times(part), settings::text(&meshes(part), &meshes(duels)))
        }
    });
    let parts: Vec<String> = parts.collect();
    let text = format!(
        "{}: compared with {}, the light mesh on {} takes {}.{}",
        named(subject),
        rival(subject),
        duels[0].mesh.place(),
        settings::enumerated(&parts),
        errors(duels)
    );
    Finding::new(Verdict::Depends, text)
}

/// As in "1.2× to 3.0×".
fn times(duels: &[Duel]) -> String {
    ratios(duels).map_or_else(String::new, |ratios| ratios.text(numbers::ratio))
}

/// The number of images, and their settings.
fn pictures(duels: &[Duel]) -> String {
    let rows = meshes(duels);
    let settings = settings::text(&rows, &rows);
    if settings.is_empty() { count(duels) } else { format!("{}, {settings}", count(duels)) }
}

fn count(duels: &[Duel]) -> String {
    if duels.len() == 1 { "1 image".to_owned() } else { format!("{} images", duels.len()) }
}

fn meshes<'a>(duels: &[Duel<'a>]) -> Vec<Measured<'a>> {
    duels.iter().map(|duel| duel.mesh).collect()
}

/// The errors of both; empty if unknown.
fn errors(duels: &[Duel]) -> String {
    let known = || duels.iter().filter_map(|duel| duel.errors);
    let (Some(mesh), Some(rival)) =
        (Spread::of(known().map(|error| error.0)), Spread::of(known().map(|error| error.1)))
    else {
        return String::new();
    };
    let text = |spread: Spread| spread.text(|error| numbers::significant(error, 2));
    if rival.most == 0.0 {
        return format!(" Its error is a mean FLIP of {}; theirs is 0, as they are the reference.", text(mesh));
    }
    format!(" Its error is a mean FLIP of {}, theirs {}.", text(mesh), text(rival))
}

/// As in "Garden, 3 lights".
fn named((scene, lights, _): &Subject) -> String {
    match lights.as_str() {
        "" => layouts::title(scene),
        "1" => format!("{}, 1 light", layouts::title(scene)),
        _ => format!("{}, {lights} lights", layouts::title(scene)),
    }
}

fn rival((_, _, samples): &Subject) -> String {
    match samples.as_str() {
        "" => "hard shadows".to_owned(),
        "1" => "area shadows with 1 shadow ray per pixel and light".to_owned(),
        samples => format!("area shadows with {samples} shadow rays per pixel and light"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Row, Samples};

    /// Statements on area shadows of one second with an error of 0.03 and images of the method, by radius, seconds and error.
    fn sentences(mesh: &[(f64, f64, Option<f64>)]) -> Vec<Finding> {
        let results = crate::report::tests::results("thesis", |rows| {
            let mut area = Row::new("a", [("scene", "park".into()), ("mode", "area".into()), ("samples", 4.0.into())]);
            area.seconds.insert("render".into(), Samples(vec![1.0]));
            area.values.insert("mean_flip".into(), 0.03);
            rows.push(area);
            for (radius, seconds, error) in mesh {
                let keys = [("scene", "park".into()), ("mode", "light-mesh".into()), ("radius", (*radius).into())];
                let mut row = Row::new("b", keys);
                row.seconds.insert("render".into(), Samples(vec![*seconds]));
                row.values.extend(error.map(|error| ("mean_flip".to_owned(), error)));
                rows.push(row);
            }
        });
        let runs = crate::report::named(vec![("a.json".into(), results)]);
        let rows: Vec<Measured> = runs.all().collect();
        findings(&rows, "area")
    }

    #[test]
    fn less_time_with_a_larger_error_is_not_won() {
        let verdict = |seconds, error| sentences(&[(2.1, seconds, error)])[0].verdict;
        assert_eq!(verdict(0.5, None), Verdict::Wins);
        assert_eq!(verdict(0.5, Some(0.02)), Verdict::Wins);
        assert_eq!(verdict(0.5, Some(0.2)), Verdict::Depends);
        assert_eq!(verdict(2.0, Some(0.2)), Verdict::Loses);
        assert_eq!(verdict(2.0, Some(0.02)), Verdict::Depends);
        let text = &sentences(&[(2.1, 0.5, Some(0.2))])[0].text;
        assert!(text.ends_with("Its error is a mean FLIP of 0.20, theirs 0.030."), "{text}");
    }

    #[test]
    fn what_depends_says_on_what() {
        let findings = sentences(&[(1.1, 0.5, None), (2.1, 1.0, None), (3.1, 2.0, None), (4.1, 3.0, None)]);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].verdict, Verdict::Depends);
        let wanted = "takes less time for 1 image (0.50×; R = 1.1), as much for 1 image (1.0×; R = 2.1) and more for the other 2 \
                      (2.0× to 3.0×).";
        assert!(findings[0].text.ends_with(wanted), "{}", findings[0].text);
    }
}
