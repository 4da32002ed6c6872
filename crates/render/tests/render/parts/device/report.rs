use lightmesh_render::devices;
use lightmesh_render::internals::cuda::{Gpu, Version};
use lightmesh_render::internals::device::{described, facts};

#[test]
fn the_processor_comes_first_and_cuda_is_always_spoken_of() {
    let devices = devices();
    assert_eq!((devices[0].device.as_str(), devices[0].usable), ("cpu", true));
    assert!(devices.len() > 1 && devices[1..].iter().all(|report| report.device.starts_with("cuda")), "{devices:?}");
    assert!(devices.iter().all(|report| !report.remark.is_empty()), "{devices:?}");
}

#[test]
fn a_cuda_device_is_described_in_one_line() {
    let gpu = Gpu { number: 1, name: "Fake".into(), capability: 90, memory: 3 << 30, pools: true, handle: 0 };
    let version = Version { major: 12, minor: 4 };
    let text = "3.0 GiB (1.5 GiB free), compute capability 9.0, driver for CUDA 12.4";
    assert_eq!(facts(&gpu, Some(3 << 29), version, None), text);
    assert_eq!(
        facts(&gpu, Some(3 << 29), version, Some("1,0")),
        format!("{text}, numbered by CUDA_VISIBLE_DEVICES=1,0")
    );
    let report = described(&gpu, version);
    assert_eq!((report.device.as_str(), report.usable), ("cuda:1", false));
    assert_eq!(report.compute_capability.as_deref(), Some("9.0"));
}
