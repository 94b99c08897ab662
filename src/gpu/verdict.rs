//! What the device says after a submission: which step failed, and whether the last pass ran at all.

use crate::engine::Step;
use crate::error::{Error, Result};

/// The error in the device's failure record `[step, 2 element + (1: not finite)]`, in which all bits set means none.
/// `steps` are those taken since `first`.
pub fn failure(record: [u32; 2], steps: &[Step], first: u64, number: impl Fn(usize) -> usize) -> Result<()> {
    let [step, found] = record;
    if step == u32::MAX {
        return Ok(());
    }
    // The device counts in 32 bits.
    let step = first + u64::from(step.wrapping_sub(first as u32));
    let time = steps.get((step - first) as usize).map_or(f64::NAN, |s| s.time);
    let element = number((found / 2) as usize);
    Err(match found % 2 {
        0 => Error::Inverted { step, time, element },
        _ => Error::NotFinite { step, time, element },
    })
}

/// What is wrong if the last node pass wrote `done` after `steps` steps: drivers have been seen to end a long
/// submission early, without an error.
pub fn sentinel(done: u32, steps: u64) -> std::result::Result<(), String> {
    let last = steps - 1;
    match done {
        d if d == last as u32 => Ok(()),
        u32::MAX => Err(format!("the device took none of {steps} steps, without an error")),
        d => Err(format!("the device stopped at step {d} of {last} without an error")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(count: usize) -> Vec<Step> {
        let step = |n: usize| Step { time: n as f64, dt: 1.0, dt_before: 1.0, rim: [0.0; 6], load: [0.0; 6] };
        (0..count).map(step).collect()
    }

    #[test]
    fn a_failure_names_its_step_time_and_element() {
        assert!(failure([u32::MAX; 2], &steps(3), 7, |e| e).is_ok());
        let inverted = failure([8, 2 * 5], &steps(3), 7, |e| e);
        assert!(matches!(inverted, Err(Error::Inverted { step: 8, element: 5, time: 1.0 })), "{inverted:?}");
        let nan = failure([9, 2 * 5 + 1], &steps(3), 7, |e| e);
        assert!(matches!(nan, Err(Error::NotFinite { step: 9, element: 5, time: 2.0 })), "{nan:?}");
        // Beyond 2^32 steps the device's counter has wrapped.
        let first = (1 << 32) - 1;
        assert!(
            matches!(failure([1, 0], &steps(3), first, |e| e), Err(Error::Inverted { step, .. }) if step == first + 2)
        );
    }

    #[test]
    fn a_submission_that_stopped_short_is_noticed() {
        assert!(sentinel(9, 10).is_ok());
        assert!(sentinel(0, 1).is_ok());
        for (done, steps) in [(8, 10), (u32::MAX, 1), (u32::MAX, 10)] {
            assert!(sentinel(done, steps).is_err());
        }
    }
}
