"""usage: random_plates.py LOFT [--cases N] [--first SEED] [--quads] [--gmsh] [--triangles COUNT] [--write FOLDER]
       [--draw FILE]

Meshes random plates (plates.py) at two sizes each, of about COUNT (20 000) and a quarter of as many elements, and prints one line a mesh and a
table of least, 10 %, median and largest value of every figure; with --gmsh the same plates by Gmsh's Frontal-Delaunay (with --quads by its
algorithm 8 with recombination 3), in turn. Times: ours is the mesh stage of one thread, Gmsh's the CPU of its 2-D mesher alone; `rate` is
thousands of elements a second, and rates are compared, for at one size the two do not make as many. `angle_away` is the least angle away from
sharp corners: no angle counts at a node of the border whose elements have less than 60° together. `--write` writes the coarser script of
each case into a folder and meshes nothing; `--draw` draws the places of the worst triangles of the five worst meshes. Needs
`pip install gmsh matplotlib numpy`."""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from plates import Plate
from quality import Cpu, gmsh_mesh, quads, triangles
from worst import Worst, corner_angles


def read_obj(path):
    """Points, triangles and quads of an OBJ file of one mesh."""
    points, elements = [], {3: [], 4: []}
    for line in open(path):
        if line.startswith("v "):
            points.append([float(x) for x in line.split()[1:4]])
        elif line.startswith("f "):
            corners = [int(word.split("/")[0]) - 1 for word in line.split()[1:]]
            elements[len(corners)].append(corners)
    return np.array(points), np.array(elements[3], int).reshape(-1, 3), np.array(elements[4], int).reshape(-1, 4)


# An inner angle of the border below which a node is a sharp corner, degrees: the geometry makes its angles, not the mesher.
SHARP = 60.0


def away_from_corners(points, corners):
    """Which corners of triangles count: all but those at nodes of the border whose triangles have less than SHARP together."""
    total = np.bincount(corners.ravel(), corner_angles(points, corners).ravel(), len(points))
    return total[corners] >= SHARP


def angle_away(points, corners):
    """Least angle of triangles that counts, degrees."""
    return round(float(corner_angles(points, corners)[away_from_corners(points, corners)].min()), 2)


def measure(points, three, four):
    found = triangles(points, three) | {"angle_away": angle_away(points, three)} if len(three) else {}
    return found | (quads(points, four) if len(four) else {})


def children_cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(found, seconds):
    """With the seconds, and thousands of elements a second."""
    count = found.get("triangles", 0) + found.get("quads", 0)
    return found | {"seconds": round(seconds, 3), "rate": round(count / max(seconds, 1e-3) / 1000, 1)}


def ours(program, plate, settings, folder):
    script = pathlib.Path(folder) / "plate.loft"
    script.write_text(plate.loft(settings))
    before, start = children_cpu(), time.perf_counter()
    run = subprocess.run([program, "run", script, "-o", folder, "--threads", "1", "--timings"], capture_output=True, text=True)
    busy = (children_cpu() - before) / (time.perf_counter() - start)
    if run.returncode != 0:
        return {"failed": run.stderr.strip().splitlines()[:1]}
    timing = next(line for line in run.stderr.splitlines() if line.startswith("parse "))
    # The program tells wall clock: the share of it that the process ran makes it CPU, as on a machine that does other work as well.
    seconds = float(timing.split("mesh ")[1].split(" s")[0]) * min(busy, 1)
    return timed(measure(*read_obj(pathlib.Path(folder) / "fine.obj")), seconds)


def theirs(plate, size, with_quads):
    import gmsh

    gmsh.initialize()
    options = {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size}
    options |= {f"Mesh.MeshSize{k}": 0 for k in ("FromPoints", "FromCurvature", "ExtendFromBoundary")}
    options |= {"Mesh.Algorithm": 8, "Mesh.RecombineAll": 1, "Mesh.RecombinationAlgorithm": 3} if with_quads else {"Mesh.Algorithm": 6}
    for key, value in options.items():
        gmsh.option.setNumber(key, value)
    plate.gmsh(gmsh)
    try:
        gmsh.model.mesh.generate(1)
        if with_quads:
            # Recombination 3 halves the border: every curve needs an even number of steps.
            for _, curve in gmsh.model.getEntities(1):
                steps = len(gmsh.model.mesh.getElements(1, curve)[1][0])
                gmsh.model.mesh.setTransfiniteCurve(curve, steps + steps % 2 + 1)
            gmsh.model.mesh.clear()
            gmsh.model.mesh.generate(1)
        with Cpu() as cpu:
            gmsh.model.mesh.generate(2)
        found = timed(measure(*gmsh_mesh(gmsh)), cpu.seconds)
    except Exception as fault:
        found = {"failed": str(fault)}
    gmsh.finalize()
    # Where steps of its border cross it tells nothing and makes nothing.
    return found if "failed" in found or {"triangles", "quads"} & found.keys() else {"failed": "no elements"}


def table(title, rows):
    print(f"\n{title}: {len(rows)} meshes")
    print(f"{'':>16} {'least':>9} {'10 %':>9} {'median':>9} {'largest':>9}")
    for key in [k for k in rows[0] if k not in ("case", "size")] if rows else []:
        values = np.array([row[key] for row in rows if key in row])
        of = [values.min(), np.percentile(values, 10), np.median(values), values.max()]
        print(f"{key:>16} " + " ".join(f"{v:9.4g}" for v in of))


def request(given, share):
    """Size of a share of the elements, and the settings of the mesh."""
    # 0.8 of a rectangle of the plate's size is plate; an equilateral triangle has 0.433 of its side squared.
    size = round((0.8 * 36_000 / (given.triangles / share) / (1 if given.quads else 0.433)) ** 0.5, 3)
    return size, f"size: {size}mm" + ("  elements: quads" if given.quads else "")


def write(given):
    """The coarser script of each case, without its export."""
    given.write.mkdir(parents=True, exist_ok=True)
    for seed in range(given.first, given.first + given.cases):
        lines = Plate(seed).loft(request(given, 4)[1]).splitlines()
        (given.write / f"plate-{seed:02}.loft").write_text("\n".join(lines[:-1]) + "\n")
    return 0


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("loft")
    ask.add_argument("--cases", type=int, default=50)
    ask.add_argument("--first", type=int, default=0)
    ask.add_argument("--triangles", type=int, default=20_000)
    ask.add_argument("--quads", action="store_true")
    ask.add_argument("--gmsh", action="store_true")
    ask.add_argument("--write", type=pathlib.Path)
    ask.add_argument("--draw", type=pathlib.Path)
    given = ask.parse_args()
    if given.write:
        return write(given)
    own, other, failed, worst = [], [], [], Worst()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.first, given.first + given.cases):
            plate = Plate(seed)
            for share in (1, 4):
                size, settings = request(given, share)
                found = {"case": f"{seed} {plate.kind} {len(plate.holes)} holes, web {plate.web}", "size": size}
                found |= ours(given.loft, plate, settings, folder)
                print(json.dumps(found), flush=True)
                (failed if "failed" in found else own).append(found)
                if given.draw and "triangles" in found:
                    points, corners, _ = read_obj(pathlib.Path(folder) / "fine.obj")
                    worst.look(f"{seed}, {size} mm", points, corners, away_from_corners(points, corners))
                if given.gmsh:
                    other.append(theirs(plate, size, given.quads))
                    print("    " + json.dumps(other[-1]), flush=True)
    table("loft", own)
    if other:
        made = [b for b in other if "failed" not in b]
        table("Gmsh", made)
        pairs = [(a, b) for a, b in zip(own, other) if "failed" not in b] if not failed else []
        table("our rate over Gmsh's", [{"times": a["rate"] / b["rate"]} for a, b in pairs])
        print(f"\nGmsh failed: {len(other) - len(made)}")
    print(f"\nfailed: {len(failed)}")
    if given.draw:
        worst.draw(given.draw)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
