//! `hexroll new`, `completions`, `man`: what someone meets first.

use super::program::Place;

#[test]
fn a_new_scene_is_commented_and_can_be_run() {
    let place = Place::new();
    for (kind, elements) in [("wheel", "880 elements"), ("block", "256 elements"), ("sweep", "528 elements")]
    {
        let done = place.hexroll(&["new", kind]).expect(0);
        assert!(
            done.stdout
                .contains(&format!("hexroll {} {kind}.toml", if kind == "sweep" { "sweep" } else { "run" }))
        );
        let text = std::fs::read_to_string(place.path(&format!("{kind}.toml"))).unwrap();
        assert!(text.lines().filter(|l| l.contains('#')).count() > 15, "commented");
        let done = place.hexroll(&["check", &format!("{kind}.toml")]).expect(0);
        assert!(done.stdout.contains(elements), "{}", done.stdout);
        assert!(!done.stdout.contains("warning"), "{}", done.stdout);
    }
    // A file that is there is left alone.
    std::fs::write(place.path("block.toml"), "mine").unwrap();
    let done = place.hexroll(&["new", "block"]).expect(6);
    assert!(done.stderr.contains("block.toml") && done.stderr.contains("left alone"), "{}", done.stderr);
    assert_eq!(std::fs::read_to_string(place.path("block.toml")).unwrap(), "mine");
    // Under another name its commands name that.
    place.hexroll(&["new", "block", "other.toml"]).expect(0);
    let text = std::fs::read_to_string(place.path("other.toml")).unwrap();
    assert!(
        text.contains("hexroll run other.toml") && text.contains("hexroll report run runs/other"),
        "{text}"
    );
    let small = [
        "run",
        "other.toml",
        "--engine",
        "cpu",
        "--set",
        "body.mesh.elements=[2, 2, 1]",
        "--set",
        "output.pictures=[]",
    ];
    place.hexroll(&small).expect(0);
    assert!(place.path("runs/other/summary.json").exists());
}

#[test]
fn shells_and_man_learn_every_command() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = place.hexroll(&["completions", shell]).expect(0);
        for command in ["sweep", "spectrum", "--animate"] {
            // Bare words of long options differ from shell to shell.
            assert!(done.stdout.contains(command.trim_start_matches('-')), "{shell}: {command}");
        }
    }
    let page = place.hexroll(&["man"]).expect(0).stdout;
    assert!(page.starts_with(".ie") && page.contains("hexroll\\-run"), "{page}");
    place.hexroll(&["man", "--out", "man1"]).expect(0);
    for name in ["hexroll.1", "hexroll-run.1", "hexroll-report-study.1"] {
        assert!(place.path("man1").join(name).exists(), "{name}");
    }
}
