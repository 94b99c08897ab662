//! A simulation on its way: what it works with, and where it stands.

use super::chatter::Chatter;
use super::control::StepControl;
use super::histories::Histories;
use super::motion::RimState;
use super::observer::Observer;
use super::pace::Pace;
use super::recorder::Recorder;
use super::round_off::RoundOff;
use super::settle::Settling;
use super::stability;
use super::totals::Totals;
use crate::engine::Engine;
use crate::error::Result;
use crate::model::Model;
use crate::record::rounding_of_energy;
use crate::scene::Scene;

/// Stored energy that cannot change the critical step much, over shear modulus times volume: strains of half a per cent all
/// over, or of a fifth in a thousandth of the volume.
const NEGLIGIBLE: f64 = 1e-5;

/// A simulation on its way. Stages and windows are methods in the files that are about them.
pub struct Run<'a> {
    pub scene: &'a Scene,
    pub model: &'a Model,
    /// Elements round the mesh's circumference, if it has rows of them.
    pub around: Option<usize>,
    pub engine: &'a mut dyn Engine,
    pub observer: &'a mut dyn Observer,
    /// Of this machine, so it is no part of the state.
    pub pace: Pace,
    pub histories: Histories,
    pub state: State,
}

/// Where a simulation stands between two windows: with the engine's state, all that the rest of it depends on. Every
/// part is plain data, so that a checkpoint can hold it.
#[derive(Debug, Clone)]
pub struct State {
    /// Index of the stage.
    pub stage: usize,
    pub totals: Totals,
    pub rim: RimState,
    pub control: StepControl,
    pub recorder: Recorder,
    pub settling: Settling,
}

impl<'a> Run<'a> {
    /// A simulation at rest in the reference shape.
    pub fn new(
        scene: &'a Scene,
        model: &'a Model,
        engine: &'a mut dyn Engine,
        observer: &'a mut dyn Observer,
    ) -> Result<Self> {
        let volume = model.mass.iter().sum::<f64>() / scene.body.density;
        let shear_modulus = scene.body.law.shear_modulus();
        let negligible = NEGLIGIBLE * shear_modulus * volume;
        let rounding = rounding_of_energy(shear_modulus, volume, engine.info().precision.epsilon());
        let round_off = RoundOff::of(scene, model, &engine.info());
        let state = State {
            stage: 0,
            totals: Totals::start(stability::element_bound(model)?, rounding, round_off),
            rim: RimState::at_rest(model.mesh.axle, scene.gravity),
            control: StepControl::new(negligible),
            recorder: Recorder::new(Chatter::new(None, 0.0, 1.0), negligible),
            settling: Settling::default(),
        };
        let around = model.mesh.ring().map(|ring| ring.around);
        let histories = Histories::new(scene, model)?;
        Ok(Run { scene, model, around, engine, observer, pace: Pace::default(), histories, state })
    }
}
