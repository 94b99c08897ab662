//! One history on its way: what the states of nodes come to at its places, and streams of them towards the grid.

use glam::{DMat3, DVec3};

use super::Ends;
use super::places::{Layout, Place};
use crate::engine::{NodeState, Step, StepContact, Watched};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::mesh::Mesh;
use crate::physics::rim::{self, Coordinates};
use crate::physics::tensor::{dot, sub};
use crate::record::{History, Values};
use crate::scene::history::{Format, Places, Quantity};
use crate::scene::{Road, Scene};
use crate::signal::resample::Resampler;

/// Where the rim is in a step: at its end, and in its middle.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    pub end: Coordinates,
    pub middle: Coordinates,
}

/// A quantity's samples on their way to the grid, and what has come of them.
#[derive(Debug)]
struct Stream {
    quantity: Quantity,
    samples: Resampler,
    out: Vec<f32>,
}

/// One history on its way.
#[derive(Debug)]
pub struct Track {
    name: String,
    /// Where errors say it is.
    key: String,
    file: String,
    formats: Vec<Format>,
    rate: f64,
    layout: Layout,
    /// Of the mesh: reference positions of the watched nodes, and the axle.
    reference: Vec<[f64; 3]>,
    axle: [f64; 3],
    unturned: bool,
    road: Option<Road>,
    /// Number of its first node among the watched ones of the stage.
    pub first: usize,
    streams: Vec<Stream>,
    /// The road's force on the whole body, where there is a road.
    force: Option<(Resampler, Vec<f32>)>,
    /// Number of the grid's next time, once there is a first sample; times so far [s].
    next: Option<u64>,
    times: Vec<f64>,
    /// Velocities before the step, and impulses before it, of the watched nodes.
    velocities: Vec<[f64; 3]>,
    impulses: Vec<[f64; 3]>,
}

impl Track {
    pub fn new(scene: &Scene, model: &Model, number: usize) -> Result<Track> {
        let history = &scene.output.histories[number];
        let layout = Layout::of(scene, model, number)?;
        let places = layout.places.len();
        let stream = |&quantity: &Quantity| Stream {
            quantity,
            samples: Resampler::new(history.rate, places * quantity.components()),
            out: Vec::new(),
        };
        Ok(Track {
            name: history.name.clone(),
            key: format!("output.history.{number}.rate"),
            file: scene.file.display().to_string(),
            formats: history.formats.clone(),
            rate: history.rate,
            reference: layout.nodes.iter().map(|n| model.mesh.nodes[*n as usize]).collect(),
            axle: model.mesh.axle,
            unturned: matches!(history.places, Places::Unturned(_)),
            road: scene.road.clone(),
            first: 0,
            streams: history.quantities.iter().map(stream).collect(),
            force: scene.road.as_ref().map(|_| (Resampler::new(history.rate, 3), Vec::new())),
            next: None,
            times: Vec::new(),
            velocities: Vec::new(),
            impulses: Vec::new(),
            layout,
        })
    }

    pub fn watched(&self, mesh: &Mesh) -> Vec<Watched> {
        self.layout.watched(mesh)
    }

    /// Impulses begin again at zero.
    pub fn forget_impulses(&mut self) {
        self.impulses = vec![[0.0; 3]; self.layout.nodes.len()];
    }

    /// Takes the states after a step, those of the stage's watched nodes.
    pub fn take(
        &mut self,
        step: &Step,
        moment: &Moment,
        states: &[NodeState],
        contact: Option<&StepContact>,
    ) -> Result<()> {
        if step.dt * self.rate > 1.0 {
            return Err(self.too_fast(step.dt));
        }
        let own = &states[self.first..self.first + self.layout.nodes.len()];
        for k in 0..self.streams.len() {
            let quantity = self.streams[k].quantity;
            // The rim's angle at the time that the quantity belongs to.
            let (time, at) = match quantity {
                Quantity::Displacement | Quantity::Position => (step.time + step.dt, &moment.end),
                Quantity::Velocity => (step.time + 0.5 * step.dt, &moment.middle),
                _ => (step.time, &moment.middle),
            };
            if let Some(row) = self.row(quantity, step, at, own) {
                self.streams[k].samples.push(time, row);
            }
        }
        if let (Some((samples, _)), Some(contact)) = (&mut self.force, contact) {
            samples.push(step.time, contact.force.map(|f| f as f32));
        }
        self.velocities = own.iter().map(|s| s.v).collect();
        self.impulses = own.iter().map(|s| s.impulse).collect();
        Ok(())
    }

    fn too_fast(&self, dt: f64) -> Error {
        Error::Scene {
            file: self.file.clone(),
            line: None,
            key: self.key.clone(),
            problem: format!("steps of {dt:.2e} s are longer than the period of {} Hz", self.rate),
            remedy: format!("write a rate of at most {:.0} Hz, or refine the mesh", 0.9 / dt),
        }
    }

    /// A quantity at every place in a step; none where the step before is not known.
    fn row(&self, quantity: Quantity, step: &Step, at: &Coordinates, own: &[NodeState]) -> Option<Vec<f32>> {
        let dtm = step.dtm();
        let of_node: Box<dyn Fn(usize) -> [f64; 3] + '_> = match quantity {
            Quantity::Position => Box::new(|n| own[n].x),
            Quantity::Displacement => {
                let (turn, axle) = self.rigid(at);
                Box::new(move |n| {
                    let arm = DVec3::from(sub(self.reference[n], self.axle));
                    sub(own[n].x, (axle + turn * arm).into())
                })
            }
            Quantity::Velocity => Box::new(|n| own[n].v),
            Quantity::Acceleration => {
                if self.velocities.is_empty() {
                    return None;
                }
                Box::new(move |n| sub(own[n].v, self.velocities[n]).map(|dv| dv / dtm))
            }
            Quantity::ContactForce | Quantity::Pressure => {
                Box::new(move |n| sub(own[n].impulse, self.impulses[n]).map(|i| i / dtm))
            }
        };
        if quantity == Quantity::Pressure {
            let road = self.road.as_ref()?;
            // Of nodes only, whose numbers are those of the places. One without a face has no area and no pressure.
            let pressure = |(n, area): (usize, &f64)| {
                if *area > 0.0 { (dot(of_node(n), road.normal(own[n].x)) / area) as f32 } else { 0.0 }
            };
            return Some(self.layout.areas.iter().enumerate().map(pressure).collect());
        }
        let value = |place: &Place| self.layout.value(place, at[rim::SPIN], &of_node).map(|c| c as f32);
        Some(self.layout.places.iter().flat_map(value).collect())
    }

    /// Rotation and axle of the rigid motion that displacements are taken from: none for what goes with the material.
    fn rigid(&self, at: &Coordinates) -> (DMat3, DVec3) {
        match self.unturned {
            true => (rim::rotation(at), rim::axle(at)),
            false => (DMat3::IDENTITY, self.axle.into()),
        }
    }

    /// Gives what no later step can change.
    pub fn give(&mut self) {
        let rate = self.rate;
        self.start();
        while let Some(k) = self.next {
            let t = k as f64 / rate;
            if !self.resamplers().all(|samples| samples.knows(t)) {
                break;
            }
            self.value(k);
        }
        let before = self.next.map_or(f64::INFINITY, |k| k as f64 / rate);
        self.resamplers_mut().for_each(|samples| samples.forget_before(before));
    }

    /// Finds the grid's first time of a stretch: all quantities have begun.
    fn start(&mut self) {
        if self.next.is_some() {
            return;
        }
        let spans: Option<Vec<[f64; 2]>> = self.resamplers().map(Resampler::span).collect();
        let begun =
            spans.filter(|s| !s.is_empty()).map(|s| s.iter().map(|s| s[0]).fold(f64::NEG_INFINITY, f64::max));
        self.next = begun.map(|t| (t * self.rate - 1e-6).ceil().max(0.0) as u64);
    }

    fn resamplers(&self) -> impl Iterator<Item = &Resampler> {
        self.streams.iter().map(|s| &s.samples).chain(self.force.as_ref().map(|f| &f.0))
    }

    fn resamplers_mut(&mut self) -> impl Iterator<Item = &mut Resampler> {
        self.streams.iter_mut().map(|s| &mut s.samples).chain(self.force.as_mut().map(|f| &mut f.0))
    }

    /// Puts down the values at time number `k` of the grid.
    fn value(&mut self, k: u64) {
        let t = k as f64 / self.rate;
        self.streams.iter_mut().for_each(|s| s.out.extend(s.samples.value(t)));
        self.force.iter_mut().for_each(|(samples, out)| out.extend(samples.value(t)));
        self.times.push(t);
        self.next = Some(k + 1);
    }

    /// Ends a stretch of steps: gives the rest, and begins anew.
    pub fn end(&mut self) {
        self.start();
        let spans: Option<Vec<[f64; 2]>> = self.resamplers().map(Resampler::span).collect();
        let last = spans.into_iter().flatten().map(|s| s[1]).fold(f64::INFINITY, f64::min);
        while let Some(k) = self.next.filter(|k| *k as f64 / self.rate <= last && last.is_finite()) {
            self.value(k);
        }
        self.next = None;
        self.velocities.clear();
        let rate = self.rate;
        for stream in &mut self.streams {
            stream.samples = Resampler::new(rate, self.layout.places.len() * stream.quantity.components());
        }
        self.force.iter_mut().for_each(|force| force.0 = Resampler::new(rate, 3));
    }

    /// What has been taken down.
    pub fn finish(&mut self) -> History {
        self.end();
        let Layout { named, positions, normals, areas, faces, .. } = self.layout.clone();
        let values = |stream: &mut Stream| Values {
            name: stream.quantity.name(),
            unit: stream.quantity.unit(),
            components: stream.quantity.components(),
            values: std::mem::take(&mut stream.out),
        };
        History {
            name: self.name.clone(),
            rate: self.rate,
            turning: !self.unturned,
            nodes: named,
            positions,
            normals,
            areas,
            faces,
            times: std::mem::take(&mut self.times),
            values: self.streams.iter_mut().map(values).collect(),
            road_force: self.force.as_mut().map(|(_, out)| std::mem::take(out)),
            formats: self.formats.clone(),
        }
    }
}

/// Where the rim is in every step of a stretch: where the plan says, and in between the ends, by a cubic, where a component is
/// free and only the ends are known.
pub fn moments(steps: &[Step], ends: &Ends) -> Vec<Moment> {
    let length = ends.end - ends.start;
    let cubic = |c: usize, t: f64| {
        let s = ((t - ends.start) / length).clamp(0.0, 1.0);
        let [a, b] = [ends.at[0][c], ends.at[1][c]];
        let [da, db] = [ends.rate[0][c] * length, ends.rate[1][c] * length];
        let (s2, s3) = (s * s, s * s * s);
        (2.0 * s3 - 3.0 * s2 + 1.0) * a
            + (s3 - 2.0 * s2 + s) * da
            + (3.0 * s2 - 2.0 * s3) * b
            + (s3 - s2) * db
    };
    let mut before = ends.at[0];
    let moment = |step: &Step| {
        let end: Coordinates =
            std::array::from_fn(|c| if ends.free[c] { cubic(c, step.time + step.dt) } else { step.rim[c] });
        let middle = std::array::from_fn(|c| 0.5 * (before[c] + end[c]));
        before = end;
        Moment { end, middle }
    };
    steps.iter().map(moment).collect()
}
