//! What the device says after a submission: contact of each step, which step failed, and whether the last pass ran at all.

use super::layout::{Real, decode};
use crate::engine::{Step, StepContact};
use crate::error::{Error, Result};

/// First failing step with its element, and the last step taken, as the device has them.
#[derive(Debug, Clone, Copy)]
pub struct Flags {
    pub failure: [u32; 2],
    pub done: u32,
}

/// Before any step.
pub const NO_FLAGS: Flags = Flags { failure: [u32::MAX; 2], done: u32::MAX };

/// What the device says of the steps of a submission.
pub struct Taken {
    /// Contact by step and work group.
    pub contact: Vec<[f64; 4]>,
    pub flags: Flags,
    /// States of watched nodes, as they came.
    pub watched: Vec<u8>,
    /// How long it took [s].
    pub seconds: f64,
}

impl Taken {
    /// From the bytes of contact, failure and sentinel.
    pub fn of([contact, failure, done]: [&[u8]; 3], real: Real, seconds: f64) -> Taken {
        let word = |bytes: &[u8], k: usize| bytemuck::cast_slice::<u8, u32>(bytes)[k];
        let flags = Flags { failure: [word(failure, 0), word(failure, 1)], done: word(done, 0) };
        Taken { contact: decode(real, contact), flags, watched: Vec::new(), seconds }
    }
}

/// Contact over the body in one step from its sums by work groups, as shaders/contact/book.wgsl packs them.
pub fn step_contact(step: &Step, sums: &[[f64; 4]]) -> StepContact {
    let mut all = StepContact { dtm: step.dtm(), ..StepContact::default() };
    for sum in sums {
        all.force.iter_mut().zip(sum).for_each(|(f, s)| *f += s);
        let counts = sum[3] as u32;
        all.touching += counts % 4096;
        all.changes += counts / 4096;
    }
    all
}

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
