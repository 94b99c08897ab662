//! Full-size pictures of every kind, to be looked at.

use std::path::PathBuf;

use hexroll::model::mesh::Mesh;
use hexroll::physics::road::Plane;
use hexroll::record::{ContactNode, ContactState};
use hexroll::render::{
    BodyView, ColourMap, FootprintColour, FootprintStyle, FootprintView, Projection, Range, Renderer, View,
};
use hexroll::scene::{Field, MeshSpec, Road};
use image::RgbaImage;

use super::inputs::{at_rest, rolling, wheel};

/// Full-size pictures of every kind, for the eye.
pub fn gallery(renderer: &mut Renderer) {
    let folder = PathBuf::from(std::env::var_os("HEXROLL_TEST_PICTURES").unwrap());
    std::fs::create_dir_all(&folder).unwrap();
    let save = |name: &str, picture: RgbaImage| picture.save(folder.join(format!("{name}.png"))).unwrap();
    let mesh = wheel(1.0);
    let snapshot = rolling(&mesh, 1.0);
    let title = Some("LAT-100 wheel, straight rolling".to_string());
    let body = BodyView { title: title.clone(), ..BodyView::default() };
    let perspective = Projection::Perspective { angle: 30.0 };
    let bodies = [
        ("iso_von_mises", BodyView { ..body.clone() }),
        ("perspective_speed", BodyView { projection: perspective, field: Field::Velocity, ..body.clone() }),
        ("side_pressure", BodyView { view: View::Side, field: Field::Pressure, ..body.clone() }),
        ("front_volume_ratio", BodyView { view: View::Front, field: Field::VolumeRatio, ..body.clone() }),
        ("behind_displacement", BodyView { view: View::Behind, field: Field::Displacement, ..body.clone() }),
        ("below_contact", BodyView { view: View::Below, field: Field::ContactForce, ..body.clone() }),
        ("fixed_range", BodyView { range: Range::Fixed(0.0, 0.5e6), map: ColourMap::Cividis, ..body }),
    ];
    for (name, options) in bodies {
        save(name, renderer.body(&mesh, &snapshot, &options).unwrap());
    }
    let flat = FootprintView { title, ..FootprintView::default() };
    let arrows = FootprintStyle::Arrows { view: View::Angles { azimuth: -62.0, elevation: 32.0 } };
    let feet = [
        ("footprint", flat.clone()),
        ("footprint_pressure", FootprintView { colour: FootprintColour::Pressure, ..flat.clone() }),
        ("footprint_arrows", FootprintView { style: arrows, ..flat.clone() }),
    ];
    for (name, options) in feet {
        save(name, renderer.footprint(&mesh, &snapshot, &options).unwrap());
    }
    save("footprint_empty", renderer.footprint(&mesh, &at_rest(&mesh), &flat).unwrap());
    slope(renderer, &save);
}

/// A block of ten millimetres on a slope, and one of a metre.
fn slope(renderer: &mut Renderer, save: &dyn Fn(&str, RgbaImage)) {
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let road = Road::Plane(Plane { point: [0.0; 3], normal: [-sin, 0.0, cos], velocity: [0.0; 3] });
    for (name, size, elements) in [("block_10mm", 0.01, [12, 8, 4]), ("block_1m", 1.0, [60, 40, 20])] {
        let spec = MeshSpec::Block { size: [size, 0.7 * size, 0.35 * size], elements };
        let mesh = Mesh::generate(&spec);
        let mut snapshot = at_rest(&mesh);
        snapshot.axle = None;
        for (x, X) in snapshot.x.iter_mut().zip(&mesh.nodes) {
            *x = [cos * X[0] - sin * X[2], X[1], sin * X[0] + cos * X[2]];
        }
        for (value, hex) in snapshot.von_mises.iter_mut().zip(&mesh.hexes) {
            *value = 3e3 * (1.0 - mesh.nodes[hex[0] as usize][2] / (0.4 * size)).powi(2);
        }
        let bottom = mesh.surface.iter().filter(|&&n| mesh.nodes[n as usize][2] == 0.0);
        snapshot.contact = bottom
            .map(|&node| {
                let share = 0.5 + mesh.nodes[node as usize][0] / size;
                let force = [-0.02 * sin, 1e-3 * share, 0.02 * share * cos].map(|f| f * size * size);
                let state = if share < 0.9 { ContactState::Stick } else { ContactState::Slip };
                ContactNode {
                    node,
                    force,
                    area: 1e-6,
                    pressure: 0.0,
                    slip_speed: 0.0,
                    friction_energy: 0.0,
                    state,
                }
            })
            .collect();
        save(
            name,
            renderer
                .body(&mesh, &snapshot, &BodyView { road: Some(road.clone()), ..BodyView::default() })
                .unwrap(),
        );
        let view = FootprintView { road: road.clone(), ..FootprintView::default() };
        save(&format!("{name}_footprint"), renderer.footprint(&mesh, &snapshot, &view).unwrap());
    }
}
