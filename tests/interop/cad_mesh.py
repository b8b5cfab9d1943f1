"""Parts of an independent kernel (OpenCASCADE) are meshed by every method: python cad_mesh.py LOFT WORK [NAME ...] prints a table, a row for each
part and method: elements, worst angle, the largest distance of sampled points from the part against the limit, and what does not hold.

A row is right when every side of an element is used twice, once in each direction, unless the part has a free edge there; the Euler number is the
one of the part's vertices, edges and faces; area and volume differ from the part's by what the limit allows; and no sampled point is farther from
the part than the limit. Limits are a share of the part's size.
"""
import collections
import json
import math
import os
import random
import shutil
import subprocess
import sys

import numpy
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.Bnd import Bnd_Box
from OCP.Geom import Geom_SurfaceOfRevolution
from OCP.GeomAPI import GeomAPI_ProjectPointOnCurve
from OCP.Message import Message
from OCP.STEPControl import STEPControl_Controller
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.TopAbs import TopAbs_EDGE, TopAbs_SOLID, TopAbs_VERTEX, TopAbs_WIRE
from OCP.TopExp import TopExp
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.TopoDS import TopoDS
from OCP.gp import gp_Ax3, gp_Dir, gp_Lin, gp_Pnt, gp_Trsf, gp_Vec

import cad_in
import more_parts
import parts
import tables
from bodies import free_edges

METHODS = ["auto", "delaunay", "isoline", "quadtree", "display", "quads"]
# The chord error as a share of the square root of the area.
SHARE = 3e-3
# Points of a mesh that are compared with the part.
SAMPLES = 200
LONGEST = 240
# What is known not to hold: part and method, and why.
OPEN = "the other kernel leaves the seam of the net open, which is closed here: its Euler number is that of a strip"
KNOWN = {f"offset_net_ring_all {m}": OPEN for m in METHODS}

MODEL = """units mm
import "{file}" as part
{meshes}
"""


def settings(method):
    return "elements: quads" if method == "quads" else f"method: {method}"


def distinct(shape, kind):
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(k) for k in range(1, found.Extent() + 1)]


def borders(face):
    """Borders of a face that do not touch each other: wires, of which those that share a vertex are one."""
    apart = []
    for wire in distinct(face, TopAbs_WIRE):
        corners = distinct(wire, TopAbs_VERTEX)
        touched = [b for b in apart if any(a.IsSame(c) for a in b for c in corners)]
        apart = [b for b in apart if b not in touched] + [corners + [c for b in touched for c in b]]
    return len(apart)


def euler_of(shape):
    """The Euler number of the faces of a shape: a face is a disk without its borders in its own parameters, where seams cut it open."""
    edges = [e for e in distinct(shape, TopAbs_EDGE) if not BRep_Tool.Degenerated_s(TopoDS.Edge_s(e))]
    return len(distinct(shape, TopAbs_VERTEX)) - len(edges) + sum(2 - borders(f) for f in parts.faces(shape))


class Truth:
    """What the mesh of a part must equal."""

    def __init__(self, name, shape):
        bodies = parts.parts_of(shape, TopAbs_SOLID)
        self.name = name
        self.is_closed = not free_edges(shape)
        self.area = sum(cad_in.areas_of(name, parts.faces(shape)))
        self.volume = cad_in.volume(shape) if bodies else None
        self.euler = sum(euler_of(body) for body in bodies) if bodies else euler_of(shape)
        self.error = float(f"{SHARE * math.sqrt(self.area):.2g}")
        self.faces = []
        for face in parts.faces(shape):
            box = Bnd_Box()
            BRepBndLib.AddOptimal_s(face, box, False, False)
            box.Enlarge(2 * self.error)
            self.faces.append((box, BRep_Tool.Surface_s(face), ShapeAnalysis_Surface(BRep_Tool.Surface_s(face))))

    def distance(self, point):
        """From the surfaces of the faces that are near a point."""
        at = gp_Pnt(*point)
        least = math.inf
        for box, surface, projection in self.faces:
            if least > self.error / 2 and not box.IsOut(at):
                least = min(least, projection.Value(projection.ValueOfUV(at, 1e-7)).Distance(at))
                if least > self.error and isinstance(surface, Geom_SurfaceOfRevolution):
                    least = min(least, to_profile(surface, at))
        return least


def to_profile(surface, at):
    """Distance from a surface of revolution, where the other kernel's projection may fail: turned into the plane of its profile."""
    axis, curve = surface.Axis(), surface.BasisCurve()
    line = gp_Lin(axis)
    low, high = max(curve.FirstParameter(), -1.0), min(curve.LastParameter(), 1.0)
    outside = max((curve.Value(low + (high - low) * k / 7) for k in range(8)), key=line.Distance)
    frame = gp_Ax3(axis.Location(), axis.Direction(), gp_Dir(gp_Vec(axis.Location(), outside)))
    flat = gp_Trsf()
    flat.SetTransformation(frame)
    x, y, z = (lambda p: (p.X(), p.Y(), p.Z()))(at.Transformed(flat))
    sides = [gp_Pnt(s * math.hypot(x, y), 0, z).Transformed(flat.Inverted()) for s in (1, -1)]
    ends = [curve.Value(end) for end in (curve.FirstParameter(), curve.LastParameter()) if abs(end) < 1e100]
    found = [GeomAPI_ProjectPointOnCurve(p, curve) for p in sides]
    near = [f.LowerDistance() for f in found if f.NbPoints()] + [p.Distance(end) for p in sides for end in ends]
    return min(near, default=math.inf)


def read_obj(path):
    nodes, elements = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("v "):
                nodes.append([float(x) for x in line.split()[1:4]])
            elif line.startswith("f "):
                elements.append([int(x.split("/")[0]) - 1 for x in line.split()[1:]])
    return numpy.array(nodes), elements


def measured(truth, path, pick):
    """What does not hold of a mesh, and the largest distance of its sampled points as a share of the limit."""
    nodes, elements = read_obj(path)
    wrong = []
    sides = collections.Counter((e[k], e[(k + 1) % len(e)]) for e in elements for k in range(len(e)))
    free = sum((b, a) not in sides for a, b in sides)
    if max(sides.values()) > 1:
        wrong.append("sides used twice in one direction")
    if free and truth.is_closed:
        wrong.append(f"{free} free sides")
    euler = len({n for e in elements for n in e}) - len({(min(s), max(s)) for s in sides}) + len(elements)
    if euler != truth.euler:
        wrong.append(f"Euler number {euler}, not {truth.euler}")
    area = volume = 0.0
    triangles = [t for e in elements for t in ([e] if len(e) == 3 else [[e[0], e[1], e[2]], [e[0], e[2], e[3]]])]
    corners = nodes[numpy.array(triangles)]
    cross = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = numpy.linalg.norm(cross, axis=1).sum() / 2
    volume = (corners[:, 0] * cross).sum() / 6
    if truth.volume and abs(abs(volume) - truth.volume) > truth.error * truth.area:
        wrong.append(f"volume {volume / truth.volume:.6f}")
    if truth.volume and volume < 0:
        wrong.append("inside out")
    if abs(area / truth.area - 1) > 0.06:
        wrong.append(f"area {area / truth.area:.6f}")
    worst = 0.0
    for _ in range(SAMPLES):
        corner = corners[pick.randrange(len(corners))]
        share = [pick.random() for _ in range(3)]
        worst = max(worst, truth.distance(sum(w * p for w, p in zip(share, corner)) / sum(share)))
    if worst > truth.error * (1 + 1e-6):
        wrong.append(f"{worst / truth.error:.3g} times the limit")
    return wrong, worst / truth.error


def rows_of(loft, work, truth):
    """The rows of one part, and whether each is right."""
    folder = os.path.join(work, f"{truth.name}_mesh")
    file = f"{truth.name}.step"
    rows = []
    asked = {m: f"mesh {m} of part {{ {settings(m)} chord_error: {truth.error}mm }}\nexport {m} to \"{m}.obj\"" for m in METHODS}

    def run(methods):
        path = os.path.join(folder, "part.loft")
        with open(path, "w", encoding="utf-8") as out:
            out.write(MODEL.format(file=file, meshes="\n".join(asked[m] for m in methods)))
        done = subprocess.run([loft, "run", path, "-o", folder, "--json"], capture_output=True, text=True, timeout=LONGEST)
        return done.returncode, json.loads(done.stdout) if done.stdout.startswith("{") else {}, done.stderr

    # A mesh that fails stops the exports; each is then asked for by itself.
    try:
        code, report, err = run(METHODS)
        reports = {m: (code, report, err) for m in METHODS}
    except subprocess.TimeoutExpired:
        code = None
    if code != 0:
        reports = {}
        for m in METHODS:
            try:
                reports[m] = run([m])
            except subprocess.TimeoutExpired:
                reports[m] = (None, {}, f"more than {LONGEST} s")
    pick = random.Random(truth.name)
    for m in METHODS:
        code, report, err = reports[m]
        mesh = next((x for x in report.get("meshes", []) if x["name"] == m), None)
        cells = {"part": truth.name, "method": m, "elements": None, "angle": None, "share": None, "why": ""}
        if code != 0 or mesh is None:
            cells["why"] = next((f"{d['code']} {d['message']}" for d in report.get("diagnostics", []) if d["severity"] == "error"), f"{code} {err[-200:]}")
        else:
            wrong, cells["share"] = measured(truth, os.path.join(folder, f"{m}.obj"), pick)
            cells["elements"], cells["angle"] = mesh["triangles"] + mesh["quads"], mesh["min_angle"]
            if mesh["watertight"] != truth.is_closed:
                wrong.append(f"watertight: {mesh['watertight']}")
            if mesh["chord_error"] > truth.error:
                wrong.append("reports more than the limit")
            cells["why"] = ", ".join(wrong)
        rows.append((cells, not cells["why"]))
    return rows


def shown(cells):
    number = lambda x, digits: "" if x is None else f"{x:.{digits}f}"
    return (
        f"{cells['part']:<20} {cells['method']:<9} {cells['elements'] or '':>8} {number(cells['angle'], 1):>6} {number(cells['share'], 3):>6} {cells['why'][:230]}"
    ).rstrip()


def table(loft, work, chosen=()):
    """Prints all rows; the labels of those that are wrong for no known cause, and how many there are in all."""
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    STEPControl_Controller.Init_s()
    truths = []
    for name, make in parts.PARTS + more_parts.PARTS:
        if chosen and name not in chosen:
            continue
        shape = make()
        folder = os.path.join(work, f"{name}_mesh")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        cad_in.write(shape, os.path.join(folder, f"{name}.step"), "ap242")
        truths.append(Truth(name, shape))
    print(f"{'part':<20} {'method':<9} {'elements':>8} {'angle':>6} {'error':>6} cause", flush=True)
    label_of = lambda cells: f"{cells['part']} {cells['method']}"
    return tables.judged(truths, lambda truth: rows_of(loft, work, truth), shown, label_of, KNOWN)


if __name__ == "__main__":
    sys.exit(tables.main(table))
