//! `[[output.history]]` and `hexroll spectrum`, from the scene to the tables.

use super::program::{BLOCK, Place};

fn scene(rest: &str) -> String {
    format!(
        "{}\n[[output.history]]\nname = \"base\"\nnodes = \"z-min\"\nrate = \"20 kHz\"\n{rest}",
        BLOCK.replace("0.6 ms", "20 ms")
    )
}

#[test]
fn a_scene_with_a_history_gets_its_spectra() {
    let place = Place::new();
    std::fs::write(place.path("block.toml"), scene("formats = [\"npz\", \"uff\"]")).unwrap();
    let done = place.hexroll(&["run", "block.toml", "--engine", "cpu"]).expect(0);
    assert!(done.stdout.contains("history_base.npz, history_base.uff"), "{}", done.stdout);
    let done = place.hexroll(&["spectrum", "runs/block", "--lines", "100"]).expect(0);
    for part in ["1000", "road_fz [dB]", "re 5e-8 m/s", "–: the band is narrower", "bands_base.csv"] {
        assert!(done.stdout.contains(part), "{part:?} is missing in {}", done.stdout);
    }
    let lines = std::fs::read_to_string(place.path("runs/block/spectrum_base.csv")).unwrap();
    let head = "frequency_Hz,road_fx_N2_per_Hz,road_fy_N2_per_Hz,road_fz_N2_per_Hz,velocity_m2_s2_per_Hz,coherence_fz_velocity";
    assert_eq!(lines.lines().next(), Some(head));
    assert_eq!(lines.lines().count(), 102, "0 to 10 kHz every 100 Hz");
    let bands = std::fs::read_to_string(place.path("runs/block/bands_base.csv")).unwrap();
    assert_eq!(bands.lines().count(), 19);
    assert!(image::open(place.path("runs/block/spectrum_base.png")).unwrap().width() > 1000);
    // A rerun takes them away with the run they are of.
    std::fs::write(place.path("block.toml"), BLOCK).unwrap();
    place.hexroll(&["run", "block.toml", "--engine", "cpu"]).expect(0);
    let done = place.hexroll(&["spectrum", "runs/block"]).expect(6);
    assert!(done.stderr.contains("no history_<name>.npz"), "{}", done.stderr);
    assert!(!place.path("runs/block/spectrum_base.csv").exists());
}

#[test]
fn a_history_that_cannot_be_is_answered_with_key_and_remedy() {
    let place = Place::new();
    for (change, key, says) in [
        ("rate = \"90 kHz\"", "output.history.0.rate", "between 1 and 50 kHz"),
        ("nodes = \"tread\"", "output.history.0.nodes", "no node set"),
        ("turning = false", "output.history.0.turning", "without a rim"),
        ("quantities = [\"noise\"]", "output.history.0.quantities.0", "not known"),
        ("stages = [\"roll\"]", "output.history.0.stages.0", "no stage"),
        ("name = \"a/b\"", "output.history.0.name", "no name of a file"),
        ("quantities = [\"pressure\"]\nturning = false", "output.history.0.quantities", "turning = true"),
    ] {
        let words: Vec<&str> = change.split(" = ").collect();
        let text = match words[0] {
            "rate" => scene("").replace("rate = \"20 kHz\"", change),
            "nodes" => scene("").replace("nodes = \"z-min\"", change),
            "name" => scene("").replace("name = \"base\"", change),
            _ => scene(change),
        };
        std::fs::write(place.path("block.toml"), text).unwrap();
        let done = place.hexroll(&["run", "block.toml", "--engine", "cpu"]).expect(2);
        assert!(done.stderr.contains(key) && done.stderr.contains(says), "{change}: {}", done.stderr);
    }
}
