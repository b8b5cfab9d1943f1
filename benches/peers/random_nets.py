"""usage: random_nets.py LOFT [--cases N] [--first SEED] [--display] [--limits 0,1,2] [--occt] [--truth FILE] [--write FOLDER]
       [--draw FILE]

Meshes random trimmed nets (nets.py) within three chord errors each, at which OpenCASCADE makes about 2 000, 15 000 and 120 000 triangles,
and prints one line a mesh and a table of least, 10 %, median and largest value of every figure. The distance from the surface is
measured at 25 places of each triangle, by Gauss-Newton from their (u, v); `over` is the largest over the limit, which is kept up to 1.
Angles are those of triangles without a corner of the net. With --occt the same faces are meshed by OpenCASCADE's incremental mesher
beside; with --truth its figures are kept in a file and taken from there the next time. --write writes ten small nets with the
counts of OpenCASCADE, for `tests/random_nets.rs`. Times are CPU seconds of one thread: ours of the stage, theirs of the mesher
alone. --draw draws the places of the worst triangles of the five worst meshes. Needs `pip install cadquery-ocp==7.9.3.1.1 matplotlib numpy scipy`."""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np
from nets import Net
from quality import Cpu, triangles
from random_plates import read_obj, table
from scipy.spatial import cKDTree
from worst import Worst

# Places of a triangle at which its distance is measured: those of a grid of six parts along its sides, without the corners.
PARTS = 6
PLACES = np.array([(i, j, PARTS - i - j) for i in range(PARTS + 1) for j in range(PARTS + 1 - i)]) / PARTS
PLACES = PLACES[PLACES.max(1) < 1]
# Share of the largest distance to first order from which on a distance is computed.
NEAR_WORST = 0.7


def offset(surface, points, u, v):
    """To the tangent plane, and one Gauss-Newton step to the foot."""
    p, du, dv = surface.evaluate(u, v)
    d = points - p
    e, f, g = (du * du).sum(1), (du * dv).sum(1), (dv * dv).sum(1)
    r, s = (du * d).sum(1), (dv * d).sum(1)
    det = e * g - f * f
    x, y = (g * r - f * s) / det, (e * s - f * r) / det
    left = d - x[:, None] * du - y[:, None] * dv
    return np.linalg.norm(left, axis=1), np.clip(u + x, 0, 1), np.clip(v + y, 0, 1)


def distance(surface, points, u, v, steps=4):
    for _ in range(steps):
        _, u, v = offset(surface, points, u, v)
    return np.linalg.norm(points - surface.evaluate(u, v)[0], axis=1)


def feet(surface, points, n=400):
    """(u, v) of points on the surface: by Gauss-Newton from the nearest of a grid."""
    t = np.linspace(0, 1, n)
    u, v = (x.ravel() for x in np.meshgrid(t, t, indexing="ij"))
    a, b = surface.u.matrices(t, 0)[0], surface.v.matrices(t, 0)[0]
    grid = np.einsum("xi,ijk,yj->xyk", a, surface.poles, b, optimize=True).reshape(-1, 4)
    nearest = cKDTree(grid[:, :3] / grid[:, 3:]).query(points)[1]
    u, v = u[nearest], v[nearest]
    for _ in range(8):
        _, u, v = offset(surface, points, u, v)
    return np.stack([u, v], -1), float(np.linalg.norm(points - surface.evaluate(u, v)[0], axis=1).max())


def chord_error(surface, points, uv, corners):
    """The largest distance of places of triangles from the surface."""
    worst = 0.0
    for part in np.array_split(corners, max(1, len(corners) // 4000)):
        p = np.einsum("wk,tkd->twd", PLACES, points[part]).reshape(-1, 3)
        at = np.einsum("wk,tkd->twd", PLACES, uv[part]).reshape(-1, 2)
        about, _, _ = offset(surface, p, at[:, 0], at[:, 1])
        far = about >= NEAR_WORST * max(worst, about.max())
        if far.any():
            worst = max(worst, distance(surface, p[far], at[far, 0], at[far, 1]).max())
    return float(worst)


def at_corner(net, points):
    """Which points are corners of the net."""
    ends = net.surface.evaluate(np.array([0.0, 0, 1, 1]), np.array([0.0, 1, 0, 1]))[0]
    return (np.linalg.norm(points[:, None] - ends, axis=2) < 1e-6).any(1)


def measured(net, points, corners, limit, uv=None, most=None):
    """Figures of a mesh; of more than `most` triangles the distance is that of some at random."""
    found = triangles(points, corners)
    found["angle"] = triangles(points, corners[~at_corner(net, points)[corners].any(1)])["angle"]
    uv, off = (uv, 0.0) if uv is not None else feet(net.surface, points)
    some = corners if most is None or len(corners) <= most else corners[np.random.default_rng(1).choice(len(corners), most, replace=False)]
    return found | {"over": round(chord_error(net.surface, points, uv, some) / limit, 4)} | ({"nodes_off": off} if off > 1e-3 * limit else {})


def ours(program, net, limit, settings, folder):
    script = pathlib.Path(folder) / "net.loft"
    script.write_text(net.loft(limit, settings))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        run = subprocess.run([program, "run", script, "-o", folder, "--threads", "1", "--timings"], capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return {"failed": "more than 300 s"}
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode != 0:
        return {"failed": run.stderr.strip().splitlines()[:1]}
    timing = next(line for line in run.stderr.splitlines() if line.startswith("parse "))
    stages = {word.split()[0]: float(word.split()[1]) for word in timing.split(", ")}
    # Stages are timed by the clock; on a busy machine their shares are those of the CPU.
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    points, corners, _ = read_obj(pathlib.Path(folder) / "net.obj")
    return measured(net, points, corners, limit) | {"seconds": round(cpu * stages["mesh"] / max(sum(stages.values()), 1e-9), 4), "whole": round(cpu, 4)}


def add_holes(net, whole, make):
    """The holes of a net as wires of a face in OpenCASCADE."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire
    from OCP.Geom2d import Geom2d_Circle
    from OCP.Geom2dAPI import Geom2dAPI_Interpolate
    from OCP.gp import gp_Ax2d, gp_Circ2d, gp_Dir2d, gp_Pnt2d
    from OCP.TColgp import TColgp_HArray1OfPnt2d

    for hole in net.holes:
        if hole[0] == "circle":
            curve = Geom2d_Circle(gp_Circ2d(gp_Ax2d(gp_Pnt2d(*hole[1]), gp_Dir2d(1, 0)), hole[2], False))
        else:
            points = TColgp_HArray1OfPnt2d(1, len(hole[1]))
            # Clockwise, as holes are; otherwise the mesher leaves out the control of the deflection.
            for k, p in enumerate(reversed(hole[1])):
                points.SetValue(k + 1, gp_Pnt2d(*p))
            made = Geom2dAPI_Interpolate(points, True, 1e-9)
            made.Perform()
            curve = made.Curve()
        make.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve, whole).Edge()).Wire())


def face(net):
    """The net in OpenCASCADE."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.BRepLib import BRepLib
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt
    from OCP.ShapeFix import ShapeFix_Face
    from OCP.TColgp import TColgp_Array2OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal

    u, v = net.surface.u, net.surface.v
    poles, weights = TColgp_Array2OfPnt(1, u.count, 1, v.count), TColStd_Array2OfReal(1, u.count, 1, v.count)
    for i in range(u.count):
        for j in range(v.count):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, net.surface.points[i, j])))
            weights.SetValue(i + 1, j + 1, float(net.surface.weights[i, j]))

    def knots(side):
        stops, often = TColStd_Array1OfReal(1, len(side.stops)), TColStd_Array1OfInteger(1, len(side.stops))
        for k, t in enumerate(side.stops):
            stops.SetValue(k + 1, float(t))
            often.SetValue(k + 1, side.degree + 1 if k in (0, len(side.stops) - 1) else 1)
        return stops, often

    (us, um), (vs, vm) = knots(u), knots(v)
    whole = Geom_BSplineSurface(poles, weights, us, vs, um, vm, u.degree, v.degree, False, False)
    made = BRepBuilderAPI_MakeFace(whole, 1e-7)
    add_holes(net, whole, made)
    made = made.Face()
    BRepLib.BuildCurves3d_s(made)
    fix = ShapeFix_Face(made)
    fix.Perform()
    return fix.Face()


def theirs(net, limit, most=2_000):
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.IMeshTools import IMeshTools_Parameters
    from OCP.TopLoc import TopLoc_Location

    made, wish = face(net), IMeshTools_Parameters()
    # An angle that never decides.
    wish.Deflection, wish.Angle, wish.InParallel, wish.Relative = limit, 20.0, False, False
    with Cpu() as cpu:
        BRepMesh_IncrementalMesh(made, wish)
    mesh = BRep_Tool.Triangulation_s(made, TopLoc_Location())
    if mesh is None:
        return {"failed": "no mesh"}
    nodes = [mesh.Node(k + 1) for k in range(mesh.NbNodes())]
    places = [mesh.UVNode(k + 1) for k in range(mesh.NbNodes())]
    points = np.array([(p.X(), p.Y(), p.Z()) for p in nodes])
    uv = np.array([(p.X(), p.Y()) for p in places])
    corners = np.array([mesh.Triangle(k + 1).Get() for k in range(mesh.NbTriangles())]) - 1
    return measured(net, points, corners, limit, uv, most) | {"seconds": round(cpu.seconds, 4)}


class Peer:
    """Figures of OpenCASCADE, kept in a file."""

    def __init__(self, path, live):
        self.path, self.live = path and pathlib.Path(path), live
        self.known = json.loads(self.path.read_text()) if self.path and self.path.exists() else {}

    def figures(self, name, net, limit):
        if name not in self.known and self.live:
            self.known[name] = {"limit": limit} | theirs(net, limit)
            if self.path:
                self.path.write_text(json.dumps(self.known, indent=1) + "\n")
        return self.known.get(name)


def compared(own, peer):
    """Ratios of one mesh to the peer's."""
    return {"count": round(own["triangles"] / peer["triangles"], 4), "times": round(peer["seconds"] / max(own["seconds"], 1e-3), 2)}


def tables(own, peers, chosen):
    for level in chosen:
        rows = [{k: v for k, v in row.items() if k not in ("case", "limit", "level")} for row in own if row["level"] == level]
        table(f"loft, limit {level}", rows)
        over = [(row["count"], row["case"]) for row in own if row["level"] == level and "count" in row]
        print(f"{'most triangles':>16} " + "; ".join(f"{share} {case}" for share, case in sorted(over, reverse=True)[:5]))
    if peers:
        table("OpenCASCADE", peers)


def write(folder, program):
    """Ten small nets for the tests, with the counts of OpenCASCADE."""
    truth, folder = {}, pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for seed in range(10):
        net = Net(seed, spans=(10, 16))
        limit = net.limits((1_500,))[0]
        (folder / f"net_{seed}.loft").write_text(f"// {net.kind}, {net.knots} knots; written by benches/peers/random_nets.py.\n\n" + net.loft(limit, name=""))
        truth[f"net_{seed}"] = {"limit": limit, "triangles": theirs(net, limit)["triangles"]}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("loft")
    ask.add_argument("--cases", type=int, default=50)
    ask.add_argument("--first", type=int, default=0)
    ask.add_argument("--limits", default="0,1,2")
    ask.add_argument("--display", action="store_true")
    ask.add_argument("--occt", action="store_true")
    ask.add_argument("--truth")
    ask.add_argument("--write")
    ask.add_argument("--draw")
    given = ask.parse_args()
    if given.write:
        write(given.write, given.loft)
        return 0
    own, others, failed, worst, peer = [], [], [], Worst(), Peer(given.truth, given.occt)
    chosen = [int(k) for k in given.limits.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.first, given.first + given.cases):
            net = Net(seed)
            for level, limit in enumerate(net.limits()):
                if level not in chosen:
                    continue
                case = f"{seed} {net.kind}, {net.knots} knots, weights {net.heavy}, drawn {net.drawn}, {len(net.holes)} holes"
                found = {"case": case, "level": level, "limit": limit}
                found |= ours(given.loft, net, limit, "  method: display" if given.display else "", folder)
                beside = peer.figures(f"{seed}/{level}", net, limit)
                if beside and "failed" not in beside and "failed" not in found:
                    found |= compared(found, beside)
                    others.append({k: v for k, v in beside.items() if k != "limit"})
                print(json.dumps(found), flush=True)
                (failed if "failed" in found else own).append(found)
                if given.draw and "failed" not in found:
                    points, corners, _ = read_obj(pathlib.Path(folder) / "net.obj")
                    worst.look(f"{seed}, {limit:.3g} mm", points, corners, ~at_corner(net, points)[corners].any(1)[:, None])
    tables(own, others, chosen)
    broken = [row["case"] for row in own if row["over"] > 1.0]
    print(f"\nfailed: {len(failed)}; limit not kept: {len(broken)} {broken}")
    if given.draw:
        worst.draw(given.draw)
    return 1 if failed or broken else 0


if __name__ == "__main__":
    sys.exit(main())
