"""The paper's ring as other codes read it: the same nodes, elements and corner order as hexroll's generator."""

import math

OUTER, INNER, WIDTH = 39e-3, 17e-3, 17.5e-3  # m
DENSITY, SHEAR, BULK = 1100.0, 2.64e6, 65.1e6  # kg/m3, Pa


def ring(refinement):
    """Nodes [m], hexahedra (from 0), nodes on the rim; 44 x 4 x 5 elements times `refinement` in each direction."""
    around, radial, wide = 44 * refinement, 4 * refinement, 5 * refinement
    nodes = []
    for k in range(radial + 1):
        r = INNER + (OUTER - INNER) * k / radial
        for j in range(wide + 1):
            y = WIDTH * (j / wide - 0.5)
            for i in range(around):
                a = 2 * math.pi * i / around
                nodes.append((-r * math.sin(a), y, OUTER - r * math.cos(a)))

    def node(i, j, k):
        return (k * (wide + 1) + j) * around + i % around

    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    hexes = [
        [node(i + a, j + b, k + c) for a, b, c in corners]
        for k in range(radial)
        for j in range(wide)
        for i in range(around)
    ]
    rim = list(range(around * (wide + 1)))
    return nodes, hexes, rim


def write_calculix(path, refinement, duration, first_step):
    """C3D8, *HYPERELASTIC NEO HOOKE (C10 = G/2, D1 = 2/kappa), *DYNAMIC EXPLICIT; rim held, a small velocity."""
    nodes, hexes, rim = ring(refinement)
    with open(path, "w") as f:
        f.write("*NODE, NSET=ALL\n")
        f.writelines(f"{n}, {x:.12e}, {y:.12e}, {z:.12e}\n" for n, (x, y, z) in enumerate(nodes, 1))
        f.write("*ELEMENT, TYPE=C3D8, ELSET=RUBBER\n")
        f.writelines(f"{e}, " + ", ".join(str(n + 1) for n in h) + "\n" for e, h in enumerate(hexes, 1))
        f.write("*NSET, NSET=RIM\n")
        f.writelines(f"{n + 1},\n" for n in rim)
        f.write("*NSET, NSET=FREE\n")
        held = set(rim)
        f.writelines(f"{n + 1},\n" for n in range(len(nodes)) if n not in held)
        f.write(f"*MATERIAL, NAME=RUBBER\n*HYPERELASTIC, NEO HOOKE\n{SHEAR / 2:.9e}, {2 / BULK:.9e}\n")
        f.write(f"*DENSITY\n{DENSITY}\n*SOLID SECTION, ELSET=RUBBER, MATERIAL=RUBBER\n")
        f.write("*BOUNDARY\nRIM, 1, 3\n*INITIAL CONDITIONS, TYPE=VELOCITY\nFREE, 1, 0.1\n")
        f.write(f"*STEP, NLGEOM, INC=1000000\n*DYNAMIC, EXPLICIT\n{first_step:.6e}, {duration:.9e}\n")
        f.write("*NODE FILE, FREQUENCY=1000000\nU\n*END STEP\n")


def write_gmsh(path, refinement):
    """Gmsh 2.2, physical volume `rubber` and physical surface `rim`."""
    nodes, hexes, rim = ring(refinement)
    inner = [h[:4] for h in hexes[: len(hexes) // (4 * refinement)]]
    with open(path, "w") as f:
        f.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        f.write('$PhysicalNames\n2\n2 1 "rim"\n3 2 "rubber"\n$EndPhysicalNames\n')
        f.write(f"$Nodes\n{len(nodes)}\n")
        f.writelines(f"{n} {x:.12e} {y:.12e} {z:.12e}\n" for n, (x, y, z) in enumerate(nodes, 1))
        f.write(f"$EndNodes\n$Elements\n{len(inner) + len(hexes)}\n")
        number = 0
        for kind, tag, cells in ((3, 1, inner), (5, 2, hexes)):
            for cell in cells:
                number += 1
                f.write(f"{number} {kind} 2 {tag} {tag} " + " ".join(str(n + 1) for n in cell) + "\n")
        f.write("$EndElements\n")
