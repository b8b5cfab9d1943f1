"""usage: p5_gmsh.py SIZE   The 32 faces of benches/models/shell.loft in Gmsh, algorithm 6 (Frontal-Delaunay), one thread.

Eight squares in the plane and 24 bicubic patches of z = 60 s² (1.5 − s) 4 t (1 − t), s = (x − 25) / 75, t = y / 200. Prints the
CPU seconds of the surface mesh alone, its quality and the peak memory. Needs `pip install gmsh numpy`."""
import sys

import gmsh
import numpy as np
from quality import Cpu, gmsh_mesh, show, triangles

size = float(sys.argv[1])
gmsh.initialize()
options = {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size}
options |= {"Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.Algorithm": 6}
for key, value in options.items():
    gmsh.option.setNumber(key, value)
occ = gmsh.model.occ


def height(x, y):
    s, t = (x - 25) / 75, y / 200
    return np.where(x < 25, 0, 60 * s * s * (1.5 - s) * 4 * t * (1 - t))


third = np.arange(4) / 3
power = np.stack([(1 - third) ** 3, 3 * third * (1 - third) ** 2, 3 * third**2 * (1 - third), third**3], 1)
inverse = np.linalg.inv(power)
faces = []
for i in range(4):
    for j in range(8):
        if i == 0:
            faces.append(occ.addRectangle(0, 25 * j, 0, 25, 25))
            continue
        x, y = np.meshgrid(25 * i + 25 * third, 25 * j + 25 * third, indexing="ij")
        z = inverse @ height(x, y) @ inverse.T
        points = [occ.addPoint(x[a, b], y[a, b], z[a, b]) for b in range(4) for a in range(4)]
        faces.append(occ.addBezierSurface(points, 4))
occ.fragment([(2, face) for face in faces], [])
occ.synchronize()
gmsh.model.mesh.generate(1)
with Cpu() as cpu:
    gmsh.model.mesh.generate(2)
points, three, _ = gmsh_mesh(gmsh)
used = len(gmsh.model.getEntities(2))
show(peer=f"gmsh {gmsh.GMSH_API_VERSION}", faces=used, cpu=round(cpu.seconds, 3), **triangles(points, three))
