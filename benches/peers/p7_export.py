"""Peers that write a million triangles (501 501 nodes, z = sin): python p7_export.py TOOL:KIND …

TOOL:KIND is one of gmsh:stl gmsh:msh41b gmsh:msh41a gmsh:inp meshio:stl meshio:vtu meshio:msh41 meshio:inp; without
any, all of them. Prints one JSON record each with the CPU seconds of the writing alone. Ours, the same mesh:
cargo bench --bench export -- --once DIR. Needs numpy, gmsh, meshio (tests/interop/requirements.txt).
"""
import json
import os
import sys
import tempfile
import time

import numpy as np

ALL = ["gmsh:stl", "meshio:stl", "meshio:vtu", "gmsh:msh41b", "meshio:msh41", "gmsh:msh41a", "gmsh:inp", "meshio:inp"]
NX, NY = 1000, 500


def mesh():
    x, y = np.meshgrid(np.linspace(0, 200, NX + 1), np.linspace(0, 100, NY + 1), indexing="ij")
    points = np.stack([x, y, 5 * np.sin(x / 9) * np.cos(y / 7)], -1).reshape(-1, 3)
    i = np.arange((NX + 1) * (NY + 1)).reshape(NX + 1, NY + 1)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[1:, 1:].ravel(), i[:-1, 1:].ravel()
    return points, np.r_[np.c_[a, b, c], np.c_[a, c, d]]


def gmsh_writer(points, triangles, kind, path):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    surface = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, surface, np.arange(1, len(points) + 1), points.ravel())
    gmsh.model.mesh.addElementsByType(surface, 2, [], (triangles + 1).ravel())
    gmsh.option.setNumber("Mesh.Binary", 1 if kind in ("stl", "msh41b") else 0)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    return lambda: gmsh.write(path)


def meshio_writer(points, triangles, kind, path):
    import meshio

    settings = {
        "stl": {"binary": True},
        "vtu": {"compression": None},
        "msh41": {"file_format": "gmsh", "binary": True},
        "inp": {},
    }[kind]
    data = meshio.Mesh(points, [("triangle", triangles)])
    return lambda: meshio.write(path, data, **settings)


def run(name):
    tool, kind = name.split(":")
    ending = {"msh41b": "msh", "msh41a": "msh", "msh41": "msh"}.get(kind, kind)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "p7." + ending)
        write = {"gmsh": gmsh_writer, "meshio": meshio_writer}[tool](*mesh(), kind, path)
        cpu, wall = time.process_time(), time.perf_counter()
        write()
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        size = os.path.getsize(path) / 1e6
    print(json.dumps({"problem": "P7", "peer": tool, "kind": kind, "cpu": round(cpu, 3), "wall": round(wall, 3), "size_mb": round(size, 1)}))


if __name__ == "__main__":
    names = sys.argv[1:] or ALL
    if len(names) == 1:
        run(names[0])
    else:
        # A process each, so that none runs on the other's memory.
        for name in names:
            os.spawnv(os.P_WAIT, sys.executable, [sys.executable, os.path.abspath(__file__), name])
