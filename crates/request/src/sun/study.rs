//! A sun study: the moments of a day at which the sun is above the horizon, its sky at each, and files for the hours of direct sun.
//!
//! Each moment stands for a span: the time that is nearer to it than to its neighbours, from the first minute of the study to the last, as far
//! as the sun is above the horizon then. So the parts of all moments add up to the time of sunshine of an open field. The sun is above the horizon
//! if the middle of its disc is seen there, with the refraction of an ordinary atmosphere. Sunshine between two moments without sun is not
//! noticed.

use std::path::{Path, PathBuf};

use lightmesh_files::check_writable;
use lightmesh_render::Glass;
use lightmesh_scene::{SkyKind, SunPosition, parse_by_name};

use crate::error::{OutputError, RequestError};
use crate::files::{Outputs, PictureFiles, hours_of_sun, input, save_options};
use crate::order::Order;
use crate::value::{SkySpec, SunSpec, clock};
use crate::words::Words;

/// Halvings of a step in which the sun rises or sets: far below a second.
const HALVINGS: usize = 30;

/// A sun study.
#[derive(Clone, Debug)]
pub struct SunStudy {
    /// The hours of the day, as typed.
    pub spec: SunSpec,
    /// The moments with sun, in their order; none in a polar night.
    pub moments: Vec<SunMoment>,
    /// The moments without.
    pub dark: Vec<u32>,
    /// The clear sky, but for its sun.
    pub sky: SkySpec,
    /// What surfaces that let light through do to the hours of direct sun.
    pub glass: Glass,
    /// What the hours of direct sun are written to.
    pub outputs: Vec<HoursFile>,
}

/// A moment at which the sun is above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunMoment {
    /// The minute of the day.
    pub minute: u32,
    /// Where the sun stands.
    pub sun: SunPosition,
    /// The hours of sunshine that it stands for.
    pub hours: f64,
    /// Where the sun stands at the beginning, in the middle and at the end of the time that it stands for.
    pub span: [SunPosition; 3],
}

/// A file for hours of direct sun.
#[derive(Clone, Debug)]
pub struct HoursFile {
    /// Where it goes.
    pub path: PathBuf,
    /// What it holds.
    pub format: HoursFormat,
}

impl HoursFile {
    pub(super) fn is_table(&self) -> bool {
        self.format == HoursFormat::Csv
    }
}

/// How hours of direct sun are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoursFormat {
    /// The hours of each pixel.
    Exr,
    /// The same in colours, with a legend.
    Png,
    /// Hours by object.
    Csv,
}

impl HoursFormat {
    /// All of them.
    pub const ALL: &'static [HoursFormat] = &[HoursFormat::Exr, HoursFormat::Png, HoursFormat::Csv];

    /// By the extension of a file; `None` if it is that of another.
    pub fn from_path(path: &Path) -> Option<HoursFormat> {
        path.extension()?.to_str()?.to_ascii_lowercase().parse().ok()
    }

    /// Its name, which is the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            HoursFormat::Exr => "exr",
            HoursFormat::Png => "png",
            HoursFormat::Csv => "csv",
        }
    }
}

parse_by_name!(HoursFormat, "format of hours");

impl SunStudy {
    /// The study that is asked for, if one is. Fails if its frames have no sun, or a file cannot be written. Without frames, the hours of a night
    /// are an answer: 0.
    pub(crate) fn new(order: &Order) -> Result<Option<SunStudy>, RequestError> {
        let Some(spec) = order.request.sun else { return Ok(None) };
        let sky = order.request.sky.unwrap_or_else(SkySpec::clear);
        if !matches!(sky.sky.kind, SkyKind::Clear { .. }) {
            return Err(RequestError::SunWithoutSky);
        }
        let outputs = order.files.sun_hours.iter().map(|path| hours_file(path, None)).collect::<Result<_, _>>()?;
        let study = SunStudy { glass: order.request.glass, ..SunStudy::of(spec, sky, outputs) };
        if study.moments.is_empty() && order.files.output.is_some() {
            return Err(RequestError::NoSun { spec });
        }
        Ok(Some(study))
    }

    /// The study of these hours, in which glass is open.
    pub fn of(spec: SunSpec, sky: SkySpec, outputs: Vec<HoursFile>) -> SunStudy {
        let (moments, dark) = moments(&spec);
        SunStudy { spec, moments, dark, sky, glass: Glass::Open, outputs }
    }

    /// The sky of moment number `index`: the same as of `--sky` with this place and time. If there is none, it is that of another day.
    pub fn sky_at(&self, index: usize) -> SkySpec {
        let mut spec = self.sky;
        if let (SkyKind::Clear { sun, .. }, Some(moment)) = (&mut spec.sky.kind, self.moments.get(index)) {
            *sun = moment.sun;
        }
        spec
    }

    /// The hours of sunshine of an open field.
    pub fn hours(&self) -> f64 {
        self.moments.iter().map(|moment| moment.hours).sum()
    }

    /// What the hours are the sum of, for messages: with a step moments, without one all of the time, in parts.
    pub(crate) fn suns(&self) -> String {
        let (count, spec) = (self.moments.len(), &self.spec);
        match spec.step {
            Some(step) => format!("{count} moments {step} min apart"),
            None => {
                let (from, to) = (clock(spec.from), clock(spec.to));
                format!("all the time from {from} to {to} by {count} parts of the sun's way")
            }
        }
    }

    /// Decimals of hours that mean something: multiples of the step can be told apart; without one, half a minute can.
    pub(crate) fn decimals(&self) -> usize {
        if self.spec.step.is_some_and(|step| step.is_multiple_of(6)) { 1 } else { 2 }
    }

    /// Files of a run that writes hours of direct sun and no image.
    pub(crate) fn files(&self, order: &Order) -> Result<PictureFiles, RequestError> {
        let outputs = Outputs::new(hours_of_sun(order))?;
        outputs.keep("the scene", input(&order.scene))?;
        outputs.keep("grid_file", order.request.grid_file.as_deref())?;
        let options = save_options(&order.request);
        Ok(PictureFiles {
            picture: None,
            movie: None,
            options,
            exposure: order.request.exposure,
            layers: None,
            stats: None,
            outputs,
        })
    }

    /// When there is no sun, for a note: which moments have no frame, or of hours alone without a step, how much of the time.
    pub fn left_out(&self, has_frames: bool, words: Words) -> Option<String> {
        let (first, last) = (self.dark.first()?, self.dark.last()?);
        if self.spec.step.is_none() && !has_frames {
            let all = f64::from(self.spec.to - self.spec.from) / 60.0;
            let dark = all - self.hours();
            return Some(format!(
                "{}: {dark:.1} of {all:.1} hours have no direct sun: it is below the horizon then, and twilight is not modelled",
                words.of("sun")
            ));
        }
        let count = self.dark.len();
        let moments = if count == 1 { "moment is" } else { "moments are" };
        Some(format!(
            "{}: {count} {moments} left out, from {} to {}: the sun is below the horizon then, and twilight is not modelled",
            words.of("sun"),
            clock(*first),
            clock(*last)
        ))
    }
}

/// Checks that a file for hours can be written.
pub(super) fn hours_file(path: &Path, format: Option<HoursFormat>) -> Result<HoursFile, RequestError> {
    let format = format.or_else(|| HoursFormat::from_path(path));
    let format = format.ok_or_else(|| RequestError::HoursFormat { path: path.to_owned() })?;
    check_writable(path).map_err(OutputError::from)?;
    Ok(HoursFile { path: path.to_owned(), format })
}

/// The moments with sun, and those without.
fn moments(spec: &SunSpec) -> (Vec<SunMoment>, Vec<u32>) {
    let steps: Vec<u32> = (spec.from..=spec.to).step_by(spec.minutes() as usize).collect();
    let (mut moments, mut dark) = (Vec::new(), Vec::new());
    for (index, &minute) in steps.iter().enumerate() {
        let sun = position(spec, f64::from(minute));
        if !is_up(sun) {
            dark.push(minute);
            continue;
        }
        let before = index.checked_sub(1).map(|before| steps[before]);
        let earlier = before.map_or(0.0, |before| share(spec, minute, before));
        let later = match steps.get(index + 1) {
            Some(&after) => share(spec, minute, after),
            None => sunny(spec, minute, spec.to),
        };
        let [begin, end] = [-earlier, later].map(|minutes| f64::from(minute) + minutes);
        let span = [begin, 0.5 * (begin + end), end].map(|minute| position(spec, minute));
        moments.push(SunMoment { minute, sun, hours: (earlier + later) / 60.0, span });
    }
    (moments, dark)
}

/// The minutes of sunshine towards a neighbour: half of the way, or up to where the sun sets.
fn share(spec: &SunSpec, minute: u32, neighbour: u32) -> f64 {
    if is_up(position(spec, f64::from(neighbour))) {
        return 0.5 * f64::from(minute.abs_diff(neighbour));
    }
    sunny(spec, minute, neighbour)
}

/// The minutes from one with sun to where the sun sets, or rose, on the way to another.
fn sunny(spec: &SunSpec, minute: u32, other: u32) -> f64 {
    let (mut up, mut down) = (f64::from(minute), f64::from(other));
    if is_up(position(spec, down)) {
        return (down - up).abs();
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (up + down);
        *(if is_up(position(spec, middle)) { &mut up } else { &mut down }) = middle;
    }
    (up - f64::from(minute)).abs()
}

fn position(spec: &SunSpec, minute: f64) -> SunPosition {
    let position = SunPosition::of(spec.latitude, spec.longitude, &spec.moment(minute));
    position.expect("place and date were checked when they were read")
}

/// As for the sky.
fn is_up(sun: SunPosition) -> bool {
    (0.0..=90.0).contains(&sun.elevation)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn day(text: &str) -> (Vec<SunMoment>, Vec<u32>) {
        moments(&text.parse().unwrap())
    }

    fn hours(text: &str) -> f64 {
        day(text).0.iter().map(|moment| moment.hours).sum()
    }

    #[test]
    fn the_parts_of_moments_add_up_to_the_time_with_sun() {
        for step in ["15m", "1h", "7m", "45m", "7h", "24h"] {
            let found = hours(&format!("0,0,2026-03-20Z,07:00-17:00/{step}"));
            assert!((found - 10.0).abs() < 1e-9, "{step}: {found}");
        }
        let (moments, dark) = day("0,0,2026-03-20Z,07:00-17:00/1h");
        let parts: Vec<f64> = moments.iter().map(|moment| moment.hours).collect();
        assert_eq!((parts.len(), parts[0], parts[5], parts[10], dark.len()), (11, 0.5, 1.0, 0.5, 0));
        // A whole day; it begins and ends when the middle of the sun is seen at the horizon, a minute after and before sunrise and sunset.
        for step in ["1m", "15m", "1h"] {
            let found = hours(&format!("0,0,2026-03-20Z,00:00-24:00/{step}"));
            assert!((found - 12.077).abs() < 0.005, "{step}: {found}");
        }
    }

    #[test]
    fn a_published_day_is_found() {
        // New York, 2015-01-01: sunrise 07:20:02, sunset 16:38:16 by the calculator of NOAA, which the Ruby gem `sun` documents. That is when
        // the upper limb is seen, the true sun being 0.833 degrees below the horizon. The middle is seen when it is 0.57 degrees below, 1.6
        // minutes later and earlier at this latitude and season.
        let found = hours("40.75,-73.99,2015-01-01-05:00,00:00-24:00/15m");
        let expected = (16.0 + 38.0 / 60.0 + 16.0 / 3600.0) - (7.0 + 20.0 / 60.0 + 2.0 / 3600.0) - 2.0 * 1.6 / 60.0;
        assert!((found - expected).abs() < 0.015, "{found}, not {expected}");
    }

    #[test]
    fn poles_and_the_date_line() {
        let all_day = "2026-06-21Z,00:00-24:00/1h";
        assert!((hours(&format!("90,0,{all_day}")) - 24.0).abs() < 1e-9);
        assert!((hours(&format!("78.2,15.6,{all_day}")) - 24.0).abs() < 1e-9);
        assert!(day(&format!("-90,0,{all_day}")).0.is_empty() && day(&format!("-78.2,15.6,{all_day}")).0.is_empty());
        // Both names of the meridian, and both dates of it.
        let east = day("10,180,2026-06-21+12:00,06:00-20:00/1h");
        let west = day("10,-180,2026-06-20-12:00,06:00-20:00/1h");
        assert_eq!((east.0.len(), &east.1), (west.0.len(), &west.1));
        for (east, west) in east.0.iter().zip(&west.0) {
            assert!((east.sun.elevation - west.sun.elevation).abs() < 1e-4 && (east.hours - west.hours).abs() < 1e-4);
        }
        // In universal time, it is night there at noon.
        let (moments, dark) = day("10,180,2026-06-21Z,00:00-24:00/1h");
        assert!(dark.contains(&720) && moments[0].minute == 0 && moments.last().unwrap().minute == 1440);
    }
}
