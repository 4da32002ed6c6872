use lightmesh_scene::{Moment, Sky, SunPosition, Up};

#[test]
fn the_published_example_of_the_algorithm_is_found() {
    // Reda and Andreas 2003, table A5.1: zenith 50.11162°, azimuth 194.34024°, at 1830 m; the height changes little.
    let moment = "2003-10-17T12:30:30-07:00".parse().unwrap();
    let found = SunPosition::of(39.742476, -105.1786, &moment).unwrap();
    assert!((90.0 - found.elevation - 50.11162).abs() < 0.005, "{found:?}");
    assert!((found.azimuth - 194.34024).abs() < 0.001, "{found:?}");
}

#[test]
fn published_positions_are_found() {
    let at =
        |latitude, longitude, moment: &str| SunPosition::of(latitude, longitude, &moment.parse().unwrap()).unwrap();
    // NOAA's spreadsheet of solar calculations, as its port `pysunnoaa` documents: 47.3618°, 98.3069°.
    let morning = at(40.0, -105.0, "2010-06-21T09:54-06:00");
    assert!((morning.elevation - 47.3618).abs() < 0.01 && (morning.azimuth - 98.3069).abs() < 0.02, "{morning:?}");
    // New York: sunrise 07:20:02, noon 11:59:09 and sunset 16:38:16 by NOAA's calculator, as the Ruby gem `sun` documents. The true sun is
    // 0.833 degrees below the horizon then, and 0.327 more two minutes before and after, where nothing is refracted any more. All to the
    // minute, in which it sinks by 0.17 degrees and turns by 0.26 at noon.
    let [rise, noon, set] =
        ["07:18:02", "11:59:09", "16:40:16"].map(|time| at(40.75, -73.99, &format!("2015-01-01T{time}-05:00")));
    for horizon in [rise, set] {
        assert!((horizon.elevation + 0.833 + 0.327).abs() < 0.17, "{horizon:?}");
    }
    assert!((noon.azimuth - 180.0).abs() < 0.26, "{noon:?}");
    // The elevation at the pole is the declination: Meeus, Astronomical Algorithms, example 25.b, -7°47'01.7". The sun is seen from the
    // Earth's surface, which lowers it by 8.8".
    let pole = at(90.0, 0.0, "1992-10-12T23:59:01Z");
    assert!((pole.elevation + 7.78382 + 0.0024).abs() < 0.001, "{pole:?}");
}

#[test]
fn the_sun_alone_is_that_of_a_sky() {
    for up in [Up::Y, Up::Z] {
        for (elevation, azimuth, north) in [(3.0, 71.0, 0.0), (58.46, 180.0, 30.0), (90.0, 0.0, -12.5)] {
            let sun = SunPosition { elevation, azimuth };
            let sky = Sky { north, ..Sky::clear(sun) };
            let expected = sky.surroundings(up).unwrap().sun.unwrap();
            assert_eq!(sun.light(up, north).unwrap().kind, expected.kind);
        }
    }
}

#[test]
fn the_sun_is_in_the_south_at_noon_and_in_the_north_south_of_the_equator() {
    let at = |latitude, moment: &str| SunPosition::of(latitude, 0.0, &moment.parse().unwrap()).unwrap();
    // At an equinox, noon: 90° less the latitude.
    let noon = at(50.0, "2026-03-20T12:07Z");
    assert!((noon.elevation - 40.0).abs() < 0.3 && (noon.azimuth - 180.0).abs() < 1.0, "{noon:?}");
    let south = at(-50.0, "2026-03-20T12:07Z");
    assert!((south.elevation - 40.0).abs() < 0.3, "{south:?}");
    assert!(south.azimuth < 1.0 || south.azimuth > 359.0, "{south:?}");
    assert!(at(50.0, "2026-03-20T00:00Z").elevation < -30.0, "midnight");
    let morning = at(50.0, "2026-03-20 08:00Z");
    assert!((90.0..150.0).contains(&morning.azimuth), "{morning:?}");
    let same = |a: SunPosition, b: SunPosition| {
        (a.elevation - b.elevation).abs() < 1e-5 && (a.azimuth - b.azimuth).abs() < 1e-5
    };
    assert!(same(morning, at(50.0, "2026-03-20T10:00:00+02:00")));
    assert!(same(at(50.0, "2026-03-20T23:30Z"), at(50.0, "2026-03-21T01:00+01:30")), "another day there");
}

#[test]
fn what_is_no_moment_or_place_is_refused() {
    for text in
        ["", "2026-06-21", "2026-06-21T15:00", "15:00Z", "2026-06-21T15Z", "2026-06-21T24:00Z", "2026-6-21T15:60Z"]
    {
        let error = text.parse::<Moment>().unwrap_err().to_string();
        assert!(error.contains("2026-06-21T15:00+02:00"), "{text}: {error}");
    }
    for text in
        ["2026-06-21T15:00+2", "2026-06-21T15:00+19:00", "2026-06-21T15:00:61Z", "äöü-06-21T15:00Z", "2026-06-21Tä:00Z"]
    {
        assert!(text.parse::<Moment>().is_err(), "{text}");
    }
    let moment: Moment = "2026-06-31T12:00Z".parse().unwrap();
    assert!(SunPosition::of(0.0, 0.0, &moment).is_err(), "June has 30 days");
    let moment: Moment = "2026-06-30T12:00Z".parse().unwrap();
    let error = SunPosition::of(91.0, 0.0, &moment).unwrap_err().to_string();
    assert!(error.contains("latitude 91.0") && error.contains("-90 to 90"), "{error}");
}
