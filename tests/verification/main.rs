//! The pages of `hexroll report verification`, one test a page: closed forms, other codes, conservation laws.
//!
//! A page is a file of `src/report/verification`: source, body, loads, claims with their tolerances and reasons. Those
//! that are not for every day are ignored.

use hexroll_lab::report::Case;
use hexroll_lab::report::verification::CASES;
use libtest_mimic::{Arguments, Failed, Trial};

/// Runs a page; every claim must hold.
fn check(case: &Case) -> Result<(), Failed> {
    let claims = (case.run)()?;
    if claims.is_empty() {
        return Err("it claims nothing".into());
    }
    let broken: Vec<String> = (claims.iter().filter(|c| !c.holds()))
        .map(|c| {
            let [what, expected, got, error, tolerance, _] = c.cells();
            format!(
                "{what}: {got}, expected {expected}, off by {error}, tolerance {tolerance} ({})",
                c.reason
            )
        })
        .collect();
    if broken.is_empty() {
        return Ok(());
    }
    Err(format!("{} ({}):\n{}", case.title, case.source, broken.join("\n")).into())
}

fn main() {
    let trial =
        |case: &'static Case| Trial::test(case.theorem, || check(case)).with_ignored_flag(!case.everyday);
    libtest_mimic::run(&Arguments::from_args(), CASES.iter().map(trial).collect()).exit();
}
