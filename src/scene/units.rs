//! Quantities such as `"39 mm"`: a number, a unit of the right dimension, and out comes SI (through `uom`).

/// A physical dimension and the units a scene may write it in.
pub(super) struct Dimension {
    /// "a length": as a message says it.
    pub noun: &'static str,
    /// A quantity that would be right.
    pub example: &'static str,
    /// Spellings and their conversions to SI.
    pub units: &'static [Unit],
}

type Unit = (&'static str, fn(f64) -> f64);

/// `spelling => uom unit`, converted by `uom`'s own quantity type, whose storage is SI.
macro_rules! units {
    ($quantity:ident in $module:ident: $($spelling:literal => $unit:ident),+ $(,)?) => {
        &[$(($spelling, |v| uom::si::f64::$quantity::new::<uom::si::$module::$unit>(v).value)),+]
    };
}

pub(super) static LENGTH: Dimension = Dimension {
    noun: "a length",
    example: "39 mm",
    units: units!(Length in length:
        "m" => meter, "cm" => centimeter, "mm" => millimeter, "um" => micrometer, "km" => kilometer, "in" => inch),
};
pub(super) static TIME: Dimension = Dimension {
    noun: "a time",
    example: "20 ms",
    units: units!(Time in time:
        "s" => second, "ms" => millisecond, "us" => microsecond, "ns" => nanosecond, "min" => minute),
};
pub(super) static MASS: Dimension = Dimension {
    noun: "a mass",
    example: "50 g",
    units: units!(Mass in mass: "kg" => kilogram, "g" => gram, "mg" => milligram, "t" => ton),
};
pub(super) static ANGLE: Dimension = Dimension {
    noun: "an angle",
    example: "45 deg",
    units: units!(Angle in angle: "rad" => radian, "deg" => degree, "rev" => revolution),
};
pub(super) static VELOCITY: Dimension = Dimension {
    noun: "a velocity",
    example: "2.59 m/s",
    units: units!(Velocity in velocity:
        "m/s" => meter_per_second, "mm/s" => millimeter_per_second, "cm/s" => centimeter_per_second,
        "km/h" => kilometer_per_hour),
};
pub(super) static ANGULAR_VELOCITY: Dimension = Dimension {
    noun: "an angular velocity",
    example: "70 rad/s",
    units: units!(AngularVelocity in angular_velocity:
        "rad/s" => radian_per_second, "deg/s" => degree_per_second, "rev/s" => revolution_per_second,
        "rpm" => revolution_per_minute),
};
pub(super) static ACCELERATION: Dimension = Dimension {
    noun: "an acceleration",
    example: "-9.81 m/s2",
    units: units!(Acceleration in acceleration:
        "m/s2" => meter_per_second_squared, "mm/s2" => millimeter_per_second_squared),
};
pub(super) static FORCE: Dimension = Dimension {
    noun: "a force",
    example: "-300 N",
    units: units!(Force in force: "N" => newton, "mN" => millinewton, "kN" => kilonewton, "MN" => meganewton),
};
pub(super) static TORQUE: Dimension = Dimension {
    noun: "a moment",
    example: "4.6 N m",
    units: units!(Torque in torque:
        "N m" => newton_meter, "mN m" => millinewton_meter, "kN m" => kilonewton_meter, "N mm" => newton_millimeter),
};
/// Of the products of mass and area `uom` names one only.
pub(super) static INERTIA: Dimension = Dimension {
    noun: "a moment of inertia",
    example: "1e-5 kg m2",
    units: &[
        ("kg m2", |v| {
            uom::si::f64::MomentOfInertia::new::<uom::si::moment_of_inertia::kilogram_square_meter>(v).value
        }),
        ("kg mm2", |v| {
            (mass_of::<uom::si::mass::kilogram>(v) * area_of::<uom::si::area::square_millimeter>()).value
        }),
        ("g cm2", |v| {
            (mass_of::<uom::si::mass::gram>(v) * area_of::<uom::si::area::square_centimeter>()).value
        }),
    ],
};
pub(super) static DENSITY: Dimension = Dimension {
    noun: "a density",
    example: "1100 kg/m3",
    units: units!(MassDensity in mass_density:
        "kg/m3" => kilogram_per_cubic_meter, "g/cm3" => gram_per_cubic_centimeter, "t/m3" => ton_per_cubic_meter),
};
pub(super) static PRESSURE: Dimension = Dimension {
    noun: "a stress or modulus",
    example: "2.64 MPa",
    units: units!(Pressure in pressure:
        "Pa" => pascal, "kPa" => kilopascal, "MPa" => megapascal, "GPa" => gigapascal, "bar" => bar,
        "N/mm2" => newton_per_square_millimeter),
};
/// One over a modulus.
pub(super) static COMPRESSIBILITY: Dimension = Dimension {
    noun: "a compressibility",
    example: "0.031 1/MPa",
    units: &[("1/Pa", |v| v), ("1/kPa", |v| 1e-3 * v), ("1/MPa", |v| 1e-6 * v), ("1/GPa", |v| 1e-9 * v)],
};
pub(super) static VISCOSITY: Dimension = Dimension {
    noun: "a viscosity",
    example: "20 Pa s",
    units: units!(DynamicViscosity in dynamic_viscosity: "Pa s" => pascal_second, "mPa s" => millipascal_second),
};
/// A friction coefficient per sliding speed.
pub(super) static SLOWNESS: Dimension = Dimension {
    noun: "a slope over speed",
    example: "0.5 s/m",
    units: &[("s/m", |v| v), ("s/mm", |v| 1e3 * v), ("ms/m", |v| 1e-3 * v)],
};
/// Only as 1/s: with Hz nobody could tell whether a factor of 2 pi is meant.
pub(super) static RATE: Dimension = Dimension {
    noun: "a rate",
    example: "3000 1/s",
    units: units!(Frequency in frequency: "1/s" => hertz, "1/ms" => kilohertz),
};

/// Cycles per time.
pub(super) static FREQUENCY: Dimension = Dimension {
    noun: "a frequency",
    example: "100 Hz",
    units: units!(Frequency in frequency: "Hz" => hertz, "kHz" => kilohertz),
};

static ALL: [&Dimension; 17] = [
    &LENGTH,
    &TIME,
    &MASS,
    &ANGLE,
    &VELOCITY,
    &ANGULAR_VELOCITY,
    &ACCELERATION,
    &FORCE,
    &TORQUE,
    &INERTIA,
    &DENSITY,
    &PRESSURE,
    &COMPRESSIBILITY,
    &VISCOSITY,
    &RATE,
    &FREQUENCY,
    &SLOWNESS,
];

fn mass_of<U>(v: f64) -> uom::si::f64::Mass
where
    U: uom::si::mass::Unit + uom::Conversion<f64, T = f64>,
{
    uom::si::f64::Mass::new::<U>(v)
}

fn area_of<U>() -> uom::si::f64::Area
where
    U: uom::si::area::Unit + uom::Conversion<f64, T = f64>,
{
    uom::si::f64::Area::new::<U>(1.0)
}

impl Dimension {
    /// What one of the unit `name` is in SI, if the dimension has it.
    pub fn unit(&self, name: &str) -> Option<f64> {
        self.units.iter().find(|u| u.0 == name).map(|u| (u.1)(1.0))
    }

    /// Spellings of all units.
    pub fn names(&self) -> Vec<&'static str> {
        self.units.iter().map(|u| u.0).collect()
    }

    /// SI value of a text such as `"39 mm"`; otherwise what is wrong with it.
    pub fn parse(&self, text: &str) -> Result<f64, String> {
        let (number, unit) = split(text).ok_or_else(|| format!("{text:?} does not start with a number"))?;
        if !number.is_finite() {
            return Err(format!("{text:?} is not a finite number"));
        }
        let unit = spelling(unit);
        if unit.is_empty() {
            return Err(format!("{text:?} has no unit"));
        }
        let (_, convert) = self.units.iter().find(|u| u.0 == unit).ok_or_else(|| wrong(&unit, self.noun))?;
        let value = convert(number);
        if value.is_finite() { Ok(value) } else { Err(format!("{text:?} is too large for a number")) }
    }

    /// What would be right: an example and every unit.
    pub fn remedy(&self) -> String {
        format!("write {} such as \"{}\" (units: {})", self.noun, self.example, self.names().join(", "))
    }
}

/// Number and unit: at the first blank, or where the longest number ends.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let blank = text.find(char::is_whitespace).unwrap_or(text.len());
    let cuts = (1..=blank).rev().filter(|&cut| text.is_char_boundary(cut));
    cuts.filter_map(|cut| Some((text[..cut].parse().ok()?, text[cut..].trim()))).next()
}

/// One spelling of the many ways to type a unit: `kg/m^3`, `kg/m³` -> `kg/m3`; `N*m`, `N·m` -> `N m`.
fn spelling(unit: &str) -> String {
    let plain: String = (unit.chars().filter(|&c| c != '^'))
        .map(|c| match c {
            '²' => '2',
            '³' => '3',
            'µ' | 'μ' => 'u',
            '*' | '·' => ' ',
            other => other,
        })
        .collect();
    plain.replace('°', "deg").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn wrong(unit: &str, wanted: &str) -> String {
    match ALL.iter().find(|d| d.units.iter().any(|u| u.0 == unit)) {
        Some(other) => format!("{unit:?} is the unit of {}, not of {wanted}", other.noun),
        None => format!("{unit:?} is not a unit of {wanted}"),
    }
}
