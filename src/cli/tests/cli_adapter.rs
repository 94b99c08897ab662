//! The command line where it needs an adapter (a software one will do): pictures and the GPU engine.
//!
//! Without an adapter every trial is reported as ignored.

#[allow(dead_code)] // each of the two targets uses its own part
#[path = "cli/program.rs"]
mod program;

use hexroll::Precision;
use hexroll::output::read;
use libtest_mimic::{Arguments, Failed, Trial};
use program::Place;

type Check = fn();

const CHECKS: [(&str, Check); 6] = [
    ("a_run_draws_the_pictures_its_scene_asks_for", pictures_of_a_run),
    ("render_draws_other_views_from_the_folder_alone", pictures_again),
    ("an_animation_has_a_frame_a_snapshot_and_one_scale", animation),
    ("render_of_what_is_not_there_is_an_error", nothing_to_draw),
    ("the_gpu_engine_runs_a_scene_and_says_on_what", gpu_engine),
    ("an_ensemble_makes_the_runs_of_a_sweep_at_once", ensemble),
];

fn main() {
    let arguments = Arguments::from_args();
    let missing = hexroll::gpu::adapters().iter().all(|a| a.unusable.is_some());
    let trial = |(name, check): (&str, Check)| {
        let run = move || -> Result<(), Failed> {
            check();
            Ok(())
        };
        Trial::test(name, run).with_ignored_flag(missing)
    };
    libtest_mimic::run(&arguments, CHECKS.map(trial).into()).exit();
}

/// A run of the block with pictures.
fn run(place: &Place) {
    place.scene("block.toml", |text| text + "pictures = [\"body:von-mises\", \"footprint\"]\n");
    place.hexroll(&["run", "block.toml", "--engine", "cpu", "--out", "out"]).expect(0);
}

/// Width and height; panics unless it is a whole PNG with more than one colour.
fn size(place: &Place, name: &str) -> (u32, u32) {
    let picture = image::open(place.path(name)).unwrap_or_else(|e| panic!("{name}: {e}")).to_rgba8();
    let first = *picture.get_pixel(0, 0);
    assert!(picture.pixels().any(|p| *p != first), "{name} is empty");
    picture.dimensions()
}

fn pictures_of_a_run() {
    let place = Place::new();
    run(&place);
    for k in 0..2 {
        for name in ["body_von-mises", "footprint"] {
            assert_eq!(size(&place, &format!("out/{name}_{k}.png")), (1600, 900));
        }
    }
    assert_eq!(read::summary(&place.path("out")).unwrap().unwrap().warnings, Vec::<String>::new());
}

fn pictures_again() {
    let place = Place::new();
    run(&place);
    // The scene file is gone, and the run never finished: the folder has to do.
    std::fs::remove_file(place.path("block.toml")).unwrap();
    std::fs::remove_file(place.path("out/summary.json")).unwrap();
    let more =
        ["--view", "side", "--field", "pressure", "--field", "velocity", "--footprint", "--size", "640x360"];
    let done =
        place.hexroll(&[&["render", "out"], &more[..], &["--snapshot", "0", "--out", "figures"]].concat());
    let written = done.expect(0).stdout;
    for name in ["body_pressure_side_0", "body_velocity_side_0", "footprint_side_0"] {
        let path = format!("figures/{name}.png");
        assert_eq!(size(&place, &path), (640, 360));
        assert!(written.contains(&path), "{written}");
    }
    let all = place.hexroll(&["render", "out", "--snapshot", "all", "--field", "displacement"]).expect(0);
    assert_eq!(all.stdout.lines().count(), 2, "one a snapshot");
    let usual = place.hexroll(&["render", "out"]).expect(0).stdout;
    assert_eq!(
        usual, "out/body_von-mises_1.png\nout/footprint_1.png\n",
        "what the scene asks for, of the last one"
    );
}

fn animation() {
    let place = Place::new();
    run(&place);
    let arguments = ["--animate", "--fps", "5", "--size", "640x360", "--field", "velocity", "--footprint"];
    let written = place.hexroll(&[&["render", "out"], &arguments[..]].concat()).expect(0).stdout;
    assert_eq!(written, "out/body_velocity.png\nout/footprint.png\n");
    let bytes = std::fs::read(place.path("out/body_velocity.png")).unwrap();
    let decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
    let mut reader = decoder.read_info().unwrap();
    assert_eq!(reader.info().animation_control.unwrap().num_frames, 2);
    let mut frames = Vec::new();
    for _ in 0..2 {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        frames.push(pixels);
    }
    assert_ne!(frames[0], frames[1], "the block moves");
    // The colour bar, at the right, is the same in both: one scale.
    let bar = |pixels: &[u8]| -> Vec<u8> {
        pixels
            .chunks_exact(3 * 640)
            .skip(80)
            .take(200)
            .flat_map(|row| row[3 * 535..3 * 600].to_vec())
            .collect()
    };
    assert_eq!(bar(&frames[0]), bar(&frames[1]));
    place.hexroll(&["render", "out", "--animate", "--snapshot", "0"]).expect(2);
}

fn nothing_to_draw() {
    let place = Place::new();
    run(&place);
    let late = place.hexroll(&["render", "out", "--snapshot", "2"]).expect(6);
    assert!(late.stderr.contains("no snapshot 2"), "{}", late.stderr);
    let tiny = place.hexroll(&["render", "out", "--size", "8x8"]).expect(6);
    assert!(tiny.stderr.contains("8 x 8"), "{}", tiny.stderr);
}

/// The engines' own parity is tested elsewhere; this is the same scene on both, f32 against f64. A block that lands
/// shows where each node's last fraction of a step ended: the CPU engine's f32 is 7e-5 away from its f64 too. Another
/// material constant by 0.1 % would be 1e-3.
fn gpu_engine() {
    let place = Place::new();
    run(&place);
    place.hexroll(&["run", "block.toml", "--engine", "gpu", "--out", "gpu"]).expect(0);
    let summary = read::summary(&place.path("gpu")).unwrap().unwrap();
    assert_eq!((summary.engine.as_str(), summary.precision), ("gpu", Precision::F32));
    assert!(summary.adapter.is_some_and(|a| !a.is_empty()));
    let comparison = hexroll::output::compare::compare(&place.path("out"), &place.path("gpu")).unwrap();
    for snapshot in &comparison.snapshots {
        let displacement = snapshot.fields.iter().find(|f| f.name == "displacement").unwrap();
        assert!(displacement.relative_l2.unwrap() < 3e-4, "{displacement:?}");
    }
}

/// Runs that take their steps together, each in its folder with its own time steps; one that goes wrong does not keep
/// the others from finishing, and finished ones are kept. Displacements as above.
fn ensemble() {
    let place = Place::new();
    place.scene("block.toml", |text| text);
    let sweep = |more: &[&str]| {
        let over = ["--over", "friction.coefficient=0.2,0.4", "--over", "dt-safety=0.3,0.9"];
        place.hexroll(&[&["sweep", "block.toml"], &over[..], more].concat())
    };
    sweep(&["--engine", "cpu", "--out", "cpu"]).expect(0);
    sweep(&["--ensemble", "--out", "gpu"]).expect(0);
    let mut steps = Vec::new();
    for mu in ["0.2", "0.4"] {
        for safety in ["0.3", "0.9"] {
            let run = format!("friction.coefficient_{mu}_dt-safety_{safety}");
            let summary = read::summary(&place.path(&format!("gpu/{run}"))).unwrap().unwrap();
            assert_eq!((summary.engine.as_str(), summary.precision), ("gpu", Precision::F32));
            assert!(summary.engine_reason.contains("4 runs"), "{}", summary.engine_reason);
            steps.push(summary.steps);
            let folders = ["cpu", "gpu"].map(|out| place.path(&format!("{out}/{run}")));
            let comparison = hexroll::output::compare::compare(&folders[0], &folders[1]).unwrap();
            for snapshot in &comparison.snapshots {
                let displacement = snapshot.fields.iter().find(|f| f.name == "displacement").unwrap();
                assert!(displacement.relative_l2.unwrap() < 3e-4, "{run}: {displacement:?}");
            }
        }
    }
    assert!(steps[0] > steps[1], "{steps:?}");
    assert_eq!(sweep(&["--ensemble", "--out", "gpu"]).expect(0).stderr.matches("kept").count(), 4);
    // The critical step exceeded by half.
    let scene = program::shipped("bouncing_block.toml");
    let over = ["--over", "dt-safety=1.5,0.9", "--ensemble"];
    let done = place.hexroll(&[&["sweep", &scene], &over[..]].concat()).expect(5);
    assert!(done.stderr.contains("[1/2] dt-safety 1.5: failed"), "{}", done.stderr);
    assert!(done.stderr.contains("[2/2] dt-safety 0.9: done"), "{}", done.stderr);
    for conflict in
        [["--engine", "cpu"], ["--precision", "f64"], ["--jobs", "2"], ["--over", "precision=f64,f32"]]
    {
        sweep(&[&["--ensemble"], &conflict[..]].concat()).expect(2);
    }
    let finer = ["--set", "body.mesh.elements=[20, 20, 20]", "--over", "dt-safety=0.8,0.9", "--ensemble"];
    let large = place.hexroll(&[&["sweep", &scene], &finer[..]].concat()).expect(3);
    assert!(large.stderr.contains("one by one"), "{}", large.stderr);
}
