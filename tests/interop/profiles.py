"""Random profiles of lines and arcs, extruded and turned, leave as planes, cylinders, cones, spheres and tori with lines and circles as edges:
python profiles.py LOFT WORK [SEED ...].

OpenCASCADE reads the STEP and IGES files of each and must find them valid, of these forms alone, and with the areas and volumes of the report to
1e-6 by its default integrals; the program reads both files again and must find the same areas, volumes and names to 1e-9. Arcs that are swept
obliquely, or turned about an axis that they reach over, have no such form: they are surfaces of extrusion and revolution in STEP files, and
splines in IGES files, of which the other kernel's integrals are only near.
"""
import json
import math
import os
import random
import shutil
import subprocess
import sys

from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IGESControl import IGESControl_Reader
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopoDS import TopoDS

from surfaces import parts

SEEDS = range(24)
SIZE = {"mm": 1.0, "in": 25.4, "m": 1000.0}
FORMS = {"Plane", "Cylinder", "Cone", "Sphere", "Torus"}
EDGES = {"Line", "Circle", "OtherCurve"}
KINDS = ["prism", "oblique", "hole", "ring", "part_ring", "meridian", "wedge", "plate"]
BACK = """units {unit}
import "thing.{ending}" as part
report "areas": [for s in part.surfaces: {{area: area(s)}}]
report "names": [for g in part.groups: {{name: g.name}}]
"""


def polygon(r, n, size):
    angles = sorted(2 * math.pi * (k + r.uniform(-0.3, 0.3)) / n for k in range(n))
    return [(size * r.uniform(0.6, 1) * math.cos(a), size * r.uniform(0.6, 1) * math.sin(a)) for a in angles]


def profile(r, s, place):
    """A closed profile about as large as `s`, in words; `place` gives the words of a point of its plane."""
    kind = r.choice(["round", "slot", "bulge", "fillet"])
    row = lambda points: f"polyline([{', '.join(place(*p) for p in points)}], closed: true"
    if kind == "round":
        return f"{row(polygon(r, r.randint(3, 7), s))}, round: {0.05 * s * r.uniform(0.3, 1)})"
    if kind == "slot":
        l, w = s * r.uniform(0.3, 0.8), s * r.uniform(0.1, 0.4)
        return (
            f"line({place(-l, -w)}, {place(l, -w)}) + arc({place(l, -w)}, {place(l, w)}, through: {place(l + w, 0)}) + "
            f"line({place(l, w)}, {place(-l, w)}) + arc({place(-l, w)}, {place(-l, -w)}, through: {place(-l - w, 0)})"
        )
    if kind == "fillet":
        corners = polygon(r, r.randint(4, 7), s)
        chosen = ", ".join(place(*p) for p in r.sample(corners, 2))
        return f"fillet({row(corners)}), at: [{chosen}], radius: {0.05 * s})"
    corners, pieces = polygon(r, r.randint(3, 6), s), []
    for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1]):
        h = r.uniform(0.05, 0.2)
        middle = place((a + c) / 2 + h * (d - b), (b + d) / 2 - h * (c - a))
        ends = f"{place(a, b)}, {place(c, d)}"
        pieces.append(f"line({ends})" if r.random() < 0.5 else f"arc({ends}, through: {middle})")
    return " + ".join(pieces)


def meridian(r, s, place):
    """A profile from the axis to the axis: a capsule or rounded corners."""
    if r.random() < 0.4:
        big, l = s * r.uniform(0.3, 1), s * r.uniform(0.2, 1)
        k = math.sqrt(0.5) * big
        return (
            f"arc({place(0, -l - big)}, {place(big, -l)}, through: {place(k, -l - k)}) + line({place(big, -l)}, {place(big, l)}) + "
            f"arc({place(big, l)}, {place(0, l + big)}, through: {place(k, l + k)})"
        )
    heights = sorted(r.uniform(-1, 1) * s for _ in range(r.randint(2, 4)))
    corners = [(s * r.uniform(0.5, 1), z) for z in heights]
    corners = [(0, corners[0][1])] + corners + [(0, corners[-1][1] + 0.4 * s)]
    radius = 0.03 * min(math.dist(a, b) for a, b in zip(corners, corners[1:]))
    return f"fillet(polyline([{', '.join(place(*p) for p in corners)}]), radius: {radius})"


def model(seed):
    """The kind of a random thing, its unit and its script."""
    r = random.Random(seed)
    kind, unit, ending = KINDS[seed % len(KINDS)], r.choice(["mm", "in", "m"]), r.choice(["mm", "inch", "m"])
    s = r.choice([1, 10, 50]) if unit != "m" else r.choice([0.05, 1, 3])
    turn, out = r.uniform(0, 6), [f"units {unit}"]
    flat = lambda a, b: f"({a!r}, {b!r}, 0)"
    angle = r.choice([30, 90, 180, round(r.uniform(5, 350), 1)])
    ends = [f"surface head = rotate(foot, axis: (0, 0, 1), angle: {angle}deg)", "shell thing of wall, foot, head"]
    if kind in ["prism", "oblique", "hole"]:
        by = (0, 0, s * r.uniform(0.2, 1)) if kind != "oblique" else tuple(s * r.uniform(0.2, 0.8) for _ in range(3))
        out += [f"curve rim = {profile(r, s, flat)}", f"surface wall = extrude(rim, by: {by})", "surface foot = plane(rim)"]
        if kind == "hole":
            out += [f"curve bore = {profile(r, 0.1 * s, flat)}", f"surface inner = extrude(bore, by: {by})"]
            out += ["surface floor = trim(foot, holes: bore)", f"surface head = move(floor, by: {by})", "shell thing of wall, inner, floor, head"]
        else:
            out += [f"surface head = move(foot, by: {by})", "shell thing of wall, foot, head"]
    elif kind in ["ring", "part_ring"]:
        far = s * r.uniform(1.3, 3)
        place = lambda a, b: f"({(far + a) * math.cos(turn)!r}, {(far + a) * math.sin(turn)!r}, {b!r})"
        out += [f"curve rim = {profile(r, s, place)}"]
        if kind == "ring":
            out += ["surface wall = revolve(rim)", "shell thing of wall"]
        else:
            out += [f"surface wall = revolve(rim, angle: {angle}deg)", "surface foot = plane(rim)"] + ends
    elif kind in ["meridian", "wedge"]:
        out += [f"curve rim = {meridian(r, s, lambda a, b: f'({a * math.cos(turn)!r}, {a * math.sin(turn)!r}, {b!r})')}"]
        if kind == "meridian":
            out += ["surface wall = revolve(rim)", "shell thing of wall"]
        else:
            out += [f"surface wall = revolve(rim, angle: {angle}deg)", "surface foot = plane(rim, line(rim.end, rim.start))"] + ends
    else:
        out += [f"curve rim = {profile(r, s, flat)}", "surface thing = plane(rim)"]
    out += [f'export thing to "thing.{e}" {{ units: {ending} }}' for e in ["step", "igs"]]
    return kind, unit, "\n".join(out) + "\n"


def run(loft, folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    done = subprocess.run([loft, "run", path, "-o", folder, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{name} ends with {done.returncode}: {done.stdout[-600:]} {done.stderr[-300:]}")
    return json.loads(done.stdout)


def near(what, found, wanted, share):
    if abs(found - wanted) > share * abs(wanted):
        raise AssertionError(f"{what}: {found!r} for {wanted!r}")


def forms(shape):
    """The forms of the faces and edges of a shape."""
    name = lambda kind: str(kind).rsplit("_", 1)[1]
    faces = {name(BRepAdaptor_Surface(TopoDS.Face_s(face)).GetType()) for face in parts(shape, TopAbs_FACE)}
    return faces, {name(BRepAdaptor_Curve(TopoDS.Edge_s(edge)).GetType()) for edge in parts(shape, TopAbs_EDGE)}


def judge(folder, kind, ending, area, volume):
    """What the other kernel finds in a file against the area and volume of the report, millimetres."""
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    reader = STEPControl_Reader() if ending == "step" else IGESControl_Reader()
    reader.ReadFile(os.path.join(folder, f"thing.{ending}"))
    reader.TransferRoots()
    shape = reader.OneShape()
    if not BRepCheck_Analyzer(shape).IsValid():
        raise AssertionError(f"{ending}: not valid")
    faces, edges = forms(shape)
    others = faces - FORMS
    allowed = {"SurfaceOfRevolution", "SurfaceOfExtrusion"} if ending == "step" else {"BSplineSurface"}
    if others - allowed or others and kind not in ["oblique", "part_ring", "ring", "meridian", "wedge"] or edges - EDGES:
        raise AssertionError(f"{ending}: {faces}, {edges}")
    share = 1e-3 if others and ending == "igs" else 1e-6
    areas, volumes = GProp_GProps(), GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, areas)
    BRepGProp.VolumeProperties_s(shape, volumes)
    near(f"{ending}: area", areas.Mass(), area, share)
    if volume:
        near(f"{ending}: volume", volumes.Mass(), volume, share)


def check(loft, work, seed):
    """One random thing, in both formats."""
    kind, unit, text = model(seed)
    folder = os.path.join(work, f"profile_{seed}")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    made = run(loft, folder, "thing.loft", text)
    whole = (made["shells"] or [s for s in made["surfaces"] if s["name"] == "thing"])[0]
    area, volume = whole["area"], whole.get("volume")
    for ending in ["step", "igs"]:
        judge(folder, kind, ending, area * SIZE[unit] ** 2, volume and volume * SIZE[unit] ** 3)
        more = 'report "volume": part.volume\n' if volume else ""
        back = {report["title"]: report["rows"] for report in run(loft, folder, f"back_{ending}.loft", BACK.format(unit=unit, ending=ending) + more)["reports"]}
        near(f"{ending}: area of what is read back", sum(row[0] for row in back["areas"]), area, 1e-9)
        if volume:
            near(f"{ending}: volume of what is read back", back["volume"][0][0], volume, 1e-9)
        # A face by itself is called that, and its body the second of this name.
        if not {"thing", "thing_2"} & {row[0] for row in back.get("names", [["thing"]])}:
            raise AssertionError(f"{ending}: names {back['names']}")


if __name__ == "__main__":
    program, scratch = (os.path.abspath(path) for path in sys.argv[1:3])
    wrong = 0
    for chosen in [int(word) for word in sys.argv[3:]] or SEEDS:
        try:
            check(program, scratch, chosen)
        except AssertionError as error:
            wrong += 1
            print(f"{chosen} {KINDS[chosen % len(KINDS)]}: {error}", flush=True)
    print(f"{wrong} wrong")
    sys.exit(1 if wrong else 0)
