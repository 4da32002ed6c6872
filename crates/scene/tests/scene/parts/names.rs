use lightmesh_scene::{Falloff, Up, Weight};

#[test]
fn names_are_read_and_written() {
    Weight::ALL.iter().for_each(|weight| assert_eq!(weight.to_string().parse(), Ok(*weight)));
    Falloff::ALL.iter().for_each(|falloff| assert_eq!(falloff.to_string().parse(), Ok(*falloff)));
    Up::ALL.iter().for_each(|up| assert_eq!(up.to_string().parse(), Ok(*up)));
    assert_eq!(format!("[{:>9}]", Weight::Smooth), "[   smooth]");
}

#[test]
fn an_unknown_name_is_answered_with_the_known() {
    let message = "soft".parse::<Weight>().unwrap_err().to_string();
    assert_eq!(message, "there is no weight `soft`; available: constant, quadratic, smooth");
    assert!("Smooth".parse::<Weight>().is_err() && "".parse::<Falloff>().is_err());
}
