//! Materials of decks, as lines of a scene.

use hexroll::model::mesh::import::materials;
use hexroll::scene::{Law, LengthUnit, Scene};

use crate::rig::{cube, metres};

fn lines(behind: &str, unit: &str, metres_of: f64) -> Vec<String> {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("a.inp");
    std::fs::write(&path, cube(behind)).unwrap();
    let mut file = metres(&path);
    file.unit = LengthUnit { name: unit.into(), metres: metres_of };
    materials(&file).unwrap()
}

/// A scene with those lines.
fn scene(lines: &[String]) -> Scene {
    let (density, rest): (Vec<&String>, Vec<&String>) = lines.iter().partition(|l| l.starts_with("density"));
    let join = |lines: Vec<&String>| lines.into_iter().cloned().collect::<Vec<_>>().join("\n");
    let text = format!(
        "title = \"t\"\n[body]\n{}\n[body.mesh]\nfile = \"a.inp\"\nunit = \"mm\"\n[body.material]\n{}\n[[stage]]\nmethod = \"explicit\"\n\
         duration = \"1 ms\"\n[output]\nsample = \"1 ms\"\n",
        join(density),
        join(rest)
    );
    Scene::parse(&text, "scene.toml", &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// In mm, tonnes and seconds: C10 = 0.66 MPa, C01 = 0.33 MPa, D1 = 0.02 /MPa. Then G = 2 (C10 + C01) and kappa = 2 / D1.
#[test]
fn mooney_and_rivlin_in_millimetres() {
    let deck = "*MATERIAL, NAME=TREAD\n*DENSITY\n1.1E-9,\n*HYPERELASTIC, MOONEY-RIVLIN\n0.66, 0.33, 0.02\n";
    let scene = scene(&lines(deck, "mm", 1e-3));
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} for {b}");
    near(scene.body.density, 1100.0);
    near(scene.body.law.shear_modulus(), 1.98e6);
    near(scene.body.law.bulk_modulus(), 100e6);
    let Law::MooneyRivlin(law) = scene.body.law else { panic!("{:?}", scene.body.law) };
    near(law.g1, 1.32e6);
    near(law.g2, 0.66e6);
}

/// In SI units; the default of a card with N=1 alone is Mooney and Rivlin's; Neo-Hooke's has two constants; Yeoh's six.
#[test]
fn laws_of_every_kind() {
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} for {b}");
    let of = |card: &str, constants: &str| {
        let deck = format!("*DENSITY\n1200.\n*HYPERELASTIC{card}\n{constants}\n");
        scene(&lines(&deck, "m", 1.0)).body.law
    };
    for card in [", NEO HOOKE", ", neo hooke", ", REDUCED POLYNOMIAL, N=1"] {
        let law = of(card, "1.32E6, 2.E-8");
        near(law.shear_modulus(), 2.64e6);
        near(law.bulk_modulus(), 1e8);
    }
    for card in [", N=1", "", ", POLYNOMIAL, N=1"] {
        near(of(card, "0.66E6, 0.33E6, 2.E-8").shear_modulus(), 1.98e6);
    }
    let Law::Yeoh(yeoh) = of(", YEOH", "1.E6, -1.E5, 2.E4, 2.E-8, 0., 0.") else { panic!() };
    near(yeoh.c10, 1e6);
    near(yeoh.c20, -1e5);
    near(yeoh.c30, 2e4);
}

/// Without D1 nobody knows the bulk modulus: the line says what Abaqus/Explicit would take.
#[test]
fn a_missing_compressibility_is_said() {
    let deck = "*MATERIAL, NAME=A\n*DENSITY\n1.1e-9\n*HYPERELASTIC, NEO HOOKE\n1.0\n";
    let lines = lines(deck, "mm", 1e-3);
    let bulk = lines.iter().find(|l| l.starts_with("bulk_modulus")).unwrap();
    assert!(bulk.contains("D1 is missing") && bulk.contains("kappa/G = 20"), "{bulk}");
    assert!((scene(&lines).body.law.bulk_modulus() / 40e6 - 1.0).abs() < 1e-12);
}

#[test]
fn what_has_no_place_here_is_said() {
    for card in ["OGDEN, N=2", "ARRUDA-BOYCE", "N=2", "TEST DATA INPUT"] {
        let lines = lines(&format!("*MATERIAL, NAME=A\n*HYPERELASTIC, {card}\n1., 2., 3.\n"), "mm", 1e-3);
        assert!(lines.iter().any(|l| l.starts_with("# line 13: *HYPERELASTIC")), "{card}: {lines:?}");
    }
    let lines = lines("*DENSITY\n1.\n", "in", 0.0254);
    assert!(lines[1].contains("cannot be told"), "{lines:?}");
}
