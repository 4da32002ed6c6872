use lightmesh_render::{Seconds, Stage};

#[test]
fn every_stage_has_its_seconds() {
    let mut seconds = Seconds::default();
    for (stage, value) in Stage::ALL.into_iter().zip(1..) {
        *seconds.of_mut(stage) = f64::from(value);
    }
    for (stage, value) in Stage::ALL.into_iter().zip(1..) {
        assert_eq!(seconds.of(stage), f64::from(value), "{}", stage.name());
    }
}
