//! Values of flags: each text is read as every kind of value. What is accepted must be in range and mean the same when it is
//! written again; what is not must be told in one sentence.
#![no_main]

use std::fmt::Debug;
use std::path::Path;
use std::str::FromStr;
use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use lightmesh::request::value::{
    Background, Bound, ByteSize, CameraView, Color, Dims, EnvironmentSpec, Exposure, FrameRate, Frames, LightSpec,
    Positive, Size, SkySpec, Smooth, SunSpec, ValueError, clock, numbered,
};
use lightmesh::scene::SkyKind;

// The program's own module: it needs nothing else of it.
#[path = "../../crates/cli/src/budget.rs"]
mod budget;

use budget::Budget;

/// Messages quote a part of the text and explain the rest.
const EXPLANATION: usize = 200;

fuzz_target!(|text: &str| {
    read::<Size>(text, |Size([width, height])| {
        assert!(*width > 0 && *height > 0);
        format!("{width}x{height}")
    });
    read::<Dims>(text, |Dims([x, y, z])| {
        assert!(*x > 0 && *y > 0 && *z > 0);
        format!("{x}x{y}x{z}")
    });
    read::<ByteSize>(text, |ByteSize(bytes)| {
        assert!(*bytes > 0);
        bytes.to_string()
    });
    read::<Budget>(text, |Budget(time)| {
        assert!(*time > Duration::ZERO);
        // A nanosecond is the smallest part of a time.
        format!("{:.9}", time.as_secs_f64())
    });
    read::<Smooth>(text, |smooth| {
        assert!(smooth.0.is_none_or(|crease| crease.degrees() > 0.0 && crease.degrees() <= 180.0));
        smooth.to_string()
    });
    read_numbers(text);
    read_places(text);
    read_frames(text);
});

fn read_frames(text: &str) {
    read::<Frames>(text, |frames| {
        assert!(frames.numbers().next() == Some(frames.first()) && frames.first() <= frames.last());
        frames.to_string()
    });
    read::<FrameRate>(text, |rate| {
        assert!(rate.time(1) == 0.0 && rate.time(2) > 0.0 && rate.last_frame(rate.time(9)) == 9);
        rate.to_string()
    });
    assert_eq!(FrameRate::default().to_string(), "24");
    assert!(Frames::up_to(3).numbers().eq(1..=3));
    if let Some(file) = numbered(Path::new(text), 7) {
        assert!(file.to_string_lossy().contains('7'), "{text:?} is written as {}", file.display());
    }
}

fn read_numbers(text: &str) {
    read::<Positive>(text, |Positive(number)| {
        assert!(*number > 0.0 && number.is_finite());
        number.to_string()
    });
    read::<Bound>(text, |Bound(number)| {
        assert!(*number >= 0.0 && number.is_finite());
        number.to_string()
    });
    read::<Exposure>(text, |exposure| match exposure {
        Exposure::Auto => "auto".to_owned(),
        Exposure::Stops(stops) => {
            assert!(stops.is_finite());
            stops.to_string()
        }
    });
    read::<Color>(text, color);
    read::<Background>(text, |background| match background {
        Background::Transparent => "transparent".to_owned(),
        Background::Color(behind) => color(behind),
    });
}

fn read_places(text: &str) {
    read::<LightSpec>(text, |light| {
        assert!(light.position.as_vec3().is_finite());
        assert!(light.radius >= 0.0 && light.radius.is_finite());
        let [x, y, z] = light.position.to_array();
        format!("{x},{y},{z};{};{}", color(&Color(light.intensity)), light.radius)
    });
    assert!(matches!(SkySpec::clear().sky.kind, SkyKind::Clear { .. }));
    read::<SkySpec>(text, |SkySpec { sky, alone }| {
        let kind = match sky.kind {
            SkyKind::Clear { sun, turbidity, ground } => {
                assert!(sun.elevation.is_finite() && sun.azimuth.is_finite() && turbidity.is_finite());
                let ground = color(&Color(ground));
                format!("clear;sun={},{};turbidity={turbidity};ground={ground}", sun.elevation, sun.azimuth)
            }
            SkyKind::Uniform { color: all } => format!("uniform;color={}", color(&Color(all))),
            SkyKind::Gradient { zenith, horizon, ground } => {
                let [zenith, horizon, ground] = [zenith, horizon, ground].map(|part| color(&Color(part)));
                format!("gradient;zenith={zenith};horizon={horizon};ground={ground}")
            }
        };
        format!("{kind};north={};strength={}{}", sky.north, sky.strength, if *alone { ";alone" } else { "" })
    });
    read::<SunSpec>(text, |spec| {
        assert!(spec.from < spec.to && spec.to <= 1440 && spec.step != Some(0));
        assert!(clock(spec.to).len() == 5 && spec.moment(f64::from(spec.to)).time[0] < 24);
        spec.to_string()
    });
    read::<EnvironmentSpec>(text, |spec| {
        assert!(spec.rotation.is_finite() && spec.strength >= 0.0 && spec.strength.is_finite());
        let alone = if spec.alone { ";alone" } else { "" };
        format!("{};rotation={};strength={}{alone}", spec.file.display(), spec.rotation, spec.strength)
    });
    read::<CameraView>(text, |view| {
        assert!(view.position.as_vec3().is_finite() && view.direction().normalize().is_finite());
        assert!(view.vfov > 0.0 && view.vfov < 180.0);
        view.to_string()
    });
}

fn color(Color(color): &Color) -> String {
    assert!(color.is_finite() && color.min_element() >= 0.0);
    let [r, g, b] = color.to_array();
    format!("{r},{g},{b}")
}

/// Reads a value; what `write` makes of it must be read as the same.
fn read<T: FromStr<Err = ValueError> + PartialEq + Debug>(text: &str, write: impl Fn(&T) -> String) {
    let Some(value) = parsed::<T>(text) else { return };
    let written = write(&value);
    assert_eq!(written.parse().as_ref(), Ok(&value), "{text:?} is written as {written}");
}

fn parsed<T: FromStr<Err = ValueError>>(text: &str) -> Option<T> {
    let refused = match text.parse() {
        Ok(value) => return Some(value),
        Err(refused) => refused,
    };
    let message = refused.to_string();
    assert!(message.len() <= text.len() + EXPLANATION, "{message}");
    None
}
