//! The paper's wheel: pressed, rolling straight, at 5 and at 45 degrees, against an independent program and other codes.

use crate::Result;
use crate::report::bench::{HELD, Outcome, explicit, press, simulate, wheel};
use crate::report::{Case, Claim};
use crate::scene::*;

pub const STATIC: Case = Case {
    name: "paper_static",
    title: "The paper's wheel, pressed by 2.2 mm",
    source: "the paper (300 N, its own code and Abaqus); an independent f64 explicit program; OpenRadioss; Q2 elements",
    setup: "39 / 17 mm, 17.5 mm wide, 44 x 4 x 5 = 880 elements, G 2.64 MPa, kappa 65.1 MPa, mu = 1 and 0",
    everyday: true,
    run: pressed,
};

pub const ROLLING: Case = Case {
    name: "paper_rolling",
    title: "The paper's wheel, rolling at 70 rad/s and 2.59 m/s (2.69 m/s at 45 degrees)",
    source: "an independent f64 explicit program, means over the last 30 of 100 ms; OpenRadioss in brackets of the claim",
    setup: "as pressed; straight (elastic, viscous 20 Pa s), 5 degrees (viscous), mu = 1, and 45 degrees (viscous), mu = 0.5; equal corner masses",
    everyday: false,
    run: rolling,
};

pub const ORDER: Case = Case {
    name: "wheel_order",
    title: "The pressed wheel's force under refinement",
    source: "a static solver with graded quadratic hexahedra: 299.5 N (meshes 299.5 to 300.0) without friction",
    setup: "mu = 0, q1p0: 44 x 4 x 5, 88 x 8 x 10, 132 x 12 x 15 elements",
    everyday: false,
    run: order,
};

const DEPTH: f64 = 2.2e-3;
const DOWN: Drive = Drive::Displacement { to: -DEPTH, ramp: 0.02 };

fn force(elements: [usize; 3], element: Element, mu: f64) -> Result<f64> {
    let mut scene = wheel(elements, mu);
    scene.body.element = element;
    scene.stages = vec![press(DOWN)];
    Ok(simulate(&scene)?.last().road_fz_N)
}

fn pressed() -> Result<Vec<Claim>> {
    const REASON: &str = "two programs: settling, masses, windows";
    let ug = Element::UniformGradient { hourglass: 0.15 };
    let mut claims = Vec::new();
    for (name, element, mu, expected) in [
        ("q1p0, mu = 1", Element::Q1p0, 1.0, 300.3),
        ("q1p0, mu = 0", Element::Q1p0, 0.0, 283.9),
        ("full, mu = 1", Element::Full, 1.0, 379.4),
        ("uniform-gradient, mu = 1", ug, 1.0, 299.9),
        ("uniform-gradient, mu = 0", ug, 0.0, 282.5),
    ] {
        let got = force([44, 4, 5], element, mu)?;
        claims.push(Claim::relative(
            format!("{name}: force, independent program"),
            "N",
            got,
            expected,
            0.01,
            REASON,
        ));
        if name == "q1p0, mu = 1" {
            claims.push(Claim::relative(
                "q1p0, mu = 1: force, the paper",
                "N",
                got,
                300.0,
                0.01,
                "its last digit",
            ));
            claims.push(Claim::relative(
                "q1p0, mu = 1: force, OpenRadioss with constant pressure",
                "N",
                got,
                305.4,
                0.03,
                "another element: reduced pressure, but not the mean dilatation",
            ));
        }
        if name == "full, mu = 1" {
            claims.push(Claim::relative(
                "full, mu = 1: force, OpenRadioss, full integration",
                "N",
                got,
                378.8,
                0.01,
                "the same element in another code",
            ));
        }
    }
    Ok(claims)
}

fn roll(eta: f64, mu: f64, velocity: [f64; 2]) -> Result<Outcome> {
    let mut scene = wheel([44, 4, 5], mu);
    scene.body.lumping = Lumping::Equal;
    scene.body.viscosity = (eta > 0.0).then_some(eta);
    let at = |to: f64| Drive::Velocity { to, ramp: 0.0 };
    let rim = RimMotion { x: at(velocity[0]), y: at(velocity[1]), spin: at(70.0), ..HELD };
    let roll = Stage { initial_velocity: Some(InitialVelocity::Rim), rim, ..explicit("roll", 0.1) };
    scene.stages = vec![press(DOWN), roll];
    simulate(&scene)
}

/// Column of a sample.
type Column = fn(&crate::record::Sample) -> f64;

fn rolling() -> Result<Vec<Claim>> {
    const REASON: &str = "two programs; an undamped contact chatters, and moments have small arms";
    let mut claims = Vec::new();
    let fx: Column = |s| s.road_fx_N;
    let fy: Column = |s| s.road_fy_N;
    let fz: Column = |s| s.road_fz_N;
    let my: Column = |s| s.rim_my_Nm;
    let mz: Column = |s| s.rim_mz_Nm;
    for (name, eta, mu, velocity, expected) in [
        (
            "straight, 20 Pa s",
            20.0,
            1.0,
            [2.59, 0.0],
            &[("Fx", fx, 120.1), ("Fz", fz, 306.3), ("My", my, 4.67)][..],
        ),
        (
            "straight, elastic",
            0.0,
            1.0,
            [2.59, 0.0],
            &[("Fx", fx, 119.6), ("Fz", fz, 306.2), ("My", my, 4.64)],
        ),
        (
            "5 degrees, 20 Pa s",
            20.0,
            1.0,
            [2.5801, 0.2257],
            &[("Fx", fx, 96.4), ("Fy", fy, -103.4), ("Fz", fz, 318.6), ("My", my, 3.66), ("Mz", mz, -0.226)],
        ),
        (
            "45 degrees, 20 Pa s",
            20.0,
            0.5,
            [1.9, 1.9],
            &[("Fx", fx, 64.9), ("Fy", fy, -159.7), ("Fz", fz, 345.5), ("My", my, 2.66)],
        ),
    ] {
        let outcome = roll(eta, mu, velocity)?;
        for &(quantity, column, value) in expected {
            let got = outcome.mean("roll", 0.3, column);
            let tolerance = if quantity == "Mz" {
                0.03
            } else if eta == 0.0 {
                0.02
            } else {
                0.01
            };
            let unit = if quantity.starts_with('M') { "N m" } else { "N" };
            claims.push(Claim::relative(format!("{name}: {quantity}"), unit, got, value, tolerance, REASON));
        }
        if eta == 0.0 {
            // OpenRadioss, Isolid 17 with constant pressure: forces in proportion to its own static force.
            let ratio = outcome.mean("roll", 0.3, fx) / outcome.mean("roll", 0.3, fz);
            claims.push(Claim::relative(
                "straight, elastic: Fx / Fz, OpenRadioss",
                "",
                ratio,
                122.7 / 312.1,
                0.02,
                "its contact and start-up differ: ratios to its own load agree",
            ));
        }
    }
    Ok(claims)
}

fn order() -> Result<Vec<Claim>> {
    let meshes = [[44, 4, 5], [88, 8, 10], [132, 12, 15]];
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
        Claim::relative("force on 88 x 8 x 10, independent program", "N", f[1], 299.5, 0.01, "two programs"),
        Claim::relative(
            "force extrapolated, quadratic elements",
            "N",
            limit,
            299.5,
            0.01,
            "a contact line that moves in whole elements: the fitted order is no more than an estimate",
        ),
        Claim::at_least("fitted order", "", p, 1.0, "at least first order, as contact allows"),
    ])
}
