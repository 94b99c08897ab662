//! The footprint: area, extents and pressure of the nodes that touch.
//!
//! A node's area is that of the deformed facets beside it at the end of a window, so a window must not be so long that the node
//! has rolled out of the print by then. The run takes long windows in parts ([`part`]), and the figures of a
//! window are means over its parts.

use std::f64::consts::TAU;

use crate::engine::{SurfaceSum, Window};
use crate::model::Model;
use crate::model::areas::{contact_areas, extents, road_axes};
use crate::physics::tensor::dot;
use crate::record::Sample;
use crate::scene::Road;

/// Figures of a window, summed over its parts, weighted with their lengths.
#[derive(Debug, Clone, Default)]
pub struct Footprint {
    length: f64,
    area: f64,
    extents: [f64; 2],
    peak: f64,
}

impl Footprint {
    /// Of a window that is taken whole; `length`: time over which its forces acted [s].
    pub fn of(model: &Model, road: Option<&Road>, length: f64, w: &Window) -> Footprint {
        let mut footprint = Footprint::default();
        footprint.add(model, road, length, w);
        footprint
    }

    pub fn add(&mut self, model: &Model, road: Option<&Road>, length: f64, w: &Window) {
        self.length += length;
        let Some(road) = road else { return };
        if w.surface.iter().all(|s| s.touching == 0) {
            return;
        }
        let at = |n: u32| match model.mesh.surface.binary_search(&n) {
            Ok(k) => w.surface[k].x,
            // A rim node: no road contact, and only the corner of a facet beside one.
            Err(_) => model.mesh.nodes[n as usize],
        };
        let areas = contact_areas(&model.mesh, at, road, |k| w.surface[k].touching > 0);
        let share = |s: &SurfaceSum| f64::from(s.touching) / w.steps as f64;
        let sums = || w.surface.iter().zip(&areas);
        self.area += length * sums().map(|(s, a)| share(s) * a).sum::<f64>();
        let touches = |k: usize| 2 * u64::from(w.surface[k].touching) >= w.steps;
        let found = extents(&model.mesh, at, road, touches, road_axes(road, &w.rim));
        (0..2).for_each(|d| self.extents[d] += length * found[d]);
        // While the node touches, as in the mean pressure: over the whole window a node that touches for a part of
        // it would seem to carry less than it does.
        let pressure = |(s, area): (&SurfaceSum, &f64)| {
            let held = length * share(s) * area;
            if held > 0.0 { dot(s.impulse, road.normal(s.x)) / held } else { 0.0 }
        };
        self.peak += length * sums().map(pressure).fold(0.0, f64::max);
    }

    /// A row with the figures, and nothing else in it.
    pub fn row(&self) -> Sample {
        let mean = |sum: f64| if self.length > 0.0 { sum / self.length } else { 0.0 };
        Sample {
            contact_area_m2: mean(self.area),
            footprint_length_m: mean(self.extents[0]),
            footprint_width_m: mean(self.extents[1]),
            peak_pressure_Pa: mean(self.peak),
            ..Sample::default()
        }
    }
}

/// Longest part of a window of a wheel of `around` elements that spins at `spin` [rad/s]: the time in which it rolls over
/// one of them [s]. A mesh without rows round its axle takes whole windows.
pub fn part(around: Option<usize>, spin: f64) -> f64 {
    around.map_or(f64::INFINITY, |around| TAU / (around as f64 * spin.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// One element on the road; its four lower nodes carry 8 N each while they touch.
    #[test]
    fn the_peak_pressure_is_that_of_the_time_in_contact() {
        let text = r#"
            title = "A cube"
            source = "-"
            expected = "-"
            [body]
            density = "1000 kg/m3"
            [body.mesh]
            generator = "block"
            size = ["2 mm", "2 mm", "2 mm"]
            elements = [1, 1, 1]
            [body.material]
            law = "neo-hookean"
            shear_modulus = "1 MPa"
            bulk_modulus = "10 MPa"
            [road]
            shape = "plane"
            [[stage]]
            name = "fall"
            method = "explicit"
            duration = "1 ms"
            [output]
            sample = "1 ms"
        "#;
        let scene = Scene::parse(text, "cube.toml", &[]).unwrap();
        let model = Model::new(&scene).unwrap();
        let (length, steps) = (1e-3, 100);
        let peak = |touching: [u32; 4]| {
            let mut left = touching.into_iter();
            let node = |&n: &u32| {
                let x = model.mesh.nodes[n as usize];
                let touching = if x[2] == 0.0 { left.next().unwrap() } else { 0 };
                let impulse = [0.0, 0.0, 8.0 * length * f64::from(touching) / steps as f64];
                SurfaceSum { x, impulse, touching, ..SurfaceSum::default() }
            };
            let surface = model.mesh.surface.iter().map(node).collect();
            let window = Window { steps, surface, ..Window::default() };
            let mut footprint = Footprint::default();
            footprint.add(&model, scene.road.as_ref(), length, &window);
            footprint.row().peak_pressure_Pa
        };
        // 8 N on 1 mm2, however long the window is beside the time in contact.
        for touching in [[100; 4], [25; 4], [100, 50, 25, 1]] {
            let found = peak(touching);
            assert!((found - 8e6).abs() < 1e-6 * 8e6, "{found} Pa");
        }
        assert_eq!(peak([0; 4]), 0.0);
    }
}
