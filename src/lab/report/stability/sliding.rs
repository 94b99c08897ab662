//! Where the stored-energy error of wheels that slide comes from.
//!
//! A locked wheel chatters: its tread folds and springs back some thousand times a second. Stored energy and internal work
//! differ by the error of the trapezoidal rule that the scheme's work is, -(1/12) (dx . grad)^3 W a step: of third order in
//! the step, and odd in the velocity, so that it cancels over a motion that comes back the way it went. A chattering tread does
//! not, and the error grows with the way slid. It is the step's all the same: it falls to a quarter when the step is halved,
//! while the balance of works closes to round-off.

use super::limits::{free_spin, sliding};
use crate::report::{Case, Claim};
use crate::rig::{order, simulate_with};
use hexroll::Result;
use hexroll::cpu::Precision;
use hexroll::scene::Scene;

pub const CASE: Case = Case {
    name: "sliding_energy",
    theorem: "sliding_wheels_have_the_steps_energy_error",
    title: "Stored-energy error of a locked and of a spun wheel",
    source: "central differences: second order in the step; work and impulse of every force are booked",
    setup: "24 x 3 x 3 wheel, 20 Pa s, mu = 1, pressed, then dragged for 20 ms with omega = 0, or spun at three times the free \
            spin; safety 0.9, 0.45, 0.225",
    everyday: true,
    run,
};

fn run() -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for (name, omega) in [("locked", 0.0), ("spun", 3.0 * free_spin())] {
        let (scene, model) = sliding(omega)?;
        let mut errors = Vec::new();
        for safety in [0.9, 0.45, 0.225] {
            let outcome =
                simulate_with(&Scene { safety, ..scene.clone() }, model.clone(), Precision::F64, 1)?;
            let ledger = &outcome.totals.ledger;
            errors.push(ledger.worst_stored_balance);
            claims.push(Claim::at_most(
                format!("{name}, safety {safety}: error of the work balance over its largest term"),
                "",
                ledger.worst_balance / ledger.largest_term,
                1e-12,
                "round-off: no force goes unbooked, friction included",
            ));
        }
        claims.push(Claim::absolute(
            format!("{name}: order of the stored-energy error, safety 0.9 to 0.45"),
            "",
            order(errors[0], errors[1]),
            2.0,
            0.5,
            "second order; at 0.9 the highest modes are close to the limit, and the chatter is another one",
        ));
        claims.push(Claim::absolute(
            format!("{name}: order of the stored-energy error, safety 0.45 to 0.225"),
            "",
            order(errors[1], errors[2]),
            2.0,
            0.25,
            "second order, of a chatter whose paths part within some milliseconds",
        ));
    }
    Ok(claims)
}
