//! `--set key=value` reaches every value, and its mistakes are answered like those of the file.

use hexroll::Error;
use hexroll::scene::{Drive, MeshSpec, Snapshots};

use crate::good;

#[test]
fn an_override_replaces_adds_and_goes_into_arrays() {
    let z = good(&["stage.0.rim.z.displacement=\"-3 mm\""]).unwrap().stages[0].rim.z;
    assert!(matches!(z, Drive::Displacement { to, .. } if (to + 0.003).abs() < 1e-18), "{z:?}");
    let MeshSpec::Ring { elements, .. } = good(&["body.mesh.elements=[88,8,10]"]).unwrap().body.mesh else {
        panic!("a ring")
    };
    assert_eq!(elements, [88, 8, 10]);
    let MeshSpec::Ring { elements, .. } = good(&["body.mesh.elements.2=7"]).unwrap().body.mesh else {
        panic!("a ring")
    };
    assert_eq!(elements, [12, 2, 7]);
    // What the file does not have is added, with the tables on the way.
    let damped = good(&["stage.1.rim.camber.angle=2 deg", "stage.1.rim.camber.ramp=1 ms"]).unwrap();
    assert!(matches!(damped.stages[1].rim.camber, Drive::Displacement { ramp: 0.001, .. }));
    assert_eq!(
        good(&["body.velocity=[\"1 m/s\", \"2 m/s\", \"3 m/s\"]"]).unwrap().body.velocity,
        [1.0, 2.0, 3.0]
    );
}

#[test]
fn what_is_not_toml_is_a_string() {
    for text in
        ["output.snapshots=stage-ends", "output.snapshots = \"stage-ends\"", "output.snapshots='stage-ends'"]
    {
        assert_eq!(good(&[text]).unwrap().output.snapshots, Snapshots::StageEnds);
    }
    assert_eq!(good(&["title=one = two"]).unwrap().title, "one = two");
    // Neither a line break nor a comment smuggles in a second key.
    assert_eq!(good(&["title=\"a\"\nsafety = 3"]).unwrap().title, "\"a\"\nsafety = 3");
}

#[test]
fn later_overrides_win() {
    assert_eq!(good(&["time_step.safety=0.5", "time_step.safety=0.7"]).unwrap().safety, 0.7);
}

#[test]
fn mistakes_of_overrides_name_key_and_remedy() {
    for (set, key, problem, remedy) in [
        ("body.densty=1 kg/m3", "body.densty", "unknown key (from --set)", "did you mean density?"),
        ("nonsense.deep.key=1", "nonsense", "unknown key (from --set)", "known here: title"),
        ("stage.0.rim.w.velocity=1 m/s", "stage.0.rim.w", "unknown key (from --set)", "x, y, z"),
        ("body.density=-1 kg/m3", "body.density", "is not positive (from --set)", "greater than zero"),
        ("body.density=7", "body.density", "the number 7 has no unit (from --set)", "kg/m3"),
        ("body.mesh.elements=[1,1,1]", "body.mesh.elements.0", "1 is too few (from --set)", "at least 3"),
        (
            "stage.2.duration=1 s",
            "stage.2",
            "\"2\" is not an index into an array of 2",
            "by its index from 0",
        ),
        ("stage.press.duration=1 s", "stage.press", "\"press\" is not an index", "by its index from 0"),
        ("body.density.value=1", "body.density.value", "a string has no keys", "name a key of a table"),
        ("body..density=1", "body..density", "an empty key", "single dots"),
        ("body.density", "body.density", "no `=`", "--set key=value"),
    ] {
        let Err(Error::Scene { file, line, key: k, problem: p, remedy: r }) = good(&[set]) else {
            panic!("{set} was not refused as a scene error");
        };
        assert_eq!((file.as_str(), line, k.as_str()), ("good.toml", None, key), "{set}");
        assert!(p.contains(problem) && p.contains("--set"), "{set}: {p}");
        assert!(r.contains(remedy), "{set}: {r}");
    }
}
