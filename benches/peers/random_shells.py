"""usage: random_shells.py LOFT [--cases N] [--first SEED] [--gmsh] [--triangles COUNT] [--method WORD] [--write FOLDER]
       [--draw FILE]

Meshes random shells (shells.py) of 10 to 60 faces, of about COUNT (20 000) triangles each, and prints one line a mesh and a table of least, 10 %,
median and largest value of every figure, and those that are not sound: an edge with more than two triangles or run twice the same way, another
Euler number, an area that is off by more than 1 %, an angle below 30° away from corners sharper than 45°. With --gmsh the same shells, as STEP from loft, by
Gmsh's Frontal-Delaunay at a size that gives as many triangles, in turn. Times: ours is the CPU of the mesh stage of one thread, Gmsh's that of its 2-D
mesher alone. --write FOLDER writes ten of the scripts, coarse, and truth.json instead;
--draw draws the places of the worst triangles of the five worst shells. Needs `pip install gmsh matplotlib numpy`."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from quality import Cpu, gmsh_mesh, triangles
from random_plates import table
from shells import Shell
from worst import Worst, corner_angles

LEAST_ANGLE, SHARP_CORNER = 30.0, 45.0


def read_obj(path):
    """Points, triangles and the face of each triangle by the first word of its group."""
    points, corners, owner, face = [], [], [], -1
    for line in open(path):
        if line.startswith("v "):
            points.append([float(x) for x in line.split()[1:4]])
        elif line.startswith("g "):
            face += 1
        elif line.startswith("f "):
            corners.append([int(word.split("/")[0]) - 1 for word in line.split()[1:]])
            owner.append(face)
    return np.array(points), np.array(corners, int), np.array(owner, int)


def away_from_corners(points, corners, owner):
    """Which triangles touch no sharp corner of their face: a node of its border at which the triangles of the face have a sharp angle together."""
    angles = corner_angles(points, corners)
    sides = np.concatenate([corners[:, [k, (k + 1) % 3]] for k in range(3)])
    key = owner[:, None] * len(points) + corners
    own = np.tile(owner, 3)
    _, place, number = np.unique(np.column_stack([own, np.sort(sides, 1)]), axis=0, return_index=True, return_counts=True)
    border = np.concatenate([(own[place] * len(points) + sides[place, k])[number == 1] for k in (0, 1)])
    keys, at = np.unique(key.ravel(), return_inverse=True)
    sharp = (np.bincount(at, angles.ravel()) < SHARP_CORNER) & np.isin(keys, border)
    return ~sharp[at.reshape(-1, 3)].any(1)


def measure(points, corners, owner):
    """Quality, what is wrong with the edges, Euler number, area, and the least angle of triangles that touch no sharp corner of their face."""
    found = triangles(points, corners)
    sides = np.concatenate([corners[:, [k, (k + 1) % 3]] for k in range(3)])
    directed = len(np.unique(sides, axis=0)) == len(sides)
    once, uses = np.unique(np.sort(sides, 1), axis=0, return_counts=True)
    found["bad_edges"] = int((uses > 2).sum()) + (0 if directed else 1)
    found["euler"] = len(np.unique(corners)) - len(once) + len(corners)
    a, b, c = (points[corners[:, k]] for k in range(3))
    found["area"] = float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    away = away_from_corners(points, corners, owner)
    least = np.where(away, corner_angles(points, corners).min(1), 180.0)
    worst = int(least.argmin())
    found["away"] = round(float(least[worst]), 2)
    found["below"] = int((least < LEAST_ANGLE).sum())
    found["where"] = {"face": int(owner[worst]), "at": points[corners[worst]].mean(0).round(3).tolist()}
    return found


def run(program, script, folder):
    """The mesh stage's CPU seconds (its wall clock times the process's share of a CPU), all output, and the exit status."""
    before, start = os.times(), time.monotonic()
    done = subprocess.run([program, "run", script, "-o", folder, "--threads", "1", "--timings"], capture_output=True, text=True)
    after, wall = os.times(), time.monotonic() - start
    share = min((after[2] + after[3] - before[2] - before[3]) / wall, 1.0)
    timing = [line for line in done.stderr.splitlines() if line.startswith("parse ")]
    seconds = float(timing[0].split("mesh ")[1].split(" s")[0]) * share if timing else 0.0
    return round(seconds, 4), done


def total_area(shell, program, folder):
    """The area of a shell: known, or as loft measures its surfaces."""
    if shell.area is not None:
        return shell.area
    script = pathlib.Path(folder) / "area.loft"
    script.write_text(shell.loft("size: 20mm", files=False) + 'export [{area: all.area / 1mm2}] to "area.json"\n')
    run(program, script, folder)
    return json.loads((pathlib.Path(folder) / "area.json").read_text())[0]["area"]


def ours(program, shell, settings, folder, area):
    script = pathlib.Path(folder) / "shell.loft"
    script.write_text(shell.loft(settings))
    seconds, done = run(program, script, folder)
    if done.returncode != 0:
        return {"failed": done.stderr.strip().splitlines()[:1]}
    found = measure(*read_obj(pathlib.Path(folder) / "fine.obj"))
    found |= {"off_area": round(abs(found.pop("area") / area - 1), 5), "seconds": seconds, "per_second": round(found["triangles"] / max(seconds, 1e-4))}
    checks = {"edges": found["bad_edges"] == 0, "euler": found["euler"] == shell.euler, "area": found["off_area"] < 0.01}
    return found | {"wrong": [name for name, holds in checks.items() if not holds], "sharp": found["below"] > 0}


def theirs(size, folder):
    import gmsh

    gmsh.initialize()
    options = {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size, "Mesh.Algorithm": 6}
    options |= {f"Mesh.MeshSize{k}": 0 for k in ("FromPoints", "FromCurvature", "ExtendFromBoundary")}
    for key, value in options.items():
        gmsh.option.setNumber(key, value)
    gmsh.model.occ.importShapes(str(pathlib.Path(folder) / "all.step"))
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(1)
    failed = []
    with Cpu() as cpu:
        try:
            gmsh.model.mesh.generate(2)
        except Exception as error:
            failed = [str(error)[:80]]
    points, three, _ = gmsh_mesh(gmsh)
    gmsh.finalize()
    found = triangles(points, three) | {"seconds": round(cpu.seconds, 3)}
    return found | {"per_second": round(found["triangles"] / cpu.seconds), "failed": failed}


def write(folder):
    """Ten coarse scripts, each with what is true of it."""
    folder, truth = pathlib.Path(folder), {}
    folder.mkdir(parents=True, exist_ok=True)
    for seed in CASES_OF_TEST:
        shell = Shell(seed)
        name = f"{shell.kind}-{seed}"
        (folder / f"{name}.loft").write_text(shell.loft(f"size: {COARSE_SIZE}", files=False))
        truth[name] = {"faces": shell.faces, "euler": shell.euler, "area": shell.area, "least_angle": FLOORS.get(seed, LEAST_ANGLE)}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")


# Seeds of the test of ten shells: one of each kind at least, with poles, trimmed faces and faces of three sides.
CASES_OF_TEST = (0, 1, 2, 3, 8, 10, 12, 14, 20, 25)
# Those that have smaller angles: a web between a hole and a border as wide as the size, strips a quarter as wide.
FLOORS = {0: 25.0, 8: 15.0}
COARSE_SIZE = "2.5%"


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("loft")
    ask.add_argument("--cases", type=int, default=50)
    ask.add_argument("--first", type=int, default=0)
    ask.add_argument("--triangles", type=int, default=20_000)
    ask.add_argument("--method", default="auto")
    ask.add_argument("--gmsh", action="store_true")
    ask.add_argument("--write")
    ask.add_argument("--draw")
    given = ask.parse_args()
    if given.write:
        return write(given.write)
    own, other, failed, worst = [], [], [], Worst()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.first, given.first + given.cases):
            shell = Shell(seed)
            area = total_area(shell, given.loft, folder)
            # Sides inside are 0.8 of the size; an equilateral triangle has 0.433 of its side squared.
            size = round((area / given.triangles / 0.433) ** 0.5 / 0.8, 3)
            found = {"case": f"{seed} {shell.kind} {shell.faces} faces", "size": size}
            found |= ours(given.loft, shell, f"size: {size}mm  method: {given.method}", folder, area)
            print(json.dumps(found), flush=True)
            (failed if "failed" in found else own).append(found)
            if given.draw and "failed" not in found:
                points, corners, owner = read_obj(pathlib.Path(folder) / "fine.obj")
                worst.look(f"{seed} {shell.kind}", points, corners, away_from_corners(points, corners, owner)[:, None])
            if given.gmsh and "failed" not in found:
                peer = theirs(round((area / found["triangles"] / 0.433) ** 0.5, 4), folder)
                print(json.dumps({"gmsh": seed} | peer), flush=True)
                found["times_gmsh"] = round(found["per_second"] / peer["per_second"], 2)
                other.append(peer)
    skip = ("wrong", "where", "sharp", "failed", "euler", "bad_edges")
    table("loft", [{k: v for k, v in row.items() if k not in skip} for row in own])
    if other:
        table("Gmsh", [{k: v for k, v in row.items() if k not in skip} for row in other])
    wrong, sharp = ([row["case"] for row in own if row[key]] for key in ("wrong", "sharp"))
    print(f"\nfailed: {len(failed)}; wrong: {wrong}; below {LEAST_ANGLE:g}°: {len(sharp)} {sharp}")
    if given.draw:
        worst.draw(given.draw)
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
