//! `contact_<k>.csv` adds up: its forces at its positions have the moment that the rim bears.

use hexroll::output::contact;
use hexroll::physics::road::Plane;
use hexroll::record::{Sample, Snapshot};
use hexroll::scene::{Road, Scene, Snapshots};
use hexroll_lab::rig::given::{DEPTH, SPEED, SPIN, STRAIGHT, VISCOSITY};
use hexroll_lab::rig::{Outcome, down, rolling, run, wheel};

/// A viscous wheel, pressed while it rolls, in windows of 1 ms on a road that moves at `road` [m/s] along x; a snapshot each.
fn rolled(axle: [f64; 2], road: f64) -> Outcome {
    let mut scene: Scene = wheel([24, 3, 3], 1.0);
    let ground = scene.road.expect("a road");
    let Road::Plane(ground) = ground else { panic!("a plane") };
    scene.road = Some(Road::Plane(Plane { velocity: [road, 0.0, 0.0], ..ground }));
    scene.body.viscosity = Some(VISCOSITY);
    scene.output.sample = 1e-3;
    scene.output.snapshots = Snapshots::Every(1e-3);
    let mut roll = rolling(axle, SPIN, 0.14);
    roll.rim.z = down(DEPTH);
    scene.stages = vec![roll];
    run(&scene)
}

/// Moment about y of the forces of `contact_<k>.csv` about `axle` [N m].
fn moment(snapshot: &Snapshot, axle: [f64; 3]) -> f64 {
    let of = |r: contact::ContactRow| (r.z_m - axle[2]) * r.fx_N - (r.x_m - axle[0]) * r.fz_N;
    contact::rows(snapshot).map(of).sum()
}

/// Means over the last 60 windows of the rim's moment and of minus that of the files, about the axle in the middle of
/// each window as the header of `output/contact.rs` says it [N m].
fn moments(outcome: &Outcome) -> [f64; 2] {
    let samples: Vec<&Sample> = outcome.samples.iter().filter(|s| s.stage == "roll").collect();
    let axle = |s: &Sample| [s.axle_x_m, s.axle_y_m, s.axle_z_m];
    let mut sums = [0.0; 2];
    let last = &samples[samples.len() - 61..];
    for pair in last.windows(2) {
        let [before, at] = [axle(pair[0]), axle(pair[1])];
        let middle = std::array::from_fn(|d| 0.5 * (before[d] + at[d]));
        let same = |s: &&Snapshot| (s.time - pair[1].time_s).abs() < 1e-9;
        let snapshot = outcome.snapshots.iter().find(same).expect("a snapshot every window");
        sums[0] += pair[1].rim_my_Nm / 60.0;
        sums[1] -= moment(snapshot, middle) / 60.0;
    }
    sums
}

/// What the rim bears and the contact does differ by the inertia of the rubber between them, whose mean over 60 ms is its
/// change of spin within the print over that time, and by what a node's path within a window is not straight: together
/// below 1 %. Forces of a window at positions of its end are 8 % off: half a window's 1.3 mm times 290 N of 4.5 N m.
#[test]
fn moments_of_the_contact_file_are_the_rims() {
    for (axle, road) in [(STRAIGHT, 0.0), ([0.0, 0.0], -SPEED)] {
        let [rim, contact] = moments(&rolled(axle, road));
        assert!(rim > 3.0, "{rim} N m");
        assert!((contact / rim - 1.0).abs() < 0.01, "road at {road} m/s: {contact} N m, the rim's {rim} N m");
    }
}
