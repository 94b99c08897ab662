//! Pictures: what stands where, in which colour, and the same again.
//!
//! Needs an adapter (a software one will do); without one every trial is reported as ignored.
//! `HEXROLL_TEST_PICTURES=DIR` writes the gallery's pictures to DIR, to be looked at.

#![allow(non_snake_case)] // X: reference positions

#[path = "render/gallery.rs"]
mod gallery;
#[path = "render/inputs.rs"]
mod inputs;

use std::sync::{Arc, Mutex};

use hexroll::Error;
use hexroll::model::mesh::Mesh;
use hexroll::record::{ContactNode, ContactState, Snapshot};
use hexroll::render::{
    BodyView, Camera, ColourMap, FootprintColour, FootprintStyle, FootprintView, Projection, Range, Renderer,
    Scale, View,
};
use hexroll::scene::{Field, MeshSpec};
use image::RgbaImage;
use inputs::{INNER, OUTER, WIDTH, at_rest, rolling, wheel};
use libtest_mimic::{Arguments, Failed, Trial};

type Check = fn(&mut Renderer);

const CHECKS: [(&str, Check); 12] = [
    ("a_picture_has_the_size_asked_for", size),
    ("the_silhouette_is_where_the_camera_says", silhouette),
    ("a_view_shows_the_axes_it_names", views),
    ("an_element_has_the_colour_of_its_value", element_colour),
    ("a_node_field_is_interpolated_over_a_facet", node_colour),
    ("fields_and_views_give_different_pictures", differences),
    ("a_picture_drawn_again_is_the_same_to_the_byte", determinism),
    ("a_footprint_colours_the_nodes_by_normal_force", footprint_colours),
    ("slipping_nodes_are_told_from_sticking_ones", slip_symbols),
    ("nothing_in_contact_is_drawn_too", no_contact),
    ("any_scale_gives_the_same_picture", any_scale),
    ("data_that_do_not_fit_are_errors", errors),
];

fn main() {
    let arguments = Arguments::from_args();
    let renderer = match Renderer::new() {
        Ok(renderer) => Some(renderer),
        Err(Error::NoAdapter { .. }) => None,
        Err(error) => panic!("{error}"),
    };
    let missing = renderer.is_none();
    let renderer = Arc::new(Mutex::new(renderer));
    let trial = |name: &str, check: Check| {
        let renderer = Arc::clone(&renderer);
        let run = move || -> Result<(), Failed> {
            // A trial that panicked leaves nothing half done in the renderer.
            let mut renderer = renderer.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            check(renderer.as_mut().ok_or("no adapter")?);
            Ok(())
        };
        Trial::test(name, run).with_ignored_flag(missing)
    };
    let mut trials: Vec<Trial> = CHECKS.iter().map(|(name, check)| trial(name, *check)).collect();
    // Needs no adapter.
    trials.push(Trial::test("ticks_are_round_and_carry_si_prefixes", || {
        ticks();
        Ok(())
    }));
    if std::env::var_os("HEXROLL_TEST_PICTURES").is_some() {
        trials.push(trial("gallery", gallery::gallery));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// Small pictures: the tests look at places, not at print quality.
fn small() -> BodyView {
    BodyView { size: [800, 450], ..BodyView::default() }
}

fn at(picture: &RgbaImage, [x, y]: [f64; 2]) -> [u8; 3] {
    let [r, g, b, _] = picture.get_pixel(x as u32, y as u32).0;
    [r, g, b]
}

fn apart(a: [u8; 3], b: [u8; 3]) -> i32 {
    (0..3).map(|c| (i32::from(a[c]) - i32::from(b[c])).abs()).max().unwrap_or(0)
}

const WHITE: [u8; 3] = [255; 3];

// ---------------------------------------------------------------------------------------------- checks

fn size(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let snapshot = rolling(&mesh, 1.0);
    // 801: rows that the device has to pad.
    for size in [[1600, 900], [801, 451], [450, 800]] {
        let body = renderer.body(&mesh, &snapshot, &BodyView { size, ..BodyView::default() }).unwrap();
        let view = FootprintView { size, ..FootprintView::default() };
        let footprint = renderer.footprint(&mesh, &snapshot, &view).unwrap();
        for picture in [body, footprint] {
            assert_eq!([picture.width(), picture.height()], size);
            assert!(picture.pixels().all(|p| p.0[3] == 255), "a picture is opaque");
        }
    }
}

/// Side view, no road: a circle of the outer radius about the projected axle, a hole of the inner radius.
fn silhouette(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let snapshot = Snapshot { axle: None, ..at_rest(&mesh) };
    let options = BodyView { view: View::Side, road: None, edges: false, ..small() };
    let picture = renderer.body(&mesh, &snapshot, &options).unwrap();
    let camera = renderer.body_camera(&mesh, &snapshot, &options).unwrap();
    let centre = camera.project(mesh.axle);
    let per_metre = camera.pixels_per_metre();
    // The polygon of 44 sides lies within 0.26 % of the circle; 3 % leaves room for a pixel.
    for (radius, is_body) in
        [(0.97 * INNER, false), (1.03 * INNER, true), (0.96 * OUTER, true), (1.03 * OUTER, false)]
    {
        for step in 0..16 {
            let (sin, cos) = (step as f64 * std::f64::consts::TAU / 16.0).sin_cos();
            let pixel = [centre[0] + radius * per_metre * cos, centre[1] + radius * per_metre * sin];
            let seen = at(&picture, pixel);
            assert_eq!(apart(seen, WHITE) > 20, is_body, "{seen:?} at {radius} m, direction {step}");
        }
    }
}

/// Each view has the axes its documentation names, and one unit of length everywhere.
fn views(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let snapshot = at_rest(&mesh);
    let camera = |view| -> Camera {
        renderer.body_camera(&mesh, &snapshot, &BodyView { view, road: None, ..small() }).unwrap()
    };
    let (x, y, z) = ([1., 0., 0.], [0., 1., 0.], [0., 0., 1.]);
    let minus_y = [0., -1., 0.];
    let cases = [
        (View::Front, y, z),
        (View::Behind, minus_y, z),
        (View::Side, x, z),
        (View::Below, x, minus_y),
        (View::Angles { azimuth: -90.0, elevation: 90.0 }, x, y),
    ];
    for (view, right, up) in cases {
        let camera = camera(view);
        let origin = camera.project(mesh.axle);
        let length = 0.01;
        for (axis, pixels) in [(right, [1.0, 0.0]), (up, [0.0, -1.0])] {
            let point = std::array::from_fn(|d| mesh.axle[d] + length * axis[d]);
            let seen = camera.project(point);
            for d in 0..2 {
                let expected = pixels[d] * length * camera.pixels_per_metre();
                // Pixels of a projection in f64.
                assert!((seen[d] - origin[d] - expected).abs() < 1e-6, "{view:?} {axis:?}: {seen:?}");
            }
        }
    }
}

/// One element is hotter than the others: its facet shows the map's colour for its value, unshaded.
fn element_colour(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    for (field, map) in [
        (Field::Pressure, ColourMap::Viridis),
        (Field::VonMises, ColourMap::Cividis),
        (Field::VolumeRatio, ColourMap::Viridis),
    ] {
        for value in [0.25, 0.5, 1.0] {
            let mut snapshot = at_rest(&mesh);
            let (facet, element) = side_facet(&mesh);
            // The other fields are hot elsewhere: only the one asked for may show.
            for values in [&mut snapshot.pressure, &mut snapshot.von_mises, &mut snapshot.volume_ratio] {
                values.fill(0.7);
            }
            let values = match field {
                Field::Pressure => &mut snapshot.pressure,
                Field::VonMises => &mut snapshot.von_mises,
                _ => &mut snapshot.volume_ratio,
            };
            values.fill(0.0);
            values[element] = value;
            let options = BodyView {
                field,
                map,
                view: View::Side,
                range: Range::Fixed(0.0, 1.0),
                shading: 0.0,
                edges: false,
                ..small()
            };
            let picture = renderer.body(&mesh, &snapshot, &options).unwrap();
            let camera = renderer.body_camera(&mesh, &snapshot, &options).unwrap();
            let seen = at(&picture, camera.project(middle(&snapshot, facet)));
            // 8-bit texels, interpolated and encoded once more: two steps.
            assert!(apart(seen, map.at(value)) <= 2, "{field:?} {value}: {seen:?}, {:?}", map.at(value));
            let (other, _) = side_facet_beside(&mesh, element);
            let cold = at(&picture, camera.project(middle(&snapshot, other)));
            assert!(apart(cold, map.at(0.0)) <= 2, "{field:?}: a neighbour is cold, {cold:?}");
        }
    }
}

/// |u| grows linearly: in the middle of a facet it is the mean of its corners'.
fn node_colour(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let mut snapshot = at_rest(&mesh);
    for v in snapshot.v.iter_mut().zip(&mesh.nodes) {
        *v.0 = [0.0, v.1[2], 0.0];
    }
    let top = 2.0 * OUTER;
    let options = BodyView {
        field: Field::Velocity,
        view: View::Side,
        range: Range::Fixed(0.0, top),
        shading: 0.0,
        edges: false,
        ..small()
    };
    let picture = renderer.body(&mesh, &snapshot, &options).unwrap();
    let camera = renderer.body_camera(&mesh, &snapshot, &options).unwrap();
    for radius in [0.6, 0.75, 0.9] {
        for degrees in [17.0_f64, 80.0, 200.0, 300.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let z = OUTER + radius * OUTER * sin;
            let pixel = camera.project([radius * OUTER * cos, -0.5 * WIDTH, z]);
            let (seen, expected) = (at(&picture, pixel), ColourMap::Viridis.at(z / top));
            // A pixel is 0.2 mm high, a third of a per cent of the map, or about 2 of 255 steps.
            assert!(apart(seen, expected) <= 5, "radius {radius}, {degrees} deg: {seen:?} {expected:?}");
        }
    }
}

/// A facet on the side at y = -width/2 and its element, half way up the tread.
fn side_facet(mesh: &Mesh) -> ([u32; 4], usize) {
    let facets = side_facets(mesh);
    facets[facets.len() / 2]
}

fn side_facet_beside(mesh: &Mesh, element: usize) -> ([u32; 4], usize) {
    let facets = side_facets(mesh);
    let own = facets.iter().position(|f| f.1 == element).unwrap();
    facets[own + 1]
}

/// All facets at y = -width/2 with the element that owns each of them: the one that has its four nodes.
fn side_facets(mesh: &Mesh) -> Vec<([u32; 4], usize)> {
    let side = |f: &&[u32; 4]| f.iter().all(|&n| (mesh.nodes[n as usize][1] + 0.5 * WIDTH).abs() < 1e-9);
    let owner = |f: &[u32; 4]| mesh.hexes.iter().position(|hex| f.iter().all(|n| hex.contains(n))).unwrap();
    mesh.facets.iter().filter(side).map(|f| (*f, owner(f))).collect()
}

fn middle(snapshot: &Snapshot, facet: [u32; 4]) -> [f64; 3] {
    std::array::from_fn(|d| facet.iter().map(|&n| snapshot.x[n as usize][d]).sum::<f64>() / 4.0)
}

fn differences(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let snapshot = rolling(&mesh, 1.0);
    let fields = [
        Field::Displacement,
        Field::Velocity,
        Field::ContactForce,
        Field::Pressure,
        Field::VolumeRatio,
        Field::VonMises,
        Field::FrictionEnergy,
    ];
    let mut options: Vec<BodyView> = fields.iter().map(|&field| BodyView { field, ..small() }).collect();
    options.extend(
        [View::Front, View::Side, View::Behind, View::Below].map(|view| BodyView { view, ..small() }),
    );
    options.push(BodyView { projection: Projection::Perspective { angle: 30.0 }, ..small() });
    options.push(BodyView { map: ColourMap::Cividis, ..small() });
    options.push(BodyView { road: None, ..small() });
    options.push(BodyView { title: Some("A title".into()), ..small() });
    let pictures: Vec<RgbaImage> =
        options.iter().map(|o| renderer.body(&mesh, &snapshot, o).unwrap()).collect();
    for a in 0..pictures.len() {
        for b in 0..a {
            let changed = pictures[a].pixels().zip(pictures[b].pixels()).filter(|(p, q)| p != q).count();
            assert!(changed > 500, "{:?} and {:?} differ in {changed} pixels", options[a], options[b]);
        }
    }
}

fn determinism(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let snapshot = rolling(&mesh, 1.0);
    let mut other = Renderer::new().unwrap();
    for style in [FootprintStyle::Flat, FootprintStyle::Arrows { view: View::Iso }] {
        let view = FootprintView { size: [800, 450], style, ..FootprintView::default() };
        let first = renderer.footprint(&mesh, &snapshot, &view).unwrap();
        assert_eq!(first, renderer.footprint(&mesh, &snapshot, &view).unwrap());
        assert_eq!(first, other.footprint(&mesh, &snapshot, &view).unwrap());
    }
    let first = renderer.body(&mesh, &snapshot, &small()).unwrap();
    assert_eq!(first, renderer.body(&mesh, &snapshot, &small()).unwrap());
    assert_eq!(first, other.body(&mesh, &snapshot, &small()).unwrap());
}

/// Every touching node's colour is in the picture, and the range decides which it is.
fn footprint_colours(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let mut snapshot = rolling(&mesh, 1.0);
    for contact in &mut snapshot.contact {
        // No shear: no arrows over the discs.
        contact.force = [0.0, 0.0, contact.force[2]];
    }
    let count = |picture: &RgbaImage, colour: [u8; 3]| {
        // Left of the legend.
        let plot = picture.enumerate_pixels().filter(|(x, _, _)| *x < 1100);
        plot.filter(|(_, _, p)| apart([p.0[0], p.0[1], p.0[2]], colour) <= 1).count()
    };
    for colour in [FootprintColour::Force, FootprintColour::Pressure] {
        let value = |c: &ContactNode| match colour {
            FootprintColour::Force => c.force[2],
            FootprintColour::Pressure => c.pressure,
        };
        let highest = snapshot.contact.iter().map(value).fold(0.0, f64::max);
        for top in [highest, 2.0 * highest] {
            let range = Range::Fixed(0.0, top);
            let view = FootprintView { colour, range, ..FootprintView::default() };
            let picture = renderer.footprint(&mesh, &snapshot, &view).unwrap();
            for contact in snapshot.contact.iter().filter(|c| c.state != ContactState::Free) {
                let expected = view.map.at(value(contact) / top);
                assert!(count(&picture, expected) > 50, "{colour:?} {top}: no {expected:?}");
            }
        }
    }
}

/// The slip colour stands in the plot exactly when a node slips, in both styles.
fn slip_symbols(renderer: &mut Renderer) {
    const VERMILION: [u8; 3] = [213, 94, 0];
    let mesh = wheel(1.0);
    let mut snapshot = rolling(&mesh, 1.0);
    let slipping = |picture: &RgbaImage| {
        let pixels = picture.pixels().map(|p| [p.0[0], p.0[1], p.0[2]]);
        // Hue survives the shading of the arrows in space: red to green stands as in the colour.
        pixels
            .filter(|p| p[2] < 20 && p[0] > 120 && (p[0] as f64 * 94.0 / 213.0 - p[1] as f64).abs() < 12.0)
            .count()
    };
    for style in [FootprintStyle::Flat, FootprintStyle::Arrows { view: View::Iso }] {
        let view = FootprintView { style, map: ColourMap::Viridis, ..FootprintView::default() };
        let with = slipping(&renderer.footprint(&mesh, &snapshot, &view).unwrap());
        let states: Vec<ContactState> = snapshot.contact.iter().map(|c| c.state).collect();
        for contact in snapshot.contact.iter_mut().filter(|c| c.state == ContactState::Slip) {
            contact.state = ContactState::Stick;
        }
        let without = slipping(&renderer.footprint(&mesh, &snapshot, &view).unwrap());
        assert!(with > 300 && without == 0, "{style:?}: {with} and {without} pixels of {VERMILION:?}");
        for (contact, state) in snapshot.contact.iter_mut().zip(states) {
            contact.state = state;
        }
    }
}

fn ticks() {
    let labels = |values: &[f64], unit, range, from_zero| {
        let scale = Scale::new(values, unit, range, from_zero);
        (scale.ticks.iter().map(|t| t.1.clone()).collect::<Vec<_>>().join(" "), scale.unit, scale.beyond)
    };
    let auto = Range::Auto;
    let cases = [
        (vec![0.13e6, 2.6e6], "Pa", auto, true, "0.0 0.5 1.0 1.5 2.0 2.5 3.0", "MPa"),
        (
            vec![-0.13e6, 0.2e6],
            "Pa",
            auto,
            false,
            "\u{2212}150 \u{2212}100 \u{2212}50 0 50 100 150 200",
            "kPa",
        ),
        (vec![0.0, 2.2e-3], "m", auto, true, "0.0 0.5 1.0 1.5 2.0 2.5", "mm"),
        (vec![0.9881, 1.0003], "", auto, false, "0.988 0.990 0.992 0.994 0.996 0.998 1.000 1.002", ""),
        (vec![3.0, f64::NAN], "N", Range::Fixed(0.0, 2.0), true, "0.0 0.5 1.0 1.5 2.0", "N"),
        (vec![5.0; 9], "m/s", auto, false, "4.94 4.96 4.98 5.00 5.02 5.04 5.06", "m/s"),
        (vec![], "N", auto, true, "0.0 0.2 0.4 0.6 0.8 1.0", "N"),
    ];
    for (values, unit, range, from_zero, expected, prefixed) in cases {
        let (labels, got, beyond) = labels(&values, unit, range, from_zero);
        assert_eq!((labels.as_str(), got.as_str()), (expected, prefixed), "{values:?} {unit}");
        assert_eq!(beyond, [false, range != auto], "{values:?} lie beyond the ends");
    }
}

fn no_contact(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let free = at_rest(&mesh);
    let touching = rolling(&mesh, 1.0);
    for style in [FootprintStyle::Flat, FootprintStyle::Arrows { view: View::Iso }] {
        let view = FootprintView { size: [800, 450], style, ..FootprintView::default() };
        let empty = renderer.footprint(&mesh, &free, &view).unwrap();
        assert!(empty.pixels().any(|p| p.0[0] < 200), "the body and a note are there");
        assert_ne!(empty, renderer.footprint(&mesh, &touching, &view).unwrap());
    }
    renderer.body(&mesh, &free, &BodyView { field: Field::ContactForce, ..small() }).unwrap();
}

/// A wheel ten times as large, and one far from the origin, are drawn the same but for their numbers.
fn any_scale(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let options = BodyView { range: Range::Fixed(0.0, 1e6), ..small() };
    let here = renderer.body(&mesh, &rolling(&mesh, 1.0), &options).unwrap();
    let large = wheel(10.0);
    let there = renderer.body(&large, &rolling(&large, 10.0), &options).unwrap();
    let same_middle = |a: &RgbaImage, b: &RgbaImage| {
        let inside = |x: u32, y: u32| (60..600).contains(&x) && (60..390).contains(&y);
        let pairs = a.enumerate_pixels().filter(|(x, y, _)| inside(*x, *y));
        pairs.filter(|(x, y, p)| apart([p.0[0], p.0[1], p.0[2]], at(b, [*x as f64, *y as f64])) > 24).count()
    };
    // Rounding moves an edge by a fraction of a pixel here and there: 1 % of 180,000 pixels.
    assert!(same_middle(&here, &there) < 1800, "{}", same_middle(&here, &there));

    let block = Mesh::generate(&MeshSpec::Block { size: [1.0, 0.4, 0.5], elements: [8, 3, 4] })
        .moved([1000.0, 0.0, 0.0]);
    let mut snapshot = at_rest(&block);
    snapshot.axle = None;
    let options = BodyView { view: View::Side, ..small() };
    let picture = renderer.body(&block, &snapshot, &options).unwrap();
    let camera = renderer.body_camera(&block, &snapshot, &options).unwrap();
    for (point, is_body) in
        [([1000.03, 0.0, 0.25], true), ([1000.97, 0.0, 0.25], true), ([999.97, 0.0, 0.25], false)]
    {
        assert_eq!(apart(at(&picture, camera.project(point)), WHITE) > 30, is_body, "{point:?}");
    }
}

fn errors(renderer: &mut Renderer) {
    let mesh = wheel(1.0);
    let good = at_rest(&mesh);
    let mut short = good.clone();
    short.x.pop();
    let mut missing = good.clone();
    missing.von_mises.clear();
    let mut wild = good.clone();
    wild.x[3][1] = f64::NAN;
    for snapshot in [short, missing, wild] {
        let result = renderer.body(&mesh, &snapshot, &small());
        assert!(matches!(result, Err(Error::Picture { .. })));
    }
    for size in [[0, 450], [800, 1_000_000]] {
        let result = renderer.body(&mesh, &good, &BodyView { size, ..BodyView::default() });
        assert!(matches!(result, Err(Error::Picture { .. })));
    }
}
