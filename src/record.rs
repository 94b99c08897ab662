//! What a run produces, whatever engine computed it: history rows and whole fields, SI, f64.

use crate::scene::history::Format;

/// One row of the history: a window of `output.sample` seconds that ends at `time`.
///
/// Forces and moments are impulses over the window divided by its length, from every step.
/// Energies and works are totals since t = 0 [J]; works are done *on the body* (losses are negative).
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    pub time_s: f64,
    /// Name of the stage the window belongs to.
    pub stage: String,
    /// Road's force on the body [N].
    pub road_fx_N: f64,
    pub road_fy_N: f64,
    pub road_fz_N: f64,
    /// Standard deviation over the window of the road's force in every step (explicit stages; 0 in implicit ones) [N].
    pub road_fx_std_N: f64,
    pub road_fy_std_N: f64,
    pub road_fz_std_N: f64,
    /// Rim's force on the rubber, without the rim nodes' own inertia [N].
    pub rim_fx_N: f64,
    pub rim_fy_N: f64,
    pub rim_fz_N: f64,
    /// Rim's moment on the rubber about the axle's current point, fixed axes [N m].
    pub rim_mx_Nm: f64,
    pub rim_my_Nm: f64,
    pub rim_mz_Nm: f64,
    /// Axle's position at the end of the window [m].
    pub axle_x_m: f64,
    pub axle_y_m: f64,
    pub axle_z_m: f64,
    /// Spin angle at the end of the window [rad].
    pub rim_angle_rad: f64,
    /// Steer angle about z, and camber about the new x, at the end of the window [rad].
    pub steer_rad: f64,
    pub camber_rad: f64,
    /// Deformed area of the touching nodes, each weighted with its share of the window in contact [m2].
    pub contact_area_m2: f64,
    /// Mean number of touching nodes over the window.
    pub contact_nodes: f64,
    /// Share of the touching node-steps that stick, 0..1 (0 without contact or friction).
    pub sticking_share: f64,
    /// Nodes that change their contact state (free, stick, slip) from one step to the next, over touching nodes.
    pub changing_share: f64,
    /// Extent of the footprint along the wheel's heading and across it, over nodes that touch for half of the window (of
    /// the time in which a wheel rolls over a facet, if that is shorter) or more, with the halves of the facets beside
    /// them [m].
    pub footprint_length_m: f64,
    pub footprint_width_m: f64,
    /// Largest normal force of a node over its deformed area, mean over its time in contact within the window (within
    /// a facet's passing, if that is shorter) [Pa].
    pub peak_pressure_Pa: f64,
    /// Kinetic energy at the last half step, of the body and of the rim's own mass and inertia in its free components [J].
    pub kinetic_J: f64,
    pub strain_J: f64,
    pub hourglass_J: f64,
    /// Work of what drives and loads the rim, less what mass damping takes from it, and of the body force, on the body and on
    /// the rim's own mass [J].
    pub external_work_J: f64,
    pub friction_work_J: f64,
    /// Work that the road's motion puts in: its force on the body times the velocity of its surface [J]. Friction dissipates this
    /// less the friction work.
    pub road_work_J: f64,
    /// Work of the normal contact forces: impact loss [J].
    pub contact_work_J: f64,
    pub damping_work_J: f64,
    pub viscous_work_J: f64,
    /// Kinetic energy less every work since the start [J]; round-off unless a force went unbooked.
    pub balance_error_J: f64,
    /// The same with the stored energy W in place of the internal work [J].
    pub stored_balance_error_J: f64,
    /// Smallest det F over all integration points at the end of the window.
    pub min_jacobian: f64,
    /// Step used in the window [s].
    pub dt_s: f64,
    /// Energy that viscosity and relaxation have turned into heat [J].
    pub dissipation_J: f64,
}

/// A column of numbers in `history.csv`: its name, and its value in a sample.
pub type Column = (&'static str, fn(&Sample) -> f64);

macro_rules! columns {
    ($($name:ident)*) => { &[$((stringify!($name), |sample: &Sample| sample.$name)),*] };
}

impl Sample {
    /// Every column but `stage`, in the order of the fields.
    pub const COLUMNS: &'static [Column] = columns!(
        time_s road_fx_N road_fy_N road_fz_N road_fx_std_N road_fy_std_N road_fz_std_N rim_fx_N rim_fy_N
        rim_fz_N rim_mx_Nm rim_my_Nm rim_mz_Nm axle_x_m axle_y_m axle_z_m rim_angle_rad steer_rad camber_rad
        contact_area_m2 contact_nodes sticking_share changing_share footprint_length_m footprint_width_m peak_pressure_Pa
        kinetic_J strain_J hourglass_J external_work_J friction_work_J road_work_J contact_work_J damping_work_J
        viscous_work_J balance_error_J stored_balance_error_J min_jacobian dt_s
        dissipation_J
    );
}

/// Stored energy over the largest of the run below which shares of it are of no account: stresses are below half the largest.
/// It is the ringing after an impact, say, in which a block that has landed flat has 6 % of hourglass energy while more is
/// stored, and 18 % where a tenth is.
const LITTLE: f64 = 0.25;

impl Sample {
    /// Strain and hourglass energy [J].
    pub fn stored(&self) -> f64 {
        self.strain_J + self.hourglass_J
    }

    /// Hourglass energy over strain energy, where the stored energy matters: it is a quarter of the `largest` of the run or
    /// more, and more than `rounding` leaves of it ([`rounding_of_energy`]) [J]. `None` elsewhere, and without hourglass energy.
    pub fn hourglass_share(&self, largest: f64, rounding: f64) -> Option<f64> {
        let matters = self.stored() > rounding && self.stored() >= LITTLE * largest;
        // A strain energy that is lost in rounding is not less than that.
        (matters && self.hourglass_J > 0.0).then(|| self.hourglass_J / self.strain_J.max(rounding))
    }
}

/// What rounding leaves of the stored energy of a body with a shear modulus G [Pa] and a volume V [m3], at most, in arithmetic with
/// the spacing `epsilon` of numbers at 1 [J]: an energy density is a difference of numbers of the size of G. In single
/// precision 880 elements that store nothing were found to store 0.4 epsilon G V; ten times that, which strains of some
/// 1e-3 exceed (1e-7 in double precision).
pub fn rounding_of_energy(shear_modulus: f64, volume: f64, epsilon: f64) -> f64 {
    4.0 * epsilon * shear_modulus * volume
}

/// What a driven set has done in a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaction {
    /// Name of the node set.
    pub set: String,
    /// Displacement at the end of the window, before any turn [m], and the force of what drives the set on the body, without the
    /// inertia of its nodes: mean over the window [N]. `None`: the component is free.
    pub components: [Option<[f64; 2]>; 3],
}

/// State of a node that can touch the road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ContactState {
    Free,
    Stick,
    Slip,
}

/// A surface node in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactNode {
    pub node: u32,
    /// Force of the road on the node, mean over the last window [N]: it belongs to [`Snapshot::mean_position`].
    pub force: [f64; 3],
    /// Deformed tributary area at the end of the window [m2].
    pub area: f64,
    /// Mean normal force over that area [Pa].
    pub pressure: f64,
    /// Tangential speed relative to the road at the end of the window [m/s].
    pub slip_speed: f64,
    /// Energy that friction has dissipated at the node since the start [J].
    pub friction_energy: f64,
    pub state: ContactState,
}

/// Whole fields at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    pub time: f64,
    pub step: u64,
    /// Length of the window that ends here, over which the contact forces are means [s].
    pub force_time: f64,
    /// Current positions [m], shape `[node_count]`.
    pub x: Vec<[f64; 3]>,
    /// Velocities half a step before `time` [m/s], shape `[node_count]`; those at `time` after implicit stages.
    pub v: Vec<[f64; 3]>,
    /// Every surface node of the mesh, in its order; empty without a road.
    pub contact: Vec<ContactNode>,
    /// Mean volume ratio v/V, shape `[element_count]`.
    pub volume_ratio: Vec<f64>,
    /// Mean of -tr(sigma)/3 [Pa], shape `[element_count]`.
    pub pressure: Vec<f64>,
    /// Mean von Mises stress [Pa], shape `[element_count]`.
    pub von_mises: Vec<f64>,
    /// Axle's position [m] and rotation matrix of the rim (rows), if there is a rim.
    pub axle: Option<([f64; 3], [[f64; 3]; 3])>,
}

impl Snapshot {
    /// Mean position of a node over the window [m], by its velocity at the end: a quarter of acceleration times the square
    /// of half the window off. After a static increment, which has no velocities, the position that its forces belong to.
    pub fn mean_position(&self, node: usize) -> [f64; 3] {
        std::array::from_fn(|d| self.x[node][d] - 0.5 * self.force_time * self.v[node][d])
    }
}

/// The road's force step by step, over the last 30 % of an explicit stage.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactNoise {
    /// What the steps span [s], and how many there are.
    pub start: f64,
    pub end: f64,
    pub steps: u64,
    /// Steps without any contact.
    pub free_steps: u64,
    /// Mean force, and standard deviation of the single steps about it [N].
    pub mean: [f64; 3],
    pub std: [f64; 3],
    /// The node-passing tone of a spinning ring mesh.
    pub tone: Option<Tone>,
    /// Standard deviation about a straight line and the tone: what is left is chatter or noise [N].
    pub remaining: [f64; 3],
    /// Nodes that change their contact state from one step to the next, over touching nodes.
    pub changing_share: f64,
    /// Class of the rounding error of forces at the end of the stage ([`Estimate::rounding`]).
    pub rounding: Option<f64>,
}

/// A ring of N elements round the circumference is a polygon whose corners meet the road N times a turn: that is heard
/// in the force at N omega / 2 pi and its multiples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tone {
    /// [Hz]
    pub frequency: f64,
    /// Standard deviation of the force that it makes, with its multiples [N].
    pub std: [f64; 3],
}

/// Classes of a run's own errors, relative to forces and deformation ([`crate::run::estimate`] says how). None: the kind does not arise, or is not estimated (implicit stages).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    pub time_step: Option<f64>,
    pub rounding: Option<f64>,
    pub residual: Option<f64>,
}

/// One iteration of Newton's method in an implicit stage: a row of `implicit.csv`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NewtonRow {
    pub stage: String,
    /// End and length of the increment that is being tried [s].
    pub time_s: f64,
    pub dt_s: f64,
    /// What became of the increment: `converged`, or `failed` (it is cut, and tried again shorter).
    pub increment: String,
    /// From 0: the state that the increment starts from.
    pub iteration: usize,
    /// Residual before the iteration's correction, over the force scale (eq. 23).
    pub residual: f64,
    /// Nodes whose contact state changed before the correction.
    pub contact_changes: usize,
    /// Iterations of the linear solver, sweeps of the relaxation, or multigrid cycles.
    pub inner_iterations: usize,
    /// Share of the correction that was applied; 0 where there was none.
    pub share: f64,
}

/// A history at a high rate: `history_<name>.npz`. Times are whole numbers of periods from the start of the simulation; where a
/// stage is not taken down they leave it out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    pub name: String,
    /// [Hz]
    pub rate: f64,
    /// Whether the places go with the material.
    pub turning: bool,
    /// By place: the mesh's node (that stands there in the reference shape; of points the nearest corner), and of the reference
    /// shape position [m], unit normal outwards (zero inside the body), area [m2] (of faces of the history).
    pub nodes: Vec<u32>,
    pub positions: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
    pub areas: Vec<f64>,
    /// Outer faces between places, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 4]>,
    /// [s]
    pub times: Vec<f64>,
    pub values: Vec<Values>,
    /// The road's force on the whole body [N], shape `[times, 3]`; none without a road.
    pub road_force: Option<Vec<f32>>,
    /// Files that it is written to.
    pub formats: Vec<Format>,
}

/// A quantity of a history.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values {
    pub name: &'static str,
    pub unit: &'static str,
    /// Numbers a place.
    pub components: usize,
    /// Shape `[times, places, components]`.
    pub values: Vec<f32>,
}
