//! `contact_<k>.csv`: the nodes that touched the road during the last window before a snapshot.
//!
//! Columns: [`ContactRow`]'s fields. A node is listed if it touches at the end of the window or carries a
//! force in the mean over it. The area behind the pressure is the snapshot's `contact_area`.
//!
//! Forces and positions belong together: both are means over the window, the positions by the nodes' velocities at its
//! end ([`Snapshot::mean_position`]). Their moment about a fixed point is that of the window. The axle that goes with
//! them is its mean over the window too: half the sum of `axle_*_m` in its row of `history.csv` and in the row before.
//! About it the moment is, in steady rolling, minus `rim_m*_Nm` of the row.

use std::io::Write;

use crate::record::{ContactNode, ContactState, Snapshot};

/// A row of `contact_<k>.csv`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactRow {
    /// Index of the node, from 0.
    pub node: u32,
    /// Mean position over the window [m].
    pub x_m: f64,
    pub y_m: f64,
    pub z_m: f64,
    /// Force of the road on the node, mean over the window [N].
    pub fx_N: f64,
    pub fy_N: f64,
    pub fz_N: f64,
    /// Mean normal force over the node's deformed area at the end of the window [Pa].
    pub pressure_Pa: f64,
    /// Tangential speed relative to the road at the end of the window [m/s].
    pub slip_speed_m_s: f64,
    pub state: ContactState,
}

/// Names of the columns, written even where no node touches.
const HEADER: [&str; 10] =
    ["node", "x_m", "y_m", "z_m", "fx_N", "fy_N", "fz_N", "pressure_Pa", "slip_speed_m_s", "state"];

/// Rows of the touching nodes, in the order of the surface.
pub fn rows(snapshot: &Snapshot) -> impl Iterator<Item = ContactRow> + '_ {
    let touched = |c: &&ContactNode| c.state != ContactState::Free || c.force != [0.0; 3];
    snapshot.contact.iter().filter(touched).map(|c| {
        let ([x_m, y_m, z_m], [fx_N, fy_N, fz_N]) = (snapshot.mean_position(c.node as usize), c.force);
        let (pressure_Pa, slip_speed_m_s) = (c.pressure, c.slip_speed);
        ContactRow {
            node: c.node,
            x_m,
            y_m,
            z_m,
            fx_N,
            fy_N,
            fz_N,
            pressure_Pa,
            slip_speed_m_s,
            state: c.state,
        }
    })
}

/// Writes header and rows as CSV.
pub fn write(out: &mut dyn Write, snapshot: &Snapshot) -> std::io::Result<()> {
    let mut csv = csv::WriterBuilder::new().has_headers(false).from_writer(out);
    csv.write_record(HEADER)?;
    for row in rows(snapshot) {
        csv.serialize(row)?;
    }
    csv.flush()
}
