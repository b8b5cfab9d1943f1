"""An independent kernel (OpenCASCADE) reads the STEP files that models write: python step_out.py LOFT WORK [NAME ...] prints a table, a row for
each thing written: faces, how many of them are valid, the ratios of area and volume to those of the report, free edges there and here.

Every example, every model of models/surfaces and models/step, the goldens of trims and some of surfaces go out whole: each surface by itself and
each shell, the shells as IGES too (`iges_out`), and both files of a shell are also read by gmsh (`cad_gmsh`). A row is right when the other kernel finds the shape valid, as many faces as the report has patches, the area to 1e-6, a closed shell as a
solid without free edges with its volume to 1e-6, and the name. What is known not to hold is in `KNOWN` with its cause.
"""
import glob
import json
import os
import re
import shutil
import subprocess
import sys

from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.XCAFDoc import XCAFDoc_DocumentTool

import cad_gmsh
import iges_out
import tables
from bodies import document_of, judge, name_of

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
LONGEST = 300
# What is known not to hold, and why.
GAPS = "borders that became one edge are apart by more than that, as the model allows"
PARABOLAS = "the other kernel takes too few points for the area of one biquadratic patch; by 80 x 80 Gauss points of the face it read the areas agree to 1e-13"
THIN = "a thin wall between surfaces that are within the tolerance"
VOLUME_ONLY = "the areas of a thin wall agree, its volume does not: the cause is not found"
ALONG = "a cut that runs along the seam within the tolerance"
NET = "the other kernel projects edges onto nets within a tolerance of its own"
KNOWN = {
    "bracket: glued": GAPS,
    "fender: fender": GAPS,
    "gap_meshes: wave": GAPS,
    "glued: roof": GAPS,
    "shallow_crossings: octant": ALONG,
    "shell_walls: casing": THIN,
    "walls: net": NET,
    "walls: pane": VOLUME_ONLY,
    "wigley: hull": PARABOLAS,
    "wigley: side": PARABOLAS,
}
# The same faces go out as IGES.
KNOWN |= {f"{name} (IGES)": KNOWN[name] for name in ["bracket: glued", "fender: fender", "glued: roof", "walls: pane", "wigley: hull"]}
# Goldens of surfaces that go out: sweeps, skins, walls, corners.
SURFACES = ["gap_meshes", "joined_turned", "net_reports", "round_corners", "shell_walls", "skin_ends", "sweeps", "walls"]


def read(path):
    """The document of a file."""
    reader = STEPCAFControl_Reader()
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    reader.SetPropsMode(True)
    return document_of(reader, path)


def shapes_of(document):
    """(name, shape) of every named thing: the roots and what stands below them."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    roots, found = TDF_LabelSequence(), []
    tool.GetFreeShapes(roots)

    def walk(label):
        found.append((name_of(label), tool.GetShape_s(label)))
        below = TDF_LabelSequence()
        if not tool.GetComponents_s(label, below):
            tool.GetSubShapes_s(label, below)
        for k in range(1, below.Length() + 1):
            inner = below.Value(k)
            refers = TDF_Label()
            walk(refers if tool.GetReferredShape_s(inner, refers) else inner)

    for k in range(1, roots.Length() + 1):
        walk(roots.Value(k))
    return found, [tool.GetShape_s(roots.Value(k)) for k in range(1, roots.Length() + 1)]


def run(loft, folder, script, text):
    path = os.path.join(folder, script)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    done = subprocess.run([loft, "run", path, "-o", folder, "--json"], capture_output=True, text=True, timeout=LONGEST)
    return done.returncode, json.loads(done.stdout) if done.stdout.startswith("{") else {}, done.stdout[-1500:] + done.stderr[-1500:]


def rows_of(loft, work, model, schema="ap242", unit="mm"):
    """Rows of one model: its surfaces and its shells, each in a file of its own, and all in one."""
    name = os.path.splitext(os.path.basename(model))[0]
    folder = os.path.join(work, name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    with open(model, encoding="utf-8") as file:
        text = file.read()
    for data in glob.glob(os.path.join(os.path.dirname(model), "data")):
        shutil.copytree(data, os.path.join(folder, "data"))
    for other in glob.glob(os.path.join(os.path.dirname(model), "*.loft")):
        shutil.copy(other, folder)
    done = subprocess.run([loft, "check", os.path.join(folder, os.path.basename(model)), "--json"], capture_output=True, text=True, timeout=LONGEST)
    report = json.loads(done.stdout)
    things = [("shell", s) for s in report["shells"]] + [("surface", s) for s in report["surfaces"]]
    if not things:
        return []
    if done.returncode != 0:
        return [({"thing": name, "why": f"the model by itself ends with {done.returncode}"}, False)]
    refused = []
    while True:
        exports = "".join(
            f'\nexport {thing["name"]} to "one_{k}.step" {{ schema: {schema}  units: {unit} }}' for k, (_, thing) in enumerate(things)
        )
        exports += "".join(
            f'\nexport {thing["name"]} to "one_{k}.igs" {{ units: {unit} }}' for k, (kind, thing) in enumerate(things) if kind == "shell"
        )
        code, made, said = run(loft, folder, f"{name}_out.loft", text + exports)
        if code == 0:
            break
        # What has no spline form is said so, each by its name; the others go out without it.
        told = {}
        for d in made.get("diagnostics", []):
            for thing in re.findall("^`([^`]+)`: ", d["message"]) if d["code"] == "E805" else []:
                told[thing] = f"{d['code']} {d['message']}"
        if not told:
            return [({"thing": name, "why": f"ended with {code}: {said[-400:]}"}, False)]
        refused += [({"thing": f"{name}: {thing}", "why": why}, False) for thing, why in told.items()]
        things = [(kind, thing) for kind, thing in things if thing["name"] not in told]
    size = {"mm": 1.0, "m": 1000.0, "cm": 10.0, "inch": 25.4, "in": 25.4, "ft": 304.8, "um": 1e-3}[report["unit"] if "unit" in report else report["units"]]
    rows = refused
    shells = [os.path.join(folder, f"one_{k}.{ending}") for k, (kind, _) in enumerate(things) if kind == "shell" for ending in ["step", "igs"]]
    by_gmsh = cad_gmsh.read(shells) if shells else {}
    for k, (kind, thing) in enumerate(things):
        path, label = os.path.join(folder, f"one_{k}.step"), f"{name}: {thing['name']}"
        rows.append(row(path, label, kind, thing, size))
        if kind == "shell":
            iges = path.replace(".step", ".igs")
            rows.append(iges_out.row(iges, f"{label} (IGES)", thing, size))
            for file, words, (cells, _) in [(path, "gmsh", rows[-2]), (iges, "gmsh, IGES", rows[-1])]:
                rows.append(cad_gmsh.row(by_gmsh[file], f"{label} ({words})", thing, size, cells["faces"]))
    return rows


def row(path, label, kind, thing, size):
    cells = {"thing": label, "kind": kind, "faces": None, "area": None, "volume": None, "free": None, "why": ""}
    try:
        document = read(path)
        named, roots = shapes_of(document)
    except AssertionError as error:
        return {**cells, "why": str(error)}, False
    why = judge(cells, roots, thing, kind, size)
    if kind == "shell" and not any(n == thing["name"] for n, _ in named):
        why.append(f"names {sorted({n for n, _ in named})[:4]}")
    cells["why"] = ", ".join(why)
    return cells, not why


def shown(cells):
    number = lambda x: "" if x is None else f"{x:.9f}"
    return (
        f"{cells['thing']:<34} {cells.get('kind', ''):<8} {cells.get('faces') or 0:>5} {number(cells.get('area')):>13} "
        f"{number(cells.get('volume')):>13} {cells.get('free') if cells.get('free') is not None else '':>5} {cells['why'][:400]}"
    ).rstrip()


def models():
    patterns = ["examples/*.loft", "tests/interop/models/surfaces/*.loft", "tests/interop/models/step/*.loft"]
    patterns += ["tests/golden/trims/*.loft"] + [f"tests/golden/surfaces/{name}.loft" for name in SURFACES]
    return [path for pattern in patterns for path in sorted(glob.glob(os.path.join(ROOT, pattern)))]


def table(loft, work, chosen=()):
    """Prints all rows; the labels of those that are wrong, and how many there are in all."""
    print(f"{'thing':<34} {'kind':<8} {'faces':>5} {'area':>13} {'volume':>13} {'free':>5} cause", flush=True)
    jobs = [m for m in models() if not chosen or os.path.splitext(os.path.basename(m))[0] in chosen]
    return tables.judged(jobs, lambda model: rows_of(loft, work, model), shown, lambda cells: cells["thing"], KNOWN, workers=1)


if __name__ == "__main__":
    sys.exit(tables.main(table))
