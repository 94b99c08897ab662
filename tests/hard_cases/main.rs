//! Hard cases: stable at the default settings, and where a run fails it says why. The same cases as
//! `hexroll report stability`.

use hexroll::report::stability::{CASES, HARD, find};

/// Searches the limit of a case; it must be as the case says.
fn assert_limit(name: &str) {
    let hard = HARD.iter().find(|h| h.name == name).unwrap_or_else(|| panic!("there is no case {name}"));
    let limit = find(hard).unwrap_or_else(|e| panic!("{}: {e}", hard.title));
    assert!(hard.holds(&limit), "{}: {limit:#?}", hard.title);
}

/// Runs a case with claims; every one must hold.
fn assert_claims(name: &str) {
    let case = CASES.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("there is no case {name}"));
    let claims = (case.run)().unwrap_or_else(|e| panic!("{}: {e}", case.title));
    let broken: Vec<_> = claims.iter().filter(|c| !c.holds()).collect();
    assert!(!claims.is_empty() && broken.is_empty(), "{}: {broken:#?}", case.title);
}

macro_rules! cases {
    ($check:ident: $($(#[$attribute:meta])* $test:ident: $name:literal;)*) => {
        $($(#[$attribute])* #[test] fn $test() { $check($name); })*
    };
}

cases! { assert_limit:
    #[ignore = "long: make verify"]
    nearly_incompressible_rubber_rolls: "incompressible";
    slip_at_45_degrees: "slip_45";
    slip_at_90_degrees: "slip_90";
    a_locked_wheel: "locked";
    a_spun_wheel: "spun";
    no_friction: "mu_0";
    friction_of_2: "mu_2";
    friction_of_10: "mu_10";
    pressed_by_6_mm: "press_6";
    pressed_by_8_mm: "press_8";
    pressed_until_elements_turn_inside_out: "press_16";
    impact_at_10_metres_a_second: "impact_10";
    impact_at_30_metres_a_second: "impact_30";
    corner_first: "corner";
    elements_20_times_as_long_as_thick: "flat";
    elements_10_degrees_from_flat: "skew";
    a_tiny_element_among_large_ones: "tiny";
    loads_that_excite_hourglass_modes: "hourglass";
    touch_and_release_on_one_step: "skim";
}

cases! { assert_claims:
    the_critical_step_is_sharp: "critical_step";
    an_element_inside_out_is_refused: "inside_out";
    similar_wheels_have_similar_forces: "similarity";
    a_wheel_at_one_kilometre: "far_away";
    sliding_wheels_have_the_steps_energy_error: "sliding_energy";
    elastic_rolling_is_named_as_chattering: "chatter";
    #[ignore = "a million steps: make verify"]
    a_million_steps: "million_steps";
}
