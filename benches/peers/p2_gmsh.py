"""usage: p2_gmsh.py SIZE ALGORITHM [RECOMBINATION]   The plate of benches/models/plate.loft in Gmsh, one thread.

Algorithm 6 is Frontal-Delaunay; 8 with recombination 3 makes quads only. Prints the CPU seconds of the surface mesh alone, its
quality and the peak memory. Needs `pip install gmsh numpy`."""
import sys

import gmsh
from quality import Cpu, gmsh_mesh, quads, show, triangles

size, algorithm = float(sys.argv[1]), int(sys.argv[2])
gmsh.initialize()
options = {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size}
options |= {f"Mesh.MeshSize{k}": 0 for k in ("FromPoints", "FromCurvature", "ExtendFromBoundary")}
options["Mesh.Algorithm"] = algorithm
if len(sys.argv) > 3:
    options |= {"Mesh.RecombineAll": 1, "Mesh.RecombinationAlgorithm": int(sys.argv[3])}
for key, value in options.items():
    gmsh.option.setNumber(key, value)
occ = gmsh.model.occ
plate = occ.addRectangle(0, 0, 0, 200, 100)
radius = lambda i, j: 4 + 0.5 * ((i + 2 * j) % 5)
holes = [occ.addDisk(20 + 40 * i, 12.5 + 25 * j, 0, radius(i, j), radius(i, j)) for j in range(4) for i in range(5)]
occ.cut([(2, plate)], [(2, hole) for hole in holes])
occ.synchronize()
gmsh.model.mesh.generate(1)
with Cpu() as cpu:
    gmsh.model.mesh.generate(2)
points, three, four = gmsh_mesh(gmsh)
figures = {"peer": f"gmsh {gmsh.GMSH_API_VERSION}", "cpu": round(cpu.seconds, 3)}
figures |= triangles(points, three) if len(three) else {}
figures |= quads(points, four) if len(four) else {}
show(**figures)
