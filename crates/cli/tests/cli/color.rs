//! Colours of messages, and what is shown without a terminal.

use crate::run::Place;

const RED: &str = "\u{1b}[1m\u{1b}[31merror:\u{1b}[0m ";

/// What a command says on standard error.
fn stderr(place: &Place, args: &[&str], variables: &[(&str, &str)]) -> String {
    let mut command = place.command(args);
    let cleared =
        ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"].iter().fold(&mut command, |command, name| command.env_remove(name));
    let done = cleared.envs(variables.iter().copied()).output().unwrap();
    String::from_utf8(done.stderr).unwrap()
}

#[test]
fn the_parsers_messages_and_our_own_have_the_same_colors() {
    let place = Place::new();
    for wrong in [&["info", "none.toml"][..], &["info", "--sise"], &["render", "room.toml"]] {
        let plain = stderr(&place, wrong, &[]);
        assert!(plain.starts_with("error: ") && !plain.contains('\u{1b}'), "{plain:?}");
        for (args, variables) in [
            ([&["--color", "always"], wrong].concat(), &[("NO_COLOR", "1")][..]),
            ([wrong, &["--color=always"]].concat(), &[]),
            (wrong.to_vec(), &[("CLICOLOR_FORCE", "1")]),
        ] {
            let colored = stderr(&place, &args, variables);
            assert!(colored.starts_with(RED), "{colored:?}");
        }
        for (args, variables) in [
            ([wrong, &["--color", "never"]].concat(), &[("CLICOLOR_FORCE", "1")][..]),
            (wrong.to_vec(), &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]),
        ] {
            let again = stderr(&place, &args, variables);
            assert_eq!(again.lines().next(), plain.lines().next());
            assert!(!again.contains('\u{1b}'), "{again:?}");
        }
    }
    place.write("odd.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let warning = stderr(&place, &["grid", "odd.obj", "-o", "a.grid", "--color", "always"], &[]);
    assert!(warning.starts_with("\u{1b}[1m\u{1b}[33mwarning:\u{1b}[0m "), "{warning:?}");
}

#[test]
fn help_has_colors_where_it_is_asked_to_and_manuals_have_none() {
    let place = Place::new();
    let help = |args: &[&str]| place.good(&[args, &["--help"]].concat()).stdout;
    assert!(!help(&["render"]).contains('\u{1b}') && help(&["--color", "always", "render"]).contains('\u{1b}'));
    for args in [&["man", "render"][..], &["completions", "bash"], &["info", "room.toml"]] {
        assert!(!place.good(&[args, &["--color", "always"]].concat()).stdout.contains('\u{1b}'), "{args:?}");
    }
}

/// What an argument contains is shown, not obeyed, in colour or not.
#[test]
fn arguments_do_not_color_messages() {
    let place = Place::new();
    for args in [&["info", "\u{1b}[32mnone.toml"][..], &["--sise\u{1b}[32m"], &["paint\u{1b}[32m"]] {
        let shown = stderr(&place, &[args, &["--color", "always"]].concat(), &[]);
        assert!(!shown.contains("\u{1b}[32m") && shown.contains(r"\u{1b}[32m"), "{shown:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn terminals_have_colors_unless_they_know_none() {
    let place = Place::new();
    let shown = |terminal: &str| {
        let mut command = place.command(&["info", "none.toml"]);
        command.env("TERM", terminal).env_remove("NO_COLOR").env_remove("CLICOLOR");
        place.on_terminal(command).1
    };
    assert!(shown("xterm").starts_with(RED) && shown("dumb").starts_with("error: "));
}

#[test]
fn a_run_without_a_terminal_shows_lines_and_no_control_characters() {
    let place = Place::new();
    for progress in ["auto", "bar", "none"] {
        let done = place.good(&["render", "room.toml", "-o", "a.png", "--size", "64x64", "--progress", progress]);
        assert!(done.stderr.chars().all(|c| c == '\n' || !c.is_control()), "{done:?}");
        assert!(!done.stderr.contains('%'), "{done:?}");
    }
}
