"""Makes the meshes of this folder with Gmsh (pip install gmsh meshio vtk): a wheel of 4 x 4 x 2 x 2 hexahedra, in millimetres.

Its axle is along z, as solid modellers draw wheels, through (10, 20, 5) mm.
"""

import math
import sys

import gmsh

INNER, OUTER, WIDTH = 17.0, 39.0, 17.5
CENTRE = (10.0, 20.0, 5.0)


def wheel():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    x, y, z = CENTRE
    z -= WIDTH / 2
    centre = geo.addPoint(x, y, z)
    ring = {}
    for radius in (INNER, OUTER):
        points = [
            geo.addPoint(x + radius * math.cos(i * math.pi / 2), y + radius * math.sin(i * math.pi / 2), z)
            for i in range(4)
        ]
        arcs = [geo.addCircleArc(points[i], centre, points[(i + 1) % 4]) for i in range(4)]
        ring[radius] = points, arcs
    spokes = [geo.addLine(ring[INNER][0][i], ring[OUTER][0][i]) for i in range(4)]
    volumes, inner, outer = [], [], []
    for i in range(4):
        j = (i + 1) % 4
        loop = geo.addCurveLoop([spokes[i], ring[OUTER][1][i], -spokes[j], -ring[INNER][1][i]])
        surface = geo.addPlaneSurface([loop])
        for arc in (ring[INNER][1][i], ring[OUTER][1][i]):
            geo.mesh.setTransfiniteCurve(arc, 5)
        for spoke in (spokes[i], spokes[j]):
            geo.mesh.setTransfiniteCurve(spoke, 3)
        geo.mesh.setTransfiniteSurface(surface)
        geo.mesh.setRecombine(2, surface)
        sides = geo.extrude([(2, surface)], 0, 0, WIDTH, [2], recombine=True)
        # The far face, the volume, then a face a curve of the loop.
        volumes.append(sides[1][1])
        outer.append(sides[3][1])
        inner.append(sides[5][1])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, inner, name="rim")
    gmsh.model.addPhysicalGroup(2, outer, name="tread")
    gmsh.model.addPhysicalGroup(3, volumes, name="rubber")
    gmsh.model.mesh.generate(3)


def tetrahedra():
    gmsh.clear()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
    gmsh.model.mesh.generate(3)


def write(name, version, binary):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(name)


if __name__ == "__main__":
    wheel()
    write("wheel-4.1.msh", 4.1, 0)
    write("wheel-4.1-binary.msh", 4.1, 1)
    write("wheel-2.2.msh", 2.2, 0)
    write("wheel-2.2-binary.msh", 2.2, 1)
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
    write("wheel.inp", 4.1, 0)
    tetrahedra()
    write("tetrahedra.msh", 4.1, 0)
    gmsh.finalize()
    if "--vtu" in sys.argv:
        import meshio
        import vtk

        mesh = meshio.read("wheel-4.1.msh")
        hexes = meshio.Mesh(mesh.points, {"hexahedron": mesh.cells_dict["hexahedron"]})
        meshio.write("wheel-meshio.vtu", hexes)
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName("wheel-meshio.vtu")
        # Text; base64 in the arrays; base64 behind them, as VTK does by itself (all three compressed); raw, not compressed.
        for name, mode, raw in [("ascii", 0, False), ("binary", 1, False), ("appended", 2, False), ("raw", 2, True)]:
            writer = vtk.vtkXMLUnstructuredGridWriter()
            writer.SetInputConnection(reader.GetOutputPort())
            writer.SetFileName(f"wheel-vtk-{name}.vtu")
            writer.SetDataMode(mode)
            if raw:
                writer.EncodeAppendedDataOff()
                writer.SetCompressorTypeToNone()
                writer.SetHeaderTypeToUInt64()
            else:
                writer.SetCompressorTypeToZLib()
            writer.Write()
