//! The GPU engine against the CPU's double precision, at three levels: the force law, one step, and whole runs; and
//! what it promises of itself: bit-identical reruns, failures and limits as errors, contact that never penetrates.
//!
//! Needs an adapter (a software one will do); without one every trial is reported as ignored. Trials are few, since
//! each may run in a process of its own and compiling pipelines is what takes time on a software adapter.
//! `HEXROLL_TEST_PRINT=1` prints what is measured.

#![allow(non_snake_case)] // X: reference positions

mod contact;
mod ensemble;
mod errors;
mod far;
mod forces;
mod functions;
mod histories;
mod laws;
mod relaxing;
mod repeat;
mod resident;
mod rig;
mod rim;
mod roads;
mod rolling;
mod runs;
mod small_strains;
mod steps;
mod timing;

use hexroll::Error;
use hexroll::gpu::Gpu;
use hexroll_lab::report::{Case, parity};
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

type Check = fn(&Gpu);

const CHECKS: [(&str, Check); 34] = [
    ("forces_of_every_element_and_law_are_the_cpus", forces::every_composition),
    ("ogden_with_powers_two_and_minus_two_is_mooney_rivlin", forces::ogden_is_mooney_rivlin),
    ("forces_as_pairs_are_the_cpus", forces::pairs),
    ("forces_of_every_numbering_are_the_cpus", forces::every_numbering),
    ("small_strains_store_what_the_closed_form_says", small_strains::shear),
    ("a_step_with_everything_is_the_cpus", steps::everything),
    ("a_spinning_vibrating_block_is_the_cpus", runs::spinning_block),
    ("a_pressed_wheel_is_the_cpus", runs::pressed_wheel),
    ("a_viscous_wheel_rolls_as_on_the_cpu", rolling::viscous),
    ("an_elastic_wheel_rolls_as_on_the_cpu", rolling::elastic),
    ("an_axle_pressed_by_a_force_moves_as_on_the_cpu", rim::pressed_by_a_force),
    ("a_wheel_free_to_spin_turns_as_on_the_cpu", rim::free_to_spin),
    ("a_block_and_its_rim_fall_together", rim::falls),
    ("what_relaxes_is_the_cpus", relaxing::agrees),
    ("what_points_remember_is_left_alone", relaxing::disturbed),
    ("histories_at_a_high_rate_are_the_cpus", histories::as_the_cpus),
    ("a_rerun_is_the_same_to_the_bit", repeat::bit_identical),
    ("far_from_the_origin_forces_are_the_same", far::offset),
    ("the_frame_follows_a_fast_wheel", far::followed),
    ("a_mesh_in_one_work_group_moves_as_elsewhere", resident::agrees),
    ("bodies_together_have_the_bits_they_have_alone", ensemble::as_alone),
    ("bodies_driven_by_one_thread_have_them_too", ensemble::by_one_thread),
    ("an_ensemble_of_what_does_not_fit_is_refused", ensemble::too_large),
    ("timed_steps_are_the_steps", timing::passes),
    ("limits_of_the_adapter_are_measured", timing::limits),
    ("a_run_that_goes_wrong_says_where", errors::failures),
    ("hourglass_energy_beyond_the_limit_ends_a_run", errors::hourglass),
    ("what_does_not_fit_is_refused", errors::limits),
    ("an_adapter_without_doubles_refuses_them", errors::no_doubles),
    ("what_wgpu_refuses_is_an_error", errors::device_errors),
    ("friction_laws_and_holds_are_the_cpus", laws::friction_and_holds),
    ("every_road_is_the_cpus", roads::every_road),
    ("contact_step_by_step_adds_up", contact::steps_add_up),
    ("nothing_penetrates_and_what_sticks_stays", contact::exact),
];

/// Where the adapter has double precision.
const DOUBLES: [(&str, Check); 7] = [
    ("functions_of_doubles_are_the_hosts", functions::doubles),
    ("forces_in_doubles_are_the_cpus", forces::doubles),
    ("steps_in_doubles_are_the_cpus", steps::doubles),
    ("a_pressed_wheel_in_doubles_is_the_cpus", runs::doubles),
    ("a_free_wheel_in_doubles_turns_as_on_the_cpu", rim::doubles),
    ("friction_laws_in_doubles_are_the_cpus", laws::doubles),
    ("what_relaxes_in_doubles_is_the_cpus", relaxing::doubles),
];

/// A page of `hexroll report parity`, which stands for this suite where there is nothing but the program.
fn page(case: &Case) -> Result<(), Failed> {
    let claims = (case.run)()?;
    let broken: Vec<String> = claims.iter().filter(|c| !c.holds()).map(|c| c.cells().join(" | ")).collect();
    match claims.is_empty() || !broken.is_empty() {
        true => Err(format!("{}:\n{}", case.title, broken.join("\n")).into()),
        false => Ok(()),
    }
}

fn main() {
    let mut arguments = Arguments::from_args();
    // The device and the processor are shared by all trials: one after the other is fastest.
    arguments.test_threads = arguments.test_threads.or(Some(1));
    let gpu = match Gpu::open(None) {
        Ok(gpu) => Some(gpu),
        Err(Error::NoAdapter { .. }) => None,
        Err(error) => panic!("{error}"),
    };
    let missing = gpu.is_none();
    let single = gpu.as_ref().is_none_or(|gpu: &Gpu| !gpu.report.doubles);
    let gpu = Arc::new(gpu);
    let trial = |ignored: bool, (name, check): &(&str, Check)| {
        let (gpu, check) = (Arc::clone(&gpu), *check);
        let run = move || -> Result<(), Failed> {
            check(gpu.as_ref().as_ref().ok_or("no adapter")?);
            Ok(())
        };
        Trial::test(*name, run).with_ignored_flag(ignored)
    };
    let everywhere = CHECKS.iter().map(|check| trial(missing, check));
    let doubles = DOUBLES.iter().map(|check| trial(single, check));
    let page = |case: &'static Case| Trial::test(case.theorem, || page(case)).with_ignored_flag(missing);
    let trials = everywhere.chain(doubles).chain(parity::CASES.iter().map(page)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}
