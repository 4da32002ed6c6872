use lightmesh_render::internals::cuda::{Gpu, no_such_device};

fn gpu(number: u32, capability: u32) -> Gpu {
    Gpu { number, name: "Fake".into(), capability, memory: 1 << 30, pools: false, handle: 0 }
}

#[test]
fn a_wrong_number_is_answered_with_what_there_is() {
    let devices = [gpu(0, 75), gpu(1, 90)];
    let text = no_such_device(&devices, None);
    assert_eq!(text, "there is no such device, only cuda:0 (Fake), cuda:1 (Fake)");
    let text = no_such_device(&devices[..1], Some("3".into()));
    assert!(
        text.ends_with("only cuda:0 (Fake); CUDA_VISIBLE_DEVICES is \"3\", which chooses and numbers them"),
        "{text}"
    );
}
