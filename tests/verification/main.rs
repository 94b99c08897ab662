//! The pages of `hexroll report verification`, one test a page: closed forms, other codes, conservation laws.
//!
//! A page is a file of `src/report/verification`: source, body, loads, claims with their tolerances and reasons.

use hexroll::report::Case;
use hexroll::report::verification::CASES;

fn case(name: &str) -> &'static Case {
    CASES.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("there is no case {name}"))
}

/// Runs a page; every claim must hold.
fn assert_page(name: &str) {
    let case = case(name);
    let claims = (case.run)().unwrap_or_else(|e| panic!("{}: {e}", case.title));
    assert!(!claims.is_empty(), "{} claims nothing", case.title);
    let broken: Vec<String> = (claims.iter().filter(|c| !c.holds()))
        .map(|c| {
            let [what, expected, got, error, tolerance, _] = c.cells();
            format!(
                "{what}: {got}, expected {expected}, off by {error}, tolerance {tolerance} ({})",
                c.reason
            )
        })
        .collect();
    assert!(broken.is_empty(), "{} ({}):\n{}", case.title, case.source, broken.join("\n"));
}

macro_rules! pages {
    ($($(#[$attribute:meta])* $test:ident: $name:literal;)*) => {
        $($(#[$attribute])* #[test] fn $test() { assert_page($name); })*

        /// Pages with a test, and whether it runs every day.
        const TESTED: &[&str] = &[$($name),*];
    };
}

pages! {
    every_law_has_its_closed_form_stresses_up_to_threefold_stretch: "constitutive";
    plane_waves_have_their_speed_order_and_dispersion: "waves";
    a_free_cube_vibrates_in_lames_mode: "vibration";
    rigid_rotation_makes_no_force: "rotation";
    a_bonded_strip_does_not_lock: "bonded_strip";
    a_bar_meets_a_wall_as_st_venant_says: "bar_impact";
    a_pressed_cylinder_is_hertzs: "hertz_line";
    #[ignore = "long: make verify"]
    a_pressed_ball_is_hertzs: "hertz_point";
    a_pressed_cylinder_pushed_sideways_slips_at_its_edges: "cattaneo_mindlin";
    #[ignore = "long: make verify"]
    a_rolling_cylinder_creeps_as_carter_says: "carter";
    a_slider_follows_its_equation_of_motion: "slider";
    a_block_slides_down_a_slope: "slope";
    #[ignore = "long: make verify"]
    a_thin_tread_is_a_brush: "brush";
    #[ignore = "long, and tests/wheel.rs presses the same wheel every day: make verify"]
    the_papers_wheel_carries_its_force: "paper_static";
    #[ignore = "long, and tests/wheel.rs rolls the same wheel every day: make verify"]
    the_papers_wheel_rolls_with_its_forces: "paper_rolling";
    #[ignore = "long: make verify"]
    the_wheels_force_converges: "wheel_order";
}

#[test]
fn every_page_has_its_test() {
    let missing: Vec<&str> = CASES.iter().map(|c| c.name).filter(|n| !TESTED.contains(n)).collect();
    assert!(missing.is_empty(), "no test for {missing:?}");
}
