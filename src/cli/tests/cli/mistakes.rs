//! Wrong input: one error that says where and what, and the exit code that says whose fault it is.

use super::program::{Done, Place};

/// One error, with these words in it.
#[track_caller]
fn one_error(done: &Done, parts: &[&str]) {
    let errors = done.stderr.lines().filter(|l| l.starts_with("error:")).count();
    assert_eq!(errors, 1, "{}", done.stderr);
    for part in parts {
        assert!(done.stderr.contains(part), "{part:?} is missing in\n{}", done.stderr);
    }
    assert_eq!(done.stdout, "", "a failure has no result");
}

#[test]
fn a_wrong_value_names_file_line_and_key() {
    let place = Place::new();
    place.scene("bad.toml", |text| text.replace("\"1100 kg/m3\"", "\"1100 kg\""));
    for command in ["run", "check"] {
        let done = place.hexroll(&[command, "bad.toml"]).expect(2);
        one_error(&done, &["bad.toml:5", "body.density", "kg/m3"]);
    }
    assert!(!place.path("runs").exists(), "nothing is written for a scene that cannot be used");
}

#[test]
fn an_unknown_key_of_set_is_an_error_too() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let done = place.hexroll(&["check", "block.toml", "--set", "body.densty=3"]).expect(2);
    one_error(&done, &["block.toml", "body.densty", "density"]);
}

#[test]
fn a_feature_of_a_later_version_exits_3() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let done = place.hexroll(&["check", "block.toml", "--set", "road.shape=sphere"]).expect(3);
    one_error(&done, &["block.toml", "road.shape", "sphere"]);
    let done = place.hexroll(&["check", "block.toml", "--set", "sweep.a=1"]).expect(3);
    one_error(&done, &["sweep"]);
}

#[test]
fn a_precision_that_the_engine_does_not_have_exits_3() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let done = place.hexroll(&["run", "block.toml", "--engine", "cpu", "--precision", "f32+"]).expect(3);
    one_error(&done, &["f32+", "--engine"]);
    assert!(!place.path("runs").exists());
}

#[test]
fn an_adapter_that_is_not_there_exits_4() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    for engine in ["gpu", "auto"] {
        let arguments = ["run", "block.toml", "--engine", engine, "--adapter", "no such adapter"];
        let done = place.hexroll(&arguments).expect(4);
        one_error(&done, &["no GPU adapter found"]);
    }
}

#[test]
fn wrong_arguments_exit_2() {
    let place = Place::new();
    for arguments in [
        &["run"][..],
        &["run", "a.toml", "--engine", "tpu"],
        &["run", "a.toml", "--engine", "cpu", "--adapter", "x"],
        &["render", "a", "--size", "big"],
        &["render", "a", "--snapshot", "first"],
        &["render", "a", "--view", "above"],
        &["roll"],
    ] {
        one_error(&place.hexroll(arguments).expect(2), &[]);
    }
}

#[test]
fn missing_files_exit_6_with_the_cause() {
    let place = Place::new();
    for arguments in [
        &["run", "none.toml"][..],
        &["check", "none.toml"],
        &["render", "none"],
        &["compare", "none", "none"],
    ] {
        let done = place.hexroll(arguments).expect(6);
        one_error(&done, &["none", "caused by: "]);
    }
}

#[test]
fn help_has_examples_and_the_exit_codes() {
    let place = Place::new();
    let help = place.hexroll(&["--help"]).expect(0).stdout;
    for code in ["0 ", "2 ", "3 ", "4 ", "5 ", "6 ", "130 "] {
        assert!(help.lines().any(|l| l.trim_start().starts_with(code)), "{code} is missing in\n{help}");
    }
    for command in ["run", "check", "render", "compare", "bench"] {
        let help = place.hexroll(&[command, "--help"]).expect(0).stdout;
        assert!(help.contains(&format!("  hexroll {command} ")), "no example in\n{help}");
    }
}

/// A degree sign in Latin-1: every command that reads a scene names file, line and byte.
#[test]
fn a_scene_that_is_not_utf8_is_answered_with_its_place() {
    let place = Place::new();
    let scene = place.scene("latin.toml", |text| text);
    let mut bytes = std::fs::read(&scene).unwrap();
    // The second line, after "# ".
    let at = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
    bytes.splice(at..at, *b"# \xb0\n");
    std::fs::write(&scene, bytes).unwrap();
    for command in
        [&["run", "latin.toml"][..], &["check", "latin.toml"], &["study", "latin.toml", "--refine", "1,2"]]
    {
        let done = place.hexroll(command).expect(2);
        let place = "error: latin.toml:2: byte 3: 0xB0 is not UTF-8; save";
        assert!(done.stderr.contains(place), "{}", done.stderr);
    }
}
