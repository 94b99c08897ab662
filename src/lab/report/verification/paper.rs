//! The paper's wheel: pressed, rolling straight, at 5 and at 45 degrees, against an independent program and other codes.

use crate::report::{Case, Claim};
use crate::rig::{
    Outcome, Reference, column, down, given, press, reference, references, rolling, simulate, wheel,
};
use hexroll::Result;
use hexroll::scene::*;

pub const STATIC: Case = Case {
    name: "paper_static",
    theorem: "the_papers_wheel_carries_its_force",
    title: "The paper's wheel, pressed by 2.2 mm",
    source: "the paper (300 N, its own code and Abaqus); an independent f64 explicit program; OpenRadioss; Q2 elements",
    setup: "39 / 17 mm, 17.5 mm wide, 44 x 4 x 5 = 880 elements, G 2.64 MPa, kappa 65.1 MPa, mu = 1 and 0",
    everyday: true,
    run: pressed,
};

pub const ROLLING: Case = Case {
    name: "paper_rolling",
    theorem: "the_papers_wheel_rolls_with_its_forces",
    title: "The paper's wheel, rolling at 70 rad/s and 2.59 m/s (2.69 m/s at 45 degrees)",
    source: "an independent f64 explicit program, means over the last 30 of 100 ms; OpenRadioss in brackets of the claim",
    setup: "as pressed; straight (elastic, viscous 20 Pa s), 5 degrees (viscous), mu = 1, and 45 degrees (viscous), mu = 0.5; equal corner masses",
    everyday: false,
    run: rolls,
};

pub const ORDER: Case = Case {
    name: "wheel_order",
    theorem: "the_wheels_force_converges",
    title: "The pressed wheel's force under refinement",
    source: "a static solver with graded quadratic hexahedra, finest of several meshes, without friction",
    setup: "mu = 0, q1p0: 44 x 4 x 5, 88 x 8 x 10, 132 x 12 x 15 elements",
    everyday: false,
    run: order,
};

fn force(elements: [usize; 3], element: Element, mu: f64) -> Result<f64> {
    let mut scene = wheel(elements, mu);
    scene.body.element = element;
    scene.stages = vec![press(down(given::DEPTH))];
    Ok(simulate(&scene)?.last().road_fz_N)
}

fn pressed() -> Result<Vec<Claim>> {
    let ug = Element::UniformGradient { hourglass: given::HOURGLASS };
    let mut claims = Vec::new();
    for (name, element, mu, program, others) in [
        (
            "q1p0, mu = 1",
            Element::Q1p0,
            1.0,
            "pressed-q1p0",
            &[
                ("the paper", "pressed-paper"),
                ("OpenRadioss with constant pressure", "pressed-openradioss-constant-pressure"),
            ][..],
        ),
        ("q1p0, mu = 0", Element::Q1p0, 0.0, "pressed-q1p0-frictionless", &[]),
        (
            "full, mu = 1",
            Element::Full,
            1.0,
            "pressed-full",
            &[("OpenRadioss, full integration", "pressed-openradioss-full")],
        ),
        ("uniform-gradient, mu = 1", ug, 1.0, "pressed-uniform-gradient", &[]),
        ("uniform-gradient, mu = 0", ug, 0.0, "pressed-uniform-gradient-frictionless", &[]),
    ] {
        let got = force(given::MESH, element, mu)?;
        for (who, run) in [&[("independent program", program)], others].concat() {
            claims.push(Claim::reference(format!("{name}: force, {who}"), got, road_fz(run)));
        }
    }
    Ok(claims)
}

fn road_fz(run: &str) -> &'static Reference {
    reference(&format!("{run}.road_fz"))
}

fn roll(eta: f64, mu: f64, velocity: [f64; 2]) -> Result<Outcome> {
    let mut scene = wheel(given::MESH, mu);
    scene.body.lumping = Lumping::Equal;
    scene.body.viscosity = (eta > 0.0).then_some(eta);
    scene.stages = vec![press(down(given::DEPTH)), rolling(velocity, given::SPIN, given::ROLLING)];
    simulate(&scene)
}

fn rolls() -> Result<Vec<Claim>> {
    let viscous = given::VISCOSITY;
    let mut claims = Vec::new();
    for (run, eta, mu, velocity) in [
        ("straight-viscous", viscous, 1.0, given::STRAIGHT),
        ("straight-elastic", 0.0, 1.0, given::STRAIGHT),
        ("slip5-viscous", viscous, 1.0, given::AT_5_DEGREES),
        ("slip45-viscous", viscous, 0.5, given::AT_45_DEGREES),
    ] {
        let outcome = roll(eta, mu, velocity)?;
        for (quantity, expected) in references::quantities(run) {
            if let Some(column) = column(quantity) {
                let got = outcome.mean("roll", 0.3, column);
                claims.push(Claim::reference(format!("{}: {quantity}", expected.what), got, expected));
            }
        }
        if run == "straight-elastic" {
            claims.push(ratio_of_forces(&outcome));
        }
    }
    Ok(claims)
}

/// OpenRadioss's forces in proportion to its own load.
fn ratio_of_forces(outcome: &Outcome) -> Claim {
    let [fx, fz] = ["road_fx", "road_fz"].map(|c| reference(&format!("straight-openradioss.{c}")));
    let got = outcome.mean("roll", 0.3, |s| s.road_fx_N) / outcome.mean("roll", 0.3, |s| s.road_fz_N);
    let expected = fx.value / fz.value;
    Claim::relative("straight, elastic: Fx / Fz, OpenRadioss", "", got, expected, 0.02, &fx.reason)
}

fn order() -> Result<Vec<Claim>> {
    let meshes = [1, 2, 3].map(given::refined);
    let mut f = Vec::new();
    for mesh in meshes {
        f.push(force(mesh, Element::Q1p0, 0.0)?);
    }
    // f = f0 + C h^p through three meshes of h = 1, 1/2, 1/3.
    let misfit = |p: f64| {
        let h = |n: f64| n.powf(-p);
        (f[0] - f[1]) / (f[1] - f[2]) - (h(1.0) - h(2.0)) / (h(2.0) - h(3.0))
    };
    let (mut low, mut high) = (0.3, 8.0);
    for _ in 0..100 {
        let p = 0.5 * (low + high);
        if misfit(p) * misfit(low) > 0.0 { low = p } else { high = p }
    }
    let p = 0.5 * (low + high);
    let limit = f[2] + (f[2] - f[1]) / ((3.0f64 / 2.0).powf(p) - 1.0);
    Ok(vec![
        Claim::reference(
            "force on 88 x 8 x 10, independent program",
            f[1],
            road_fz("pressed-q1p0-7040-frictionless"),
        ),
        Claim::reference(
            "force extrapolated, quadratic elements",
            limit,
            road_fz("pressed-quadratic-frictionless"),
        ),
        Claim::at_least("fitted order", "", p, 1.0, "at least first order, as contact allows"),
    ])
}
