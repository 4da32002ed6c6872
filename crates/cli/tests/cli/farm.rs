//! `lightmesh farm`: jobs for farms. Whether engines take and run them is tested in Python, where these are.

use serde_json::{Value, json};

use crate::run::{LAMP, Place};

const FILM: [&str; 7] = ["farm", "room.toml", "--turntable", "12", "--frames-to", "out/f.####.png", "-q"];

fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("out")).unwrap();
    place
}

/// The job that is written with more flags.
fn job(place: &Place, flags: &[&str]) -> Value {
    place.good(&[&FILM[..], &["-o", "job.json"], flags].concat());
    place.json("job.json")
}

fn parameter<'a>(job: &'a Value, name: &str) -> &'a Value {
    let all = job["parameterDefinitions"].as_array().unwrap();
    all.iter().find(|parameter| parameter["name"] == name).unwrap_or(&Value::Null)
}

fn arguments(job: &Value) -> Vec<&str> {
    let arguments = &job["steps"][0]["script"]["actions"]["onRun"]["args"];
    arguments.as_array().unwrap().iter().map(|argument| argument.as_str().unwrap()).collect()
}

#[test]
fn what_people_change_is_a_parameter_and_the_rest_an_argument() {
    let place = place();
    let flags = ["--light", LAMP, "--size", "64x48", "--device", "cuda:0,1", "--threads", "4", "--exposure=-1"];
    let job = job(&place, &flags);
    assert_eq!(
        (&job["specificationVersion"], &job["extensions"]),
        (&json!("jobtemplate-2023-09"), &json!(["TASK_CHUNKING"]))
    );
    let default = |name| &parameter(&job, name)["default"];
    assert_eq!(
        ["Scene", "OutputFolder", "Frames", "Size", "Quality", "FramesPerTask", "Program"].map(default),
        [
            &json!("room.toml"),
            &json!("out"),
            &json!("1-12"),
            &json!("64x48"),
            &json!("good"),
            &json!(10),
            &json!("lightmesh")
        ]
    );
    let arguments = arguments(&job);
    assert_eq!(arguments[..3], ["render", "{{Param.Scene}}", "--frames={{Task.Param.Frames}}"]);
    assert!(arguments.iter().any(|text| text.starts_with("3,5,2;0.9")), "{arguments:?}");
    for pair in [["--turntable", "12"], ["-o", "{{Param.OutputFolder}}/f.####.png"], ["--size", "{{Param.Size}}"]] {
        assert!(arguments.windows(2).any(|two| two == pair), "{pair:?}: {arguments:?}");
    }
    assert!(arguments.contains(&"--resume") && arguments.contains(&"--exposure=-1"), "{arguments:?}");
    let needed = &job["steps"][0]["hostRequirements"]["amounts"];
    assert_eq!(needed, &json!([{"name": "amount.worker.gpu", "min": 2}, {"name": "amount.worker.vcpu", "min": 4}]));
    let constraint = |job: &Value| {
        let parameters = &job["steps"][0]["parameterSpace"]["taskParameterDefinitions"];
        parameters[0]["chunks"]["rangeConstraint"].clone()
    };
    assert_eq!(constraint(&job), "NONCONTIGUOUS");
    let alone = self::job(&place, &["--no-server", "--chunks", "contiguous"]);
    assert!(alone["steps"][0].get("stepEnvironments").is_none() && !self::arguments(&alone).contains(&"--server"));
    assert_eq!(constraint(&alone), "CONTIGUOUS");
}

#[test]
fn frames_are_those_of_the_film() {
    let place = place();
    let of = |frames| parameter(&job(&place, &["--frames", frames]), "Frames")["default"].clone();
    assert_eq!([of("2-9x3"), of("7,9-11,10"), of("1-5,5-7")], ["2-8:3", "7-9:2,10-11", "1-7"].map(|text| json!(text)));
    let message = place.refused(&[&FILM[..], &["-o", "job.yaml", "--frames", "5-20"]].concat());
    assert!(message.contains("the film ends with frame 12"), "{message}");
    // Frames that are there are the tasks' business.
    place.write("out/f.0003.png", "");
    assert_eq!(of("1-12"), "1-12");
}

#[test]
fn files_elsewhere_are_given_when_the_job_is_submitted() {
    let place = place();
    std::fs::create_dir(place.path("jobs")).unwrap();
    let film = ["farm", "room.toml", "--turntable", "2", "--frames-to", "out/f.#.png"];
    let done = place.good(&[&film[..], &["-o", "jobs/job.json"]].concat());
    let job = place.json("jobs/job.json");
    for name in ["Scene", "OutputFolder"] {
        assert!(parameter(&job, name).get("default").is_none(), "{name}");
        assert!(done.stderr.contains(&format!(" -p {name}=/")), "{done:?}");
    }
    let done = place.good(&[&film[..], &["-o", "job.json"]].concat());
    assert!(!done.stderr.contains(" -p "), "{done:?}");
}

#[test]
fn all_text_is_quoted_in_yaml() {
    let place = place();
    place.good(&[&FILM[..], &["-o", "job.yaml"]].concat());
    let yaml = String::from_utf8(place.read("job.yaml")).unwrap();
    assert!(yaml.contains("default: '1-12'") && yaml.contains("- '12'"), "{yaml}");
    for line in yaml.lines().map(|line| line.trim_start_matches([' ', '-'])) {
        let (_, value) = line.split_once(": ").unwrap_or(("", line));
        let is_plain = value.ends_with(':') || value.parse::<u32>().is_ok() || value.starts_with(['\'', '"']);
        assert!(is_plain, "{line}");
    }
    let printed = place.good(&[&FILM[..], &["-o", "-"]].concat()).stdout;
    assert_eq!(printed, yaml);
}

#[test]
fn jobs_that_no_farm_can_render_are_refused() {
    let place = place();
    let film = ["farm", "room.toml", "--turntable", "3"];
    for (flags, sentence) in [
        (&["--frames-to", "f.#.png", "-o", "job.txt"][..], "-o job.txt: a job is a .yaml or a .json file"),
        (&["--frames-to", "f.mp4", "-o", "job.yaml"], "--frames-to f.mp4: tasks write frames"),
        (&["--frames-to", "f.png", "-o", "job.yaml"], "--frames-to f.png: each frame needs a name of its own"),
        (&["--frames-to", "f{{.#.png", "-o", "job.yaml"], "`f{{.#.png` contains {{ or }}"),
        (&["--frames-to", "f}}.#.png", "-o", "job.yaml"], "`f}}.#.png` contains {{ or }}"),
        (&["--frames-to", "-", "-o", "job.yaml"], "--frames-to -: tasks of a farm write files"),
    ] {
        let message = place.refused(&[&film[..], flags].concat());
        assert!(message.contains(sentence), "{message}");
    }
    let still = ["farm", "room.toml", "--frames-to", "f.#.png", "-o", "job.yaml"];
    assert!(place.refused(&still).contains("nothing in the scene moves"));
    let message = place.refused(&[
        "farm",
        "-",
        "--scene-format",
        "toml",
        "--turntable",
        "2",
        "--frames-to",
        "f.#.png",
        "-o",
        "a.yaml",
    ]);
    assert!(message.contains("a scene on standard input cannot be read by a farm"), "{message}");
}
