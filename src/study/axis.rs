//! What is varied from run to run: `KEY=VALUES`.
//!
//! | key | values | changes |
//! |---|---|---|
//! | `refine` | whole numbers | the generator's element counts, multiplied |
//! | `dt-safety` | numbers | `time_step.safety` |
//! | `precision` | `f64`, `f32`, `f32+` | the engine's arithmetic |
//! | `slip-angle` | degrees | direction of the rim's velocity to its heading, at its speed, in every stage that has one |
//! | `load` | newtons, downwards | the vertical force of every stage whose rim is free to move vertically |
//! | `deflection` | millimetres, downwards | the vertical displacement of every stage that has one |
//! | `slip` | numbers | the longitudinal slip of every stage that has one |
//! | a key of the scene | values as in a scene | that key, as `--set` does |
//!
//! Values are a list `a,b,c` or a range `from:to:count`; behind a range a unit may stand: `2:3:5 m/s`.

use crate::scene::{Drive, Scene};
use crate::{Error, Precision, Result};

/// An axis of a study or a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    pub key: String,
    pub values: Vec<Value>,
}

/// A value as it was written, and as a number where it is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    pub text: String,
    pub number: Option<f64>,
}

/// What a value changes: entries of the scene, or the precision.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Changes {
    /// As `--set` takes them.
    pub sets: Vec<String>,
    pub precision: Option<Precision>,
}

impl Axis {
    /// Reads `KEY=VALUES`; an error says what would be right.
    pub fn parse(text: &str) -> std::result::Result<Axis, String> {
        let example = "write KEY=VALUES, e.g. slip-angle=-10:10:9 or load=200,300,400";
        let (key, values) = text.split_once('=').ok_or_else(|| format!("no `=`; {example}"))?;
        let (key, values) = (key.trim(), values.trim());
        if key.is_empty() || values.is_empty() {
            return Err(format!("{text:?} has no key or no values; {example}"));
        }
        let values = match range(values)? {
            Some(values) => values,
            None => values.split(',').map(|v| Value::new(v.trim())).collect(),
        };
        if let Some(again) = (1..values.len()).find(|&i| values[..i].contains(&values[i])) {
            return Err(format!("{key}: {} is there twice", values[again].text));
        }
        Ok(Axis { key: key.into(), values })
    }

    /// An axis of numbers.
    pub fn of_numbers(key: &str, numbers: &[f64]) -> Axis {
        Axis { key: key.into(), values: numbers.iter().map(|n| Value::new(&n.to_string())).collect() }
    }

    /// Relative size of the discretisation at a value, for axes that refine one.
    pub fn size(&self, value: &Value) -> Option<f64> {
        match self.key.as_str() {
            "refine" => value.number.map(|n| 1.0 / n),
            "dt-safety" => value.number,
            _ => None,
        }
    }

    /// What the axis is called in tables and plots.
    pub fn label(&self) -> String {
        let unit = match self.key.as_str() {
            "slip-angle" => " [deg]",
            "load" => " [N]",
            "deflection" => " [mm]",
            _ => "",
        };
        format!("{}{unit}", self.key.replace('-', " "))
    }

    /// What a value changes in `scene`. In one piece: an arm for each key.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene has nothing that the key could change, or the value is not one.
    pub fn changes(&self, value: &Value, scene: &Scene) -> Result<Changes> {
        let fail = |problem: &str, remedy: &str| Error::Scene {
            file: scene.file.display().to_string(),
            line: None,
            key: format!("--over {}={}", self.key, value.text),
            problem: problem.into(),
            remedy: remedy.into(),
        };
        let number = || value.number.ok_or_else(|| fail("not a number", "write a plain number"));
        let one = |set: String| Changes { sets: vec![set], precision: None };
        let many = |sets: Vec<String>, problem: &str, remedy: &str| {
            if sets.is_empty() { Err(fail(problem, remedy)) } else { Ok(Changes { sets, precision: None }) }
        };
        match self.key.as_str() {
            "precision" => {
                let precision = value.text.parse().map_err(|_| {
                    fail(
                        "no such precision",
                        &format!("write {}", Precision::ALL.map(Precision::name).join(", ")),
                    )
                })?;
                Ok(Changes { sets: Vec::new(), precision: Some(precision) })
            }
            "dt-safety" => Ok(one(format!("time_step.safety={}", number()?))),
            "refine" => {
                let factor = number()?;
                if factor < 1.0 || factor.fract() != 0.0 {
                    return Err(fail("not a whole number of 1 or more", "write e.g. --refine 1,2,3"));
                }
                let refined = refined(scene, factor as usize).ok_or_else(|| {
                    fail(
                        "the mesh comes from a file",
                        "mesh it finer in the program that made it, a scene a mesh",
                    )
                })?;
                Ok(one(refined))
            }
            "slip-angle" => many(
                slip_angle(scene, number()?.to_radians()),
                "no stage moves its rim with a velocity",
                "write x = { velocity = .. } in [stage.rim]",
            ),
            "load" => many(
                in_stages(scene, |drive| matches!(drive, Drive::Free { .. }), "force", -number()?, "N"),
                "no stage has a rim that is free to move vertically",
                "write z = { force = .., mass = .. } in [stage.rim], or sweep over deflection",
            ),
            "deflection" => many(
                in_stages(
                    scene,
                    |drive| matches!(drive, Drive::Displacement { .. }),
                    "displacement",
                    -number()?,
                    "mm",
                ),
                "no stage displaces its rim vertically",
                "write z = { displacement = .. } in [stage.rim], or sweep over load",
            ),
            "slip" => {
                let kappa = number()?;
                let slips = scene.stages.iter().enumerate().filter(|(_, s)| s.slip.is_some());
                many(
                    slips.map(|(k, _)| format!("stage.{k}.rim.spin.slip={}", literal(kappa))).collect(),
                    "no stage has a longitudinal slip",
                    "write spin = { slip = .., free_radius = .. } in [stage.rim]",
                )
            }
            key => Ok(one(format!("{key}={}", value.text))),
        }
    }
}

impl Value {
    fn new(text: &str) -> Value {
        Value { text: text.into(), number: text.parse().ok() }
    }
}

/// `from:to:count`, maybe with a unit behind.
fn range(text: &str) -> std::result::Result<Option<Vec<Value>>, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, rest] = parts[..] else {
        return if parts.len() == 1 {
            Ok(None)
        } else {
            Err(format!("{text:?} is no range; write from:to:count, e.g. -10:10:9"))
        };
    };
    let (count, unit) = rest.trim().split_once(' ').unwrap_or((rest.trim(), ""));
    let end = |text: &str| text.trim().parse::<f64>().map_err(|_| format!("{text:?} is not a number"));
    let (from, to) = (end(from)?, end(to)?);
    let count: usize = count.parse().map_err(|_| format!("{count:?} is not a number of values"))?;
    if count < 2 || from == to {
        return Err(format!("{text:?} is no range; give two ends that differ and two values or more"));
    }
    let at = |i: usize| {
        let share = i as f64 / (count - 1) as f64;
        // Decimal fractions stay what they look like.
        let value = from + share * (to - from);
        (value * 1e12).round() / 1e12
    };
    let value = |i: usize| match unit {
        "" => Value::new(&at(i).to_string()),
        unit => Value { text: format!("{} {unit}", at(i)), number: Some(at(i)) },
    };
    Ok(Some((0..count).map(value).collect()))
}

/// The generator's counts times `factor`; none of a mesh from a file.
fn refined(scene: &Scene, factor: usize) -> Option<String> {
    let [a, b, c] = scene.body.mesh.elements()?.map(|n| n * factor);
    Some(format!("body.mesh.elements=[{a}, {b}, {c}]"))
}

/// A number as TOML reads it: with a point, or an exponent.
fn literal(number: f64) -> String {
    format!("{number:?}")
}

/// Turns every stage's velocity in the road to `angle` from the heading [rad], at its speed.
fn slip_angle(scene: &Scene, angle: f64) -> Vec<String> {
    let mut steer = 0.0;
    let mut sets = Vec::new();
    for (k, stage) in scene.stages.iter().enumerate() {
        if let Drive::Displacement { to, .. } = stage.rim.steer {
            steer = to;
        }
        let rate = |drive| match drive {
            Drive::Velocity { to, .. } => Some(to),
            _ => None,
        };
        let (x, y) = (rate(stage.rim.x), rate(stage.rim.y));
        if x.is_some() || y.is_some() {
            let speed = x.unwrap_or(0.0).hypot(y.unwrap_or(0.0));
            let (sin, cos) = (steer + angle).sin_cos();
            sets.push(format!("stage.{k}.rim.x.velocity={:e} m/s", speed * cos));
            sets.push(format!("stage.{k}.rim.y.velocity={:e} m/s", speed * sin));
        }
    }
    sets
}

/// Sets the vertical drive of every stage of one kind.
fn in_stages(scene: &Scene, is: impl Fn(&Drive) -> bool, key: &str, value: f64, unit: &str) -> Vec<String> {
    let stages = scene.stages.iter().enumerate().filter(|(_, stage)| is(&stage.rim.z));
    stages.map(|(k, _)| format!("stage.{k}.rim.z.{key}={value:e} {unit}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &str) -> Vec<String> {
        Axis::parse(axis).unwrap().values.into_iter().map(|v| v.text).collect()
    }

    #[test]
    fn lists_and_ranges_are_read() {
        assert_eq!(texts("load=200,300, 400"), ["200", "300", "400"]);
        assert_eq!(texts("slip-angle=-10:10:9"), ["-10", "-7.5", "-5", "-2.5", "0", "2.5", "5", "7.5", "10"]);
        assert_eq!(texts("stage.1.rim.x.velocity=2:3:3 m/s"), ["2 m/s", "2.5 m/s", "3 m/s"]);
        assert_eq!(texts("friction.coefficient=0.1:0.3:3"), ["0.1", "0.2", "0.3"]);
        assert_eq!(Axis::parse("a=1:2:3 m/s").unwrap().values[1].number, Some(1.5));
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, part) in [
            ("load", "no `=`"),
            ("load=", "no key or no values"),
            ("load=1:2", "is no range"),
            ("load=1:2:1", "two values or more"),
            ("load=a:2:3", "\"a\" is not a number"),
            ("load=1,1", "there twice"),
        ] {
            let problem = Axis::parse(text).unwrap_err();
            assert!(problem.contains(part), "{text}: {problem}");
        }
    }

    #[test]
    fn sizes_are_of_what_is_refined() {
        let refine = Axis::parse("refine=1,2,4").unwrap();
        assert_eq!(refine.size(&refine.values[2]), Some(0.25));
        let safety = Axis::parse("dt-safety=0.9,0.45").unwrap();
        assert_eq!(safety.size(&safety.values[1]), Some(0.45));
        let load = Axis::parse("load=1,2").unwrap();
        assert_eq!(load.size(&load.values[0]), None);
    }
}
