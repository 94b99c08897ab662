//! `[stage.rim]`: how each component of the rim moves.

use crate::error::Result;
use crate::scene::reader::{Bound, Table};
use crate::scene::units::{
    ANGLE, ANGULAR_VELOCITY, Dimension, FORCE, INERTIA, LENGTH, MASS, TIME, TORQUE, VELOCITY,
};
use crate::scene::{Drive, RimMotion, Slip};

/// What a stage allows its ramps and motions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub quasi_static: bool,
    /// [s]
    pub duration: f64,
}

/// A key and the dimension of its value.
type Key = (&'static str, &'static Dimension);

/// The keys of one kind of component.
struct Component {
    position: Key,
    velocity: Key,
    /// Load and inertia of a component that can be free.
    free: Option<(Key, Key)>,
}

const TRANSLATION: Component = Component {
    position: ("displacement", &LENGTH),
    velocity: ("velocity", &VELOCITY),
    free: Some((("force", &FORCE), ("mass", &MASS))),
};
const TILT: Component =
    Component { position: ("angle", &ANGLE), velocity: ("velocity", &ANGULAR_VELOCITY), free: None };
const SPIN: Component = Component { free: Some((("moment", &TORQUE), ("inertia", &INERTIA))), ..TILT };

const COMPONENTS: [(&str, &Component); 6] = [
    ("x", &TRANSLATION),
    ("y", &TRANSLATION),
    ("z", &TRANSLATION),
    ("steer", &TILT),
    ("camber", &TILT),
    ("spin", &SPIN),
];

/// Reads `[stage.rim]`. `place` is where each component stands [m or rad], before the call and after it, as far
/// as it is known: a component that was free or driven by velocity is somewhere. A longitudinal slip comes beside the
/// motion, since the spin it means is known when the stage starts.
pub(super) fn rim_motion(
    stage: &Table,
    has_rim: bool,
    limits: Limits,
    place: &mut [Option<f64>; 6],
) -> Result<(RimMotion, Option<Slip>)> {
    let mut drives = [Drive::Hold; 6];
    let mut slip = None;
    if let Some(item) = stage.get("rim") {
        if !has_rim {
            return Err(item.error("the scene has no rim", "add a section [rim], or remove this one"));
        }
        let table = item.table()?;
        table.only(&COMPONENTS.map(|c| c.0), &[])?;
        for (i, (name, component)) in COMPONENTS.iter().enumerate() {
            let Some(item) = table.get(name) else { continue };
            if *name == "spin" && item.table()?.get("slip").is_some() {
                (slip, place[i]) = (Some(longitudinal_slip(&item.table()?, limits)?), None);
                continue;
            }
            drives[i] = component.read(&item.table()?, limits, place[i])?;
            place[i] = match drives[i] {
                Drive::Hold => place[i],
                Drive::Displacement { to, .. } => Some(to),
                Drive::Velocity { .. } | Drive::Free { .. } => None,
            };
        }
    }
    let [x, y, z, steer, camber, spin] = drives;
    Ok((RimMotion { x, y, z, steer, camber, spin }, slip))
}

fn longitudinal_slip(table: &Table, limits: Limits) -> Result<Slip> {
    table.only(&["slip", "free_radius", "ramp"], &[])?;
    let item = table.at("slip");
    if limits.quasi_static {
        let remedy = "write method = \"explicit\"";
        return Err(item.error("a rim that keeps turning never settles", remedy));
    }
    let radius = table.need("free_radius", "\"measured\"")?;
    let free_radius = match radius.text() {
        Ok("measured") => None,
        _ => Some(radius.quantity(&LENGTH, Bound::Positive)?),
    };
    let ramp = ramp(table, limits)?.unwrap_or(0.0);
    Ok(Slip { kappa: item.number(Bound::Any)?, free_radius, ramp })
}

impl Component {
    fn read(&self, table: &Table, limits: Limits, place: Option<f64>) -> Result<Drive> {
        let given = self.given(table)?;
        if given == self.position.0 || given == self.velocity.0 {
            self.refuse_own(table)?;
        }
        if given == self.position.0 {
            return self.displacement(table, limits, place);
        }
        if given == self.velocity.0 {
            return self.velocity(table, limits);
        }
        let Some((load, mass)) = self.free else {
            let remedy = format!("write {{ {} = .., ramp = .. }} or a velocity", self.position.0);
            return Err(table.item.error("steer and camber cannot be free", remedy));
        };
        table.only(&[load.0, mass.0, "ramp"], &[])?;
        Ok(Drive::Free {
            load: table.quantity(load.0, load.1, Bound::Any)?,
            mass: table.quantity(mass.0, mass.1, Bound::Positive)?,
            ramp: ramp(table, limits)?.unwrap_or(0.0),
        })
    }

    /// Refuses a mass or an inertia where it could change nothing.
    fn refuse_own(&self, table: &Table) -> Result<()> {
        let Some((load, own)) = self.free else { return Ok(()) };
        let Some(item) = table.get(own.0) else { return Ok(()) };
        Err(item.error(
            format!("a motion that is prescribed needs no {}", own.0),
            format!("remove the key, or write {} = .. in place of the motion", load.0),
        ))
    }

    /// The one key that says what drives the component.
    fn given(&self, table: &Table) -> Result<&'static str> {
        let load = self.free.map(|(load, _)| load.0);
        let known: Vec<_> = [self.position.0, self.velocity.0].into_iter().chain(load).collect();
        let with_load = known.iter().chain(if load.is_none() { &["force", "moment"][..] } else { &[] });
        let given: Vec<_> = with_load.copied().filter(|key| table.get(key).is_some()).collect();
        match given[..] {
            [key] => Ok(key),
            ref keys => Err(table.item.error(
                if keys.is_empty() {
                    "no motion".into()
                } else {
                    format!("{} exclude each other", keys.join(" and "))
                },
                format!("write exactly one of {}; a component that is left out holds", known.join(", ")),
            )),
        }
    }

    fn displacement(&self, table: &Table, limits: Limits, place: Option<f64>) -> Result<Drive> {
        let (key, dimension) = self.position;
        table.only(&[key, "ramp"], &[])?;
        let to = table.quantity(key, dimension, Bound::Any)?;
        let stays = place == Some(to);
        let ramp = match ramp(table, limits)? {
            Some(ramp) => ramp,
            None if stays => 0.0,
            None => table.quantity("ramp", &TIME, Bound::Positive)?,
        };
        if ramp == 0.0 && !stays {
            return Err(table
                .at("ramp")
                .error("nothing can be moved at once", "write a ramp greater than zero, e.g. \"20 ms\""));
        }
        Ok(Drive::Displacement { to, ramp })
    }

    fn velocity(&self, table: &Table, limits: Limits) -> Result<Drive> {
        let (key, dimension) = self.velocity;
        table.only(&[key, "ramp"], &[])?;
        let to = table.quantity(key, dimension, Bound::Any)?;
        if limits.quasi_static && to != 0.0 {
            return Err(table.at(key).error(
                "a rim that keeps moving never settles",
                format!("write {} with a ramp, or method = \"explicit\"", self.position.0),
            ));
        }
        Ok(Drive::Velocity { to, ramp: ramp(table, limits)?.unwrap_or(0.0) })
    }
}

/// The ramp [s]. One that outlasts a quasi-static stage would keep it from ever settling; in an explicit stage
/// it is cut by the end of the stage.
fn ramp(table: &Table, limits: Limits) -> Result<Option<f64>> {
    let Some(item) = table.get("ramp") else { return Ok(None) };
    let ramp = item.quantity(&TIME, Bound::NotNegative)?;
    if limits.quasi_static && ramp > limits.duration {
        return Err(item.error(
            format!("{ramp} s is longer than the stage of {} s, which could not settle", limits.duration),
            "write a shorter ramp or a longer duration",
        ));
    }
    Ok(Some(ramp))
}
