//! Hard cases: stable at the default settings, and where a run fails it says why. The same cases as
//! `hexroll report stability`; those that are not for every day are ignored.

use hexroll_lab::report::Case;
use hexroll_lab::report::stability::{CASES, HARD, Hard, find};
use libtest_mimic::{Arguments, Failed, Trial};

/// Searches the limit of a case; it must be as the case says.
fn check_limit(hard: &Hard) -> Result<(), Failed> {
    let limit = find(hard)?;
    if hard.holds(&limit) { Ok(()) } else { Err(format!("{}: {limit:#?}", hard.title).into()) }
}

/// Runs a case with claims; every one must hold.
fn check_claims(case: &Case) -> Result<(), Failed> {
    let claims = (case.run)()?;
    let broken: Vec<_> = claims.iter().filter(|c| !c.holds()).collect();
    if !claims.is_empty() && broken.is_empty() {
        return Ok(());
    }
    Err(format!("{}: {broken:#?}", case.title).into())
}

fn main() {
    let limits =
        HARD.iter().map(|h| Trial::test(h.theorem, || check_limit(h)).with_ignored_flag(!h.everyday));
    let claims =
        CASES.iter().map(|c| Trial::test(c.theorem, || check_claims(c)).with_ignored_flag(!c.everyday));
    libtest_mimic::run(&Arguments::from_args(), limits.chain(claims).collect()).exit();
}
