//! `-o film.mp4`: frames that go to ffmpeg. A script stands for it, which records its arguments and what it reads.

use std::os::unix::fs::PermissionsExt;

use crate::run::{Done, Place};

/// Lists encoders; else writes its arguments and frames, and a file.
const FFMPEG: &str = r#"#!/bin/sh
if [ "$2" = -encoders ]; then
    [ -z "$KILLED" ] || kill -9 $$
    echo " V....D libx264  H.264"
    [ -n "$NO_VP9" ] || echo " V....D libvpx-vp9  VP9"
    exit
fi
for last; do :; done
echo "$@" > arguments
if [ -n "$BROKEN" ]; then
    echo "no space" >&2
    exit 7
fi
cat > frames
echo "a movie" > "$last"
"#;

fn place() -> Place {
    let place = Place::new();
    place.write("ffmpeg.sh", FFMPEG);
    std::fs::set_permissions(place.path("ffmpeg.sh"), std::fs::Permissions::from_mode(0o755)).unwrap();
    place
}

fn run(place: &Place, variables: &[(&str, &str)], flags: &[&str]) -> Done {
    let mut command = place.command(&[&["render", "room.toml", "--turntable", "3"], flags].concat());
    command.env("LIGHTMESH_FFMPEG", "./ffmpeg.sh").envs(variables.iter().copied()).output().unwrap().into()
}

fn arguments(place: &Place) -> String {
    String::from_utf8(place.read("arguments")).unwrap()
}

#[test]
fn frames_go_to_the_encoder_and_the_movie_appears_as_a_whole() {
    let place = place();
    let done = run(&place, &[], &["-o", "a.mp4", "--size", "16x12", "--fps", "30000/1001", "--layers", "l.#.exr"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    let arguments = arguments(&place);
    for part in [
        "-f rawvideo -pixel_format rgb24 -video_size 16x12 -framerate 30000/1001 -i pipe:0",
        "-vf scale=out_color_matrix=bt709:out_range=tv,setparams=colorspace=bt709:color_primaries=bt709:color_trc=bt709:range=tv ",
        "-colorspace bt709 -color_primaries bt709 -color_trc bt709",
        "-c:v libx264 -pix_fmt yuv420p -preset medium -crf 18 -movflags +faststart -f mp4",
    ] {
        assert!(arguments.contains(part), "{part} in {arguments}");
    }
    assert_eq!(place.read("a.mp4"), b"a movie\n");
    let files = place.files();
    assert_eq!(files, ["a.mp4", "arguments", "ffmpeg.sh", "frames", "l.1.exr", "l.2.exr", "l.3.exr", "room.toml"]);

    // The frames are those of bmp files, whose rows are stored from the bottom and blue first.
    let done = run(&place, &[], &["-o", "b.#.bmp", "--size", "16x12"]);
    assert_eq!(done.code, Some(0), "{done:?}");
    let frames = place.read("frames");
    assert_eq!(frames.len(), 3 * 16 * 12 * 3);
    for (frame, name) in frames.chunks(16 * 12 * 3).zip(["b.1.bmp", "b.2.bmp", "b.3.bmp"]) {
        let rows = place.read(name)[54..].chunks(48).rev().flatten().copied().collect::<Vec<u8>>();
        let pixels: Vec<u8> = rows.chunks(3).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        assert!(frame == pixels, "{name}");
    }
}

#[test]
fn sides_are_even_and_bits_are_kept() {
    let place = place();
    let flags = ["-o", "a.webm", "--size", "15x11", "--bit-depth", "16", "--frames", "2-3"];
    let done = run(&place, &[], &flags);
    assert!(done.code == Some(0) && done.stderr.contains("a movie needs even sides: 16x12 pixels"), "{done:?}");
    let arguments = arguments(&place);
    assert!(arguments.contains("-pixel_format rgb48be -video_size 16x12 -framerate 24 "), "{arguments}");
    assert!(arguments.contains("-c:v libvpx-vp9 ") && arguments.contains(" -f webm "), "{arguments}");
    let frames = place.read("frames");
    assert_eq!(frames.len(), 2 * 16 * 12 * 6);
    let rows: Vec<&[u8]> = frames.chunks(16 * 6).collect();
    assert!(rows.iter().all(|row| row[14 * 6..15 * 6] == row[15 * 6..]) && rows[10] == rows[11]);
}

#[test]
fn what_cannot_be_encoded_is_refused_before_the_work() {
    let place = place();
    let refused = |variables: &[(&str, &str)], flags: &[&str]| {
        let before = place.files();
        let done = run(&place, variables, &[&["--size", "8x6"], flags].concat());
        assert_eq!((done.code, place.files()), (Some(2), before), "{flags:?}: {done:?}");
        done.stderr.lines().find(|line| line.starts_with("error: ")).unwrap().to_owned()
    };
    let none = refused(&[("LIGHTMESH_FFMPEG", "./none")], &["-o", "a.mp4"]);
    assert!(none.contains("a.mp4 needs ./none to encode it, but ./none does not start ("), "{none}");
    assert!(none.contains("; install ffmpeg, name it by LIGHTMESH_FFMPEG, or write frames"), "{none}");
    let lacking = refused(&[("NO_VP9", "1")], &["-o", "a.webm"]);
    assert!(lacking.contains("a.webm needs the encoder libvpx-vp9, but ./ffmpeg.sh lacks it"), "{lacking}");
    let killed = refused(&[("KILLED", "1")], &["-o", "a.mp4"]);
    assert!(killed.contains("`./ffmpeg.sh -encoders` failed (signal: 9 (SIGKILL)): it says nothing; "), "{killed}");
    assert!(killed.contains("check the free memory") && !killed.contains("lacks"), "{killed}");
    for flag in ["--resume", "--skip-existing"] {
        let kept = refused(&[], &["-o", "a.mp4", flag]);
        assert!(kept.contains(&format!("{flag} keeps frames, but -o a.mp4 is one file")), "{kept}");
        assert!(kept.contains("write frames, as in -o film.####.png, and join them with ffmpeg"), "{kept}");
    }
    assert!(refused(&[], &["-o", "a.mp4", "--background", "transparent"]).contains("movies have no alpha"));
    assert!(refused(&[], &["-o", "a.mp4", "--format", "png"]).contains("--format names an image format"));
    assert!(
        refused(&[], &["-o", "a.mp4", "--stats", "a.json"]).contains("--stats a.json is one file, but a film has one")
    );
    let mut still = place.command(&["render", "room.toml", "-o", "a.mp4"]);
    let still: Done = still.env("LIGHTMESH_FFMPEG", "./ffmpeg.sh").output().unwrap().into();
    assert!(still.stderr.contains("nothing in the scene moves; add --turntable N"), "{still:?}");
    place.write("b.mp4", "mine");
    assert!(refused(&[], &["-o", "b.mp4"]).contains("b.mp4 exists; add --overwrite to replace it"));
    assert_eq!(run(&place, &[], &["--size", "8x6", "-o", "b.mp4", "--overwrite"]).code, Some(0));
    assert_eq!(place.read("b.mp4"), b"a movie\n");
}

#[test]
fn an_encoder_that_fails_leaves_the_earlier_movie() {
    let place = place();
    place.write("a.mkv", "mine");
    let done = run(&place, &[("BROKEN", "1")], &["-o", "a.mkv", "--overwrite", "--size", "300x200"]);
    assert_eq!(done.code, Some(2), "{done:?}");
    let message = done.stderr.lines().last().unwrap();
    assert!(message.contains("cannot write a.mkv: ./ffmpeg.sh failed (exit status: 7): no space; check"), "{message}");
    assert_eq!(place.read("a.mkv"), b"mine");
    assert_eq!(place.files(), ["a.mkv", "arguments", "ffmpeg.sh", "room.toml"]);
}
