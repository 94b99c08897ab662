"""Times Akantu on the ring; run by compare.py with Akantu's own Python: akantu_ring.py MESH STEPS_A STEPS_B.

_hexahedron_8, explicit with lumped mass, elastic with finite deformation (St. Venant-Kirchhoff; its neo-Hookean has
no three-dimensional stress). Prints JSON: dt and the seconds of each number of steps.
"""

import json
import sys
import tempfile
import time

import akantu as aka

DENSITY, SHEAR, BULK = 1100.0, 2.64e6, 65.1e6
YOUNG = 9 * BULK * SHEAR / (3 * BULK + SHEAR)
POISSON = (3 * BULK - 2 * SHEAR) / (2 * (3 * BULK + SHEAR))

MATERIAL = f"""
material elastic [
  name = rubber
  rho = {DENSITY}
  E = {YOUNG}
  nu = {POISSON}
  finite_deformation = true
]
"""


def main(path, counts):
    with tempfile.NamedTemporaryFile("w", suffix=".dat") as material:
        material.write(MATERIAL)
        material.flush()
        aka.parseInput(material.name)
    mesh = aka.Mesh(3)
    mesh.read(path)
    model = aka.SolidMechanicsModel(mesh)
    model.initFull(_analysis_method=aka._explicit_lumped_mass)
    for axis in (aka._x, aka._y, aka._z):
        model.applyBC(aka.FixedValue(0.0, axis), "rim")
    stable = model.getStableTimeStep()
    model.setTimeStep(0.9 * stable)
    velocity = model.getVelocity()
    velocity[:, 0] = 0.1
    velocity[model.getBlockedDOFs()[:, 0], 0] = 0.0
    model.solveStep()
    seconds = []
    for count in counts:
        begun = time.perf_counter()
        for _ in range(count):
            model.solveStep()
        seconds.append(time.perf_counter() - begun)
    moved = float(abs(model.getDisplacement()).max())
    print(json.dumps({"dt": 0.9 * stable, "seconds": seconds, "largest_displacement": moved}))


main(sys.argv[1], [int(n) for n in sys.argv[2:]])
