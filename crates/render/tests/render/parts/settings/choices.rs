use lightmesh_render::{Lookup, Mode, Quality, ShadowTests, ShortTests, Step};

#[test]
fn names_are_read_and_written() {
    Mode::ALL.iter().for_each(|mode| assert_eq!(mode.to_string().parse(), Ok(*mode)));
    Lookup::ALL.iter().for_each(|lookup| assert_eq!(lookup.to_string().parse(), Ok(*lookup)));
    ShortTests::ALL.iter().for_each(|tests| assert_eq!(tests.to_string().parse(), Ok(*tests)));
    ShadowTests::ALL.iter().for_each(|tests| assert_eq!(tests.to_string().parse(), Ok(*tests)));
    Quality::ALL.iter().for_each(|quality| assert_eq!(quality.to_string().parse(), Ok(*quality)));
    assert_eq!(
        "soft".parse::<Mode>().unwrap_err().to_string(),
        "there is no mode `soft`; available: light-mesh, ray-trace, area"
    );
}

#[test]
fn steps_are_auto_or_a_number_above_0() {
    for step in [Step::Auto, Step::Fixed(0.1), Step::Fixed(1e-7)] {
        assert_eq!(step.to_string().parse(), Ok(step));
    }
    for text in ["", "0", "-1", "nan", "inf", "1e99", "1e-99", "Auto"] {
        assert!(text.parse::<Step>().is_err(), "{text}");
    }
}
