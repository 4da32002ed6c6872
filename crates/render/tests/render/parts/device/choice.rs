use lightmesh_render::{Choice, Device, DeviceList, RenderError};

#[test]
fn the_processor_can_always_be_chosen() {
    let choice = Choice::of(Device::Cpu).unwrap();
    assert_eq!(choice.device, Device::Cpu);
    assert!(choice.reason.starts_with("cpu (") && choice.no_cuda.is_none(), "{}", choice.reason);
}

#[test]
fn what_is_left_open_is_decided_and_explained() {
    let choice = Choice::of(Device::Auto).unwrap();
    match choice.device {
        Device::Cuda(Some(number)) => {
            assert!(choice.reason.starts_with(&format!("cuda:{number} (")), "{}", choice.reason)
        }
        Device::Cpu => assert!(choice.no_cuda.is_some_and(|why| !why.is_empty()), "{}", choice.reason),
        other => panic!("{other} is not decided"),
    }
}

#[test]
fn a_device_that_is_not_there_is_an_error() {
    // Of several, all must be there.
    assert!(matches!(
        Choice::of(DeviceList::of_cuda(&[0, 63]).unwrap().into()),
        Err(RenderError::Device { device, .. }) if ["cuda:0", "cuda:63"].contains(&&*device)
    ));
    let refused = Choice::of(Device::Cuda(Some(4096)));
    let Err(RenderError::Device { device, reason }) = refused.map(|choice| choice.device) else {
        panic!("4097 devices")
    };
    assert_eq!(device, "cuda:4096");
    assert!(!reason.is_empty());
}
