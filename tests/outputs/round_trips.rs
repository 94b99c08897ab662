//! What is written is what is read.

use std::fs;

use hexroll::output::contact::ContactRow;
use hexroll::output::{RunWriter, read};
use hexroll::record::{ContactNode, ContactState, Sample, Snapshot};

use crate::fixtures::*;

/// The columns the outputs are specified with, spelled out.
const HEADER: &str = "time_s,stage,road_fx_N,road_fy_N,road_fz_N,road_fx_std_N,road_fy_std_N,road_fz_std_N,\
                      rim_fx_N,rim_fy_N,rim_fz_N,rim_mx_Nm,rim_my_Nm,rim_mz_Nm,axle_x_m,axle_y_m,axle_z_m,\
                      rim_angle_rad,steer_rad,camber_rad,contact_area_m2,contact_nodes,sticking_share,\
                      changing_share,footprint_length_m,footprint_width_m,peak_pressure_Pa,kinetic_J,strain_J,hourglass_J,external_work_J,friction_work_J,road_work_J,\
                      contact_work_J,damping_work_J,viscous_work_J,balance_error_J,stored_balance_error_J,\
                      min_jacobian,dt_s,dissipation_J";

#[test]
fn the_history_has_the_specified_columns_in_their_order() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut writer = RunWriter::create(&dir, &mesh, None).unwrap();
    writer.sample(&sample("roll", 0.5)).unwrap();
    let text = fs::read_to_string(dir.join("history.csv")).unwrap();
    assert_eq!(text.lines().next(), Some(HEADER));
    assert!(text.lines().nth(1).unwrap().starts_with("0.5,roll,50.0,0.0,300.0,"), "{text}");
    // The fields of the struct, as serde sees them, are these columns too.
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.serialize(Sample::default()).unwrap();
    let text = String::from_utf8(csv.into_inner().unwrap()).unwrap();
    assert_eq!(text.lines().next(), Some(HEADER));
}

#[test]
fn a_history_comes_back_bit_for_bit() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut writer = RunWriter::create(&dir, &mesh, None).unwrap();
    let mut rows = vec![sample("press, then \"hold\"", 1e-3), sample("roll", 2e-3)];
    rows[1].strain_J = f64::INFINITY;
    for row in &rows {
        writer.sample(row).unwrap();
        // On disk at once: the writer is still open.
        assert_eq!(read::history(&dir).unwrap().last(), Some(row));
    }
    assert_eq!(read::history(&dir).unwrap(), rows);
}

#[test]
fn a_snapshot_and_its_mesh_come_back() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let written = snapshot(&mesh, 0.1 + 0.2);
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&written, "gl\u{fc}hen & <roll>").unwrap();
    let files = read::snapshots(&dir).unwrap();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].time, 0.1 + 0.2);
    let stored = read::snapshot(&files[0].path).unwrap();
    assert_eq!(stored.stage, "gl\u{fc}hen & <roll>");
    assert_eq!(stored.snapshot, written);
    assert_eq!(stored.mesh.hexes, mesh.hexes);
    assert_eq!(stored.mesh.facets, mesh.facets);
    assert_eq!(stored.mesh.rim, mesh.rim);
    assert_eq!(stored.mesh.surface, mesh.surface);
    assert_eq!(stored.mesh.axle, mesh.axle);
    // X = x - (x - X): two roundings of numbers below 0.5, each at most 2^-55.
    for (a, b) in stored.mesh.nodes.as_flattened().iter().zip(mesh.nodes.as_flattened()) {
        assert!((a - b).abs() <= 2.0_f64.powi(-54), "{a} {b}");
    }
}

#[test]
fn a_snapshot_without_road_and_rim_comes_back_without_them() {
    let (_temp, dir) = folder();
    let mesh = block();
    let written = Snapshot { contact: Vec::new(), axle: None, ..snapshot(&mesh, 0.0) };
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&written, "fly").unwrap();
    assert!(!dir.join("contact_0.csv").exists());
    let stored = read::snapshot(&dir.join("snapshot_0.vtu")).unwrap();
    assert_eq!(stored.snapshot, written);
    assert_eq!((stored.mesh.facets, stored.mesh.rim), (mesh.facets, mesh.rim));
}

#[test]
fn contact_files_list_the_nodes_that_touched() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut written = snapshot(&mesh, 0.0);
    // Lifted off at the end of the window, but carried a force during it.
    written.contact[0] =
        ContactNode { force: [0.0, 0.0, 5.0], state: ContactState::Free, ..written.contact[0] };
    // Touches since the last step, too short for a force that is not zero.
    written.contact[1].force = [0.0; 3];
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&written, "roll").unwrap();
    let text = fs::read_to_string(dir.join("contact_0.csv")).unwrap();
    let header = "node,x_m,y_m,z_m,fx_N,fy_N,fz_N,pressure_Pa,slip_speed_m_s,state";
    assert_eq!(text.lines().next(), Some(header));
    assert!(text.lines().nth(2).unwrap().ends_with(",stick"), "{text}");

    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<ContactRow> = reader.deserialize().collect::<Result<_, _>>().unwrap();
    let touched: Vec<_> = written.contact.iter().enumerate().filter(|(i, _)| *i == 0 || i % 3 != 0).collect();
    assert_eq!(rows.len(), touched.len());
    for (row, (_, c)) in rows.iter().zip(touched) {
        assert_eq!((row.node, [row.x_m, row.y_m, row.z_m]), (c.node, written.mean_position(c.node as usize)));
        // At -v 1 ms / 2 from where it is at the end.
        let (n, way) = (c.node as usize, row.x_m - written.x[c.node as usize][0]);
        assert!((way + 0.5e-3 * written.v[n][0]).abs() < 1e-15, "{way} m");
        assert_eq!([row.fx_N, row.fy_N, row.fz_N], c.force);
        assert_eq!((row.pressure_Pa, row.slip_speed_m_s, row.state), (c.pressure, c.slip_speed, c.state));
    }
}

#[test]
fn a_contact_file_without_touching_nodes_still_has_its_header() {
    let (_temp, dir) = folder();
    let mesh = wheel();
    let mut lifted = snapshot(&mesh, 0.0);
    lifted.contact.iter_mut().for_each(|c| (c.force, c.state) = ([0.0; 3], ContactState::Free));
    RunWriter::create(&dir, &mesh, None).unwrap().snapshot(&lifted, "fly").unwrap();
    let text = fs::read_to_string(dir.join("contact_0.csv")).unwrap();
    assert_eq!(text, "node,x_m,y_m,z_m,fx_N,fy_N,fz_N,pressure_Pa,slip_speed_m_s,state\n");
}
