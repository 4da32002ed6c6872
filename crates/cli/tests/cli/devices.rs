//! Devices: what is listed, what is used, and what is reported if there is none. Expectations depend on the machine and come from
//! `lightmesh info --devices --json`.

use serde_json::{Value, json};

use crate::run::{Done, LAMP, Place};

/// Runs with the machine's devices.
fn run(place: &Place, args: &[&str]) -> Done {
    place.command_with_devices(args).output().unwrap().into()
}

/// Renders on a device.
fn render_on(place: &Place, device: &str) -> Done {
    let base = ["render", "room.toml", "-o", "a.exr", "--size", "48x32", "--light", LAMP, "--stats", "a.json"];
    run(place, &[&base[..], &["--device", device]].concat())
}

/// What `info --devices --json` lists.
fn listed(done: &Done) -> Vec<Value> {
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    json["devices"].as_array().unwrap().clone()
}

fn devices(place: &Place) -> Vec<Value> {
    listed(&run(place, &["info", "--devices", "--json"]))
}

/// The first CUDA device that can be used, if there is one.
fn first_cuda(devices: &[Value]) -> Option<&str> {
    let usable = devices.iter().find(|it| it["usable"] == true && it["device"] != "cpu")?;
    usable["device"].as_str()
}

/// Whether the reason is that there is no driver.
fn is_missing(why: &str) -> bool {
    why.starts_with("NVIDIA's driver is not installed")
}

/// What an ordinary run says of it.
fn short(why: &str) -> String {
    if is_missing(why) { "NVIDIA's driver is not installed (--device".to_owned() } else { why.to_owned() }
}

#[test]
fn devices_are_listed() {
    let place = Place::new();
    let devices = devices(&place);
    let text = run(&place, &["info", "--devices"]).stdout;
    assert_eq!((&devices[0]["device"], &devices[0]["usable"]), (&json!("cpu"), &json!(true)));
    assert!(devices.len() > 1, "CUDA is listed, whether it is available or not");
    assert_eq!(text.lines().count(), devices.len());
    for (line, device) in text.lines().zip(&devices) {
        let state = if device["usable"] == true { "usable: " } else { "not usable: " };
        let start = format!("{:8}{state}{}", device["device"].as_str().unwrap(), device["name"].as_str().unwrap());
        assert!(line.starts_with(&start), "{line}: {device}");
        assert_ne!(device["remark"], "", "{device}");
    }
    for cuda in devices[1..].iter().filter(|it| it["usable"] == true) {
        assert!(cuda["memory_bytes"].as_u64().unwrap() >= cuda["free_bytes"].as_u64().unwrap(), "{cuda}");
        assert!(cuda["compute_capability"].is_string() && cuda["driver_cuda_version"].is_string(), "{cuda}");
    }
    place.refused(&["info", "room.toml", "--devices"]);
}

#[test]
fn every_usable_device_renders_the_picture_and_says_that_it_did() {
    let place = Place::new();
    assert_eq!(render_on(&place, "cpu").code, Some(0));
    std::fs::rename(place.path("a.exr"), place.path("cpu.exr")).unwrap();
    for device in devices(&place).iter().filter(|it| it["usable"] == true) {
        let word = device["device"].as_str().unwrap();
        let done = render_on(&place, word);
        assert_eq!(done.code, Some(0), "{word}: {done:?}");
        let stats = place.json("a.json")["device"].clone();
        assert_eq!((&stats["kind"], &stats["name"]), (&json!(word.split(':').next()), &device["name"]));
        place.good(&["compare", "cpu.exr", "a.exr", "--max-rmse", "0.001"]);
    }
}

#[test]
fn a_device_that_cannot_be_used_has_exit_code_3_and_says_why() {
    let place = Place::new();
    let before = place.files();
    let devices = devices(&place);
    let mut asked = vec![("cuda:4096", String::new())];
    let unusable = devices.iter().filter(|it| it["usable"] == false);
    asked.extend(unusable.map(|it| (it["device"].as_str().unwrap(), short(it["remark"].as_str().unwrap()))));
    for (device, why) in asked {
        let done = render_on(&place, device);
        assert_eq!(done.code, Some(3), "{device}: {done:?}");
        let error = done.stderr.lines().last().unwrap();
        assert!(error.starts_with(&format!("error: device {device} cannot be used: ")), "{error}");
        assert!(error.contains(&why), "{error}: {why}");
    }
    assert_eq!(place.files(), before);
}

#[test]
fn what_auto_takes_is_said_with_the_reason() {
    let place = Place::new();
    let devices = devices(&place);
    let done = render_on(&place, "auto");
    let line = done.stderr.lines().find(|line| line.starts_with("device auto: using ")).unwrap();
    match first_cuda(&devices) {
        Some(device) => assert!(line.starts_with(&format!("device auto: using {device} (")), "{line}"),
        None => {
            assert!(line.starts_with("device auto: using cpu ("), "{line}");
            let why = devices[1]["remark"].as_str().unwrap();
            assert!(
                line.ends_with("; no CUDA device (-v says why)") || !line.contains("CUDA") && is_missing(why),
                "{line}"
            );
            assert!(!done.stderr.contains("libcuda") && !done.stderr.contains("container"), "{done:?}");
            let long = place.good(&["render", "room.toml", "-o", "b.png", "--size", "8x8", "-v"]).stderr;
            assert!(long.contains("; no CUDA device can be used: ") && long.contains(why), "{long}");
            assert!(
                long.contains("seconds: ") && long.contains("primary_rays") && long.contains("host_peak_bytes"),
                "{long}"
            );
        }
    }
    assert!(!render_on(&place, "cpu").stderr.contains("using"));
}

#[test]
fn devices_can_be_hidden() {
    let place = Place::new();
    let hidden = listed(&place.good(&["info", "--devices", "--json"]));
    assert_eq!(first_cuda(&hidden), None);
    let done = place.run(&["render", "room.toml", "-o", "a.exr", "--size", "24x16", "--device", "cuda"]);
    assert_eq!(done.code, Some(3), "{done:?}");
    let why = hidden[1]["remark"].as_str().unwrap();
    assert!(done.stderr.contains(&short(why)) && done.stderr.lines().count() == 1, "{done:?}");
    let long = place.run(&["render", "room.toml", "-o", "a.exr", "--device", "cuda", "-v"]);
    assert!(long.code == Some(3) && long.stderr.contains(why), "{long:?}");
    if first_cuda(&devices(&place)).is_some() {
        assert!(done.stderr.contains("CUDA_VISIBLE_DEVICES is \"-1\" and hides every device"), "{done:?}");
    }
}
