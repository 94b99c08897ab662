//! Materials of a deck: read so that a user can put them into the scene. A deck says no units; those of its lengths imply the rest.

use super::super::numbers::real;
use super::super::source::Place;
use super::cards::Card;
use crate::error::Result;
use crate::scene::LengthUnit;

/// What a deck says of a material.
#[derive(Debug, Clone, Default)]
pub struct Material {
    pub name: String,
    pub density: Option<(f64, Place)>,
    /// Kind in capitals, constants in the order of the deck.
    pub law: Option<(String, Vec<f64>, Place)>,
}

/// What the data lines of a material's card are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Table {
    Density,
    Law,
}

/// The law that a *HYPERELASTIC card announces, as a scene may know it; `Err`: why not.
pub fn announced(card: &Card) -> std::result::Result<&'static str, String> {
    if card.has("TEST DATA INPUT") {
        return Err("constants are to be fitted to test data: fit them, and write them".into());
    }
    // FrontISTR writes TYPE=.
    let named = |name: &str| card.has(name) || card.get("TYPE").is_some_and(|t| t.eq_ignore_ascii_case(name));
    let first = card.get("N").is_none_or(|n| n.trim() == "1");
    match () {
        () if named("NEO HOOKE") || named("NEOHOOKE") => Ok("NEO HOOKE"),
        () if named("MOONEY-RIVLIN") => Ok("MOONEY-RIVLIN"),
        () if named("YEOH") => Ok("YEOH"),
        () if named("REDUCED POLYNOMIAL") && first => Ok("NEO HOOKE"),
        () if ["OGDEN", "ARRUDA-BOYCE", "VAN DER WAALS", "MARLOW", "REDUCED POLYNOMIAL", "USER"]
            .iter()
            .any(|n| named(n)) =>
        {
            Err("this law is not there: fit mooney-rivlin or yeoh to it".into())
        }
        // The default where no law is named is the polynomial, which for N = 1 is Mooney and Rivlin's.
        () if first => Ok("MOONEY-RIVLIN"),
        () => Err("polynomials beyond N = 1 are not there: fit mooney-rivlin or yeoh to it".into()),
    }
}

impl Material {
    /// Takes a data line; temperatures and what lies behind the constants are left out.
    pub fn take(&mut self, table: Table, numbers: &[&[u8]], place: &Place) -> Result<()> {
        let number =
            |field: &&[u8]| real(field).map_err(|problem| place.error("material", problem, "write a number"));
        match table {
            Table::Density if self.density.is_none() => {
                if let Some(first) = numbers.first() {
                    self.density = Some((number(first)?, place.clone()));
                }
            }
            Table::Law => {
                if let Some((kind, constants, at)) = &mut self.law
                    && constants.is_empty()
                {
                    *at = place.clone();
                    let most = match kind.as_str() {
                        "NEO HOOKE" => 2,
                        "YEOH" => 6,
                        _ => 3,
                    };
                    for field in numbers.iter().take(most) {
                        constants.push(if field.is_empty() { 0.0 } else { number(field)? });
                    }
                }
            }
            Table::Density => {}
        }
        Ok(())
    }

    /// The lines of a scene that say the same, if `unit` implies units of the rest.
    pub fn scene_lines(&self, unit: &LengthUnit) -> Vec<String> {
        let Some(system) = System::of(unit) else {
            let name = &self.name;
            return vec![format!(
                "material {name}: its units cannot be told from lengths in {}; put density and moduli into the scene yourself",
                unit.name
            )];
        };
        let mut lines = Vec::new();
        if let Some((density, _)) = &self.density {
            lines.push(format!("density = \"{} kg/m3\"", short(density * system.density)));
        }
        if let Some((kind, constants, _)) = &self.law {
            lines.extend(law_lines(kind, constants, &system));
        }
        lines
    }

    /// Where the first of it stands.
    pub fn place(&self) -> Option<&Place> {
        self.density.as_ref().map(|d| &d.1).or(self.law.as_ref().map(|l| &l.2))
    }
}

/// Units that belong together.
struct System {
    name: &'static str,
    /// Units of density [kg/m3] and stress [Pa].
    density: f64,
    stress: f64,
}

impl System {
    fn of(unit: &LengthUnit) -> Option<System> {
        match unit.name.as_str() {
            "m" => Some(System { name: "m-kg-s", density: 1.0, stress: 1.0 }),
            "mm" => Some(System { name: "mm-t-s", density: 1e12, stress: 1e6 }),
            _ => None,
        }
    }
}

/// A number with as many digits as a deck has, without the round-off of changing its unit.
fn short(value: f64) -> String {
    let text = format!("{value:.9e}");
    text.parse::<f64>().map_or(text, |v| format!("{v}"))
}

/// [body.material] for W = C10 (I1 - 3) + C01 (I2 - 3) + (J - 1)^2 / D1 (Abaqus' theory manual, "Hyperelastic material behavior"):
/// g1 = 2 C10, g2 = 2 C01, kappa = 2 / D1, which is this program's energy term by term.
fn law_lines(kind: &str, constants: &[f64], system: &System) -> Vec<String> {
    let at = |i: usize| constants.get(i).copied().unwrap_or(0.0);
    let pa = |v: f64| format!("\"{} Pa\"", short(v * system.stress));
    let (mut lines, d1, further) = match kind {
        "NEO HOOKE" => {
            (vec!["law = \"neo-hookean\"".into(), format!("shear_modulus = {}", pa(2.0 * at(0)))], at(1), 0.0)
        }
        "YEOH" => {
            let constants =
                [("c10", 0), ("c20", 1), ("c30", 2)].map(|(key, i)| format!("{key} = {}", pa(at(i))));
            let mut lines = vec!["law = \"yeoh\"".to_string()];
            lines.extend(constants);
            (lines, at(3), at(4).abs() + at(5).abs())
        }
        _ => {
            let constants = [format!("g1 = {}", pa(2.0 * at(0))), format!("g2 = {}", pa(2.0 * at(1)))];
            let mut lines = vec!["law = \"mooney-rivlin\"".to_string()];
            lines.extend(constants);
            (lines, at(2), 0.0)
        }
    };
    let bulk = if kind == "NEO HOOKE" || kind == "YEOH" { "bulk_modulus" } else { "g0" };
    lines.push(match d1 > 0.0 {
        true => format!("{bulk} = {}", pa(2.0 / d1)),
        // Abaqus/Standard then is incompressible, Abaqus/Explicit takes kappa/G = 20.
        false => {
            let shear = if kind == "MOONEY-RIVLIN" { 2.0 * (at(0) + at(1)) } else { 2.0 * at(0) };
            format!(
                "{bulk} = {} # D1 is missing: this is kappa/G = 20, what Abaqus/Explicit takes then",
                pa(20.0 * shear)
            )
        }
    });
    if further > 0.0 {
        lines.push("# D2 and D3 of the deck have no place in this law".into());
    }
    lines[0] += &format!(" # the deck in {}", system.name);
    lines
}
