use lightmesh_render::internals::cuda::{Gpu, Needs, Unavailable, Version};

const NEEDS: Needs = Needs { cuda: Version { major: 12, minor: 4 }, driver: 550, capability: 75 };

#[test]
fn what_is_missing_comes_with_what_to_do() {
    let messages = [
        (Unavailable::NoPlatform("macos"), ["CUDA is not available", "macos"]),
        (Unavailable::NoLibrary { library: "libcuda.so.1", needed: 550 }, ["libcuda.so.1", "install version 550"]),
        (Unavailable::NotADriver { symbol: "cuInit", needed: 550 }, ["lacks cuInit", "version 550"]),
        (
            Unavailable::TooOld { version: Version { major: 11, minor: 4 }, needs: NEEDS },
            ["supports CUDA 11.4, but CUDA 12.4 is needed", "driver 550 or newer"],
        ),
        (Unavailable::Hidden("-1".into()), ["CUDA_VISIBLE_DEVICES is \"-1\"", "unset it"]),
        (Unavailable::NoDevice, ["finds no CUDA device", "nvidia-smi"]),
        (Unavailable::Failed("unknown".into()), ["does not start (unknown)", "nvidia-smi"]),
    ];
    for (reason, parts) in messages {
        let text = reason.explained();
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    }
}

#[test]
fn a_driver_that_is_missing_is_said_in_a_few_words() {
    let missing = Unavailable::NoLibrary { library: "libcuda.so.1", needed: 550 };
    assert_eq!(missing.to_string(), "NVIDIA's driver is not installed");
    assert!(missing.explained().starts_with("NVIDIA's driver is not installed (libcuda.so.1 was not found): install"));
    assert!(Unavailable::NoPlatform("macos").is_ordinary() && !Unavailable::NoDevice.is_ordinary());
}

#[test]
fn devices_before_turing_are_refused() {
    let gpu = |capability| Gpu { number: 0, name: "Tesla".into(), capability, memory: 1 << 34, pools: true, handle: 0 };
    assert!(gpu(70).refusal(NEEDS).unwrap().starts_with("compute capability 7.0, but 7.5 is needed"));
    assert_eq!(gpu(75).refusal(NEEDS), None);
    assert_eq!(gpu(120).refusal(NEEDS), None);
}
