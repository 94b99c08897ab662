//! Scene files say what is meant, and every mistake is answered with file, line, key and what would be right.

mod hash;
mod mistakes;
mod overrides;
mod reading;
mod shipped;
mod units;

use hexroll::Error;
use hexroll::scene::Scene;

/// A small scene that uses every section; mistakes are edited into it.
const GOOD: &str = r#"title = "a wheel"
source = "none"
expected = "nothing"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]

[body]
density = "1100 kg/m3"
element = "uniform-gradient"
hourglass = 0.2
offset = ["1 mm", "0 mm", "0 mm"]

[body.mesh]
generator = "ring"
outer_radius = "39 mm"
inner_radius = "17 mm"
width = "17.5 mm"
elements = [12, 2, 2]

[body.material]
law = "mooney-rivlin"
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"

[rim]
nodes = "inner"

[road]
shape = "plane"
point = ["0 m", "0 m", "0 m"]
normal = [0, 0, 2]
velocity = ["1 m/s", "0 m/s", "0 m/s"]

[friction]
law = "coulomb"
coefficient = 0.8

[time_step]
safety = 0.8

[[stage]]
name = "press"
method = "quasi-static"
duration = "0.2 s"
mass_damping = "3000 1/s"
settle = { kinetic_ratio = 1e-8, residual = 1e-4 }

[stage.rim]
z = { displacement = "-2.2 mm", ramp = "20 ms" }

[[stage]]
name = "roll"
method = "explicit"
duration = "50 ms"
initial_velocity = "rim"

[stage.rim]
x = { velocity = "2.59 m/s", ramp = "1 ms" }
z = { force = "-300 N", mass = "50 g" }
steer = { angle = "5 deg", ramp = "5 ms" }
spin = { moment = "0 N m", inertia = "1e-5 kg m2" }

[output]
sample = "1 ms"
snapshots = "10 ms"
pictures = ["body:von-mises", "footprint"]
"#;

/// The good scene with overrides.
fn good(overrides: &[&str]) -> Result<Scene, Error> {
    Scene::parse(GOOD, "good.toml", &overrides.iter().map(|s| s.to_string()).collect::<Vec<_>>())
}
