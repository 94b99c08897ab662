//! What a run warns of, and what it does not: no alarm without a cause, none with the wrong one.

use hexroll::output::read;
use hexroll::output::{Summary, Verdict};

use super::program::{Place, shipped};

/// A block that nothing acts on; `more`: tables between the material and the stage.
fn at_rest(method: &str, more: &str) -> String {
    format!(
        r#"title = "Nothing happens"
[body]
density = "1100 kg/m3"
[body.mesh]
generator = "block"
size = ["40 mm", "40 mm", "20 mm"]
elements = [4, 4, 4]
[body.material]
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
viscosity = "20 Pa s"
{more}
[[stage]]
{method}
duration = "20 ms"
[output]
sample = "1 ms"
"#
    )
}

/// A flat block of 2.2 N that is pulled along a rough road with 0.98 of what holds it.
const ALMOST_SLIDING: &str = r#"title = "A block almost slides"
gravity = ["4.8 m/s2", "0 m/s2", "-9.81 m/s2"]
[body]
density = "1100 kg/m3"
[body.mesh]
generator = "block"
size = ["100 mm", "100 mm", "20 mm"]
elements = [8, 8, 2]
[body.material]
shear_modulus = "26 MPa"
bulk_modulus = "65.1 MPa"
viscosity = "75 Pa s"
[road]
[friction]
coefficient = 0.5
[[stage]]
name = "settle"
method = "explicit"
duration = "20 ms"
mass_damping = "3000 1/s"
[[stage]]
name = "hold"
method = "explicit"
duration = "200 ms"
[output]
sample = "5 ms"
"#;

fn summary(scene: &str, precision: &str, more: &[&str]) -> (Summary, String) {
    let place = Place::new();
    let scene = if scene.contains('\n') {
        std::fs::write(place.path("scene.toml"), scene).unwrap();
        "scene.toml"
    } else {
        scene
    };
    let args = ["run", scene, "--engine", "cpu", "--precision", precision, "--out", "out"];
    let quiet = ["--set", "output.pictures=[]", "--set", "output.snapshots=stage-ends"];
    let done = place.hexroll(&[&args[..], &quiet[..], more].concat()).expect(0);
    (read::summary(&place.path("out")).unwrap().unwrap(), done.stdout)
}

/// Energies of 1e-14 J (f64) and 1e-8 J (f32) differ by all of themselves, forces are round-off too: no share of them is a
/// warning, and a relaxed stage is at rest.
#[test]
fn a_body_at_rest_gives_no_alarm() {
    let road = "[road]\n[friction]\ncoefficient = 0.5";
    let explicit = r#"method = "explicit""#;
    let relaxed = "method = \"quasi-static\"\nmass_damping = \"3000 1/s\"";
    for precision in ["f64", "f32"] {
        for (method, more) in [(explicit, ""), (explicit, road), (relaxed, ""), (relaxed, road)] {
            let (summary, table) = summary(&at_rest(method, more), precision, &[]);
            assert_eq!(summary.warnings, Vec::<String>::new(), "{precision} {method} {more}");
            let balance = summary.stored_balance;
            assert!(balance.worst_error_J <= summary.round_off_J, "{precision}: {balance:?}");
            // A bound that says something: not a thousand times what is there.
            assert!(
                summary.round_off_J < 1e3 * balance.worst_error_J,
                "{precision}: {}",
                summary.round_off_J
            );
            assert!(table.contains("which is round-off"), "{table}");
        }
    }
}

#[test]
fn a_block_that_slides_smoothly_gives_no_alarm() {
    for precision in ["f64", "f32"] {
        let (summary, _) = summary(&shipped("block_on_slope.toml"), precision, &[]);
        assert_eq!(summary.warnings, Vec::<String>::new(), "{precision}");
        for stage in &summary.stages {
            // A tenth of the limit, and half of it in single precision, in which nodes are rounded off the road.
            let most = if precision == "f64" { 0.005 } else { 0.025 };
            let contact = stage.contact.as_ref().unwrap();
            assert!(contact.remaining_share < most, "{precision}: {contact:?}");
        }
    }
}

/// With half the viscosity the same block does chatter: 10 % of its nodes leave the road and come back in a step. Its mean
/// force is the load all the same, since all of them slide; the area is not that of a base that touches.
#[test]
fn a_sliding_block_that_chatters_is_named_with_what_is_wrong() {
    let little = ["--set", "body.material.viscosity=75 Pa s"];
    let (summary, _) = summary(&shipped("block_on_slope.toml"), "f64", &little);
    let slide = summary.stages.last().unwrap();
    let contact = slide.contact.as_ref().unwrap();
    assert_eq!((contact.verdict, contact.sticking_share), (Verdict::Chattering, Some(0.0)));
    // 1100 kg/m3 of half a litre; a bouncing block's mean over 30 ms is its load within what it bounces.
    let load = 1100.0 * 5e-4 * 8.495709211125343;
    assert!((slide.mean_road_fz_N / load - 1.0).abs() < 0.01, "{}", slide.mean_road_fz_N);
    // Coulomb's law; what slides aside by the way takes its part of it.
    assert!((slide.mean_road_fx_N / slide.mean_road_fz_N + 0.4).abs() < 1e-4);
    assert!(slide.mean_contact_area_m2 < 0.95e-2, "{}", slide.mean_contact_area_m2);
    let [warning] = &summary.warnings[..] else { panic!("{:?}", summary.warnings) };
    assert!(warning.contains("\"slide\" is chattering") && warning.contains("contact area"), "{warning}");
    assert!(warning.contains("the mean force is") && !warning.contains("its means"), "{warning}");
}

/// The block's weight strains it by 1e-6, of which single precision rounds the most away: neither step nor viscosity are
/// the cause of what it does, and double precision has none of it.
#[test]
fn rounding_is_named_where_it_is_the_cause() {
    let (double, _) = summary(ALMOST_SLIDING, "f64", &[]);
    assert_eq!(double.warnings, Vec::<String>::new());
    let (single, table) = summary(ALMOST_SLIDING, "f32", &[]);
    assert!(!single.warnings.is_empty(), "{table}");
    for warning in &single.warnings {
        assert!(warning.contains("rounding") && warning.contains("f64"), "{warning}");
        assert!(!warning.contains("viscosity") && !warning.contains("safety"), "{warning}");
    }
}
