//! Keys of implicit stages: read, defaulted, and refused with a reason.

use hexroll::scene::{Implicit, ImplicitScheme, ImplicitSolver, Linear, Method, Scene};

fn scene(sets: &[&str]) -> Result<Scene, String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lat100_static.toml");
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    Scene::load(path.as_ref(), &sets).map_err(|e| e.to_string())
}

fn method(sets: &[&str]) -> Method {
    scene(sets).unwrap().stages[0].method
}

#[test]
fn defaults_and_every_choice() {
    let default = Implicit {
        scheme: ImplicitScheme::Static { increments: 10 },
        tolerance: 1e-8,
        iterations: 25,
        solver: ImplicitSolver::ActiveSet(Linear::Auto),
    };
    assert_eq!(method(&[]), Method::Implicit(default));
    let relaxation = r#"stage.0.implicit={ scheme = "dynamic", step = "1 ms", damping = 0.1, solver = "relaxation", omega = 1.5, sweeps = 7, corrections = "multigrid" }"#;
    let expected = Implicit {
        scheme: ImplicitScheme::Dynamic { step: 1e-3, damping: 0.1 },
        solver: ImplicitSolver::Relaxation {
            omega: 1.5,
            tolerance: 1e-9,
            sweeps: 7,
            corrections: Some(Linear::Multigrid),
        },
        ..default
    };
    assert_eq!(method(&[relaxation]), Method::Implicit(expected));
    for (name, linear) in
        [("direct", Linear::Direct), ("multigrid", Linear::Multigrid), ("block-jacobi", Linear::BlockJacobi)]
    {
        let solver = ImplicitSolver::ActiveSet(linear);
        let set = format!("stage.0.implicit.linear={name}");
        assert_eq!(method(&[&set]), Method::Implicit(Implicit { solver, ..default }));
    }
}

#[test]
fn mistakes_are_explained() {
    for (set, said) in [
        ("stage.0.implicit.omega=1.5", "unknown key"),
        ("stage.0.implicit.step=1 ms", "unknown key"),
        ("stage.0.mass_damping=10 1/s", "nothing moves in statics"),
        ("stage.0.initial_velocity=zero", "nothing moves in statics"),
        ("stage.0.method=explicit", "this stage is not implicit"),
        ("stage.0.implicit={ scheme = \"dynamic\" }", "stage.0.implicit.step: missing"),
        ("stage.0.implicit={ scheme = \"dynamic\", step = \"1 s\" }", "longer than the stage"),
        ("stage.0.implicit={ scheme = \"static\", solver = \"relaxation\", omega = 2.0 }", "diverges"),
        ("stage.0.implicit.increments=0", "too few"),
    ] {
        let error = scene(&[set]).unwrap_err();
        assert!(error.contains(said), "{set}: {error}");
    }
}
