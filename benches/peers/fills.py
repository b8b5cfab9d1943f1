"""Holes filled, against OpenCASCADE's BRepFill_Filling: python fills.py LOFT [--seeds FIRST LAST] [--alone]

Without seeds ten holes of three to eight sides in a sphere, both sides of a torus and a bumpy spline surface; with seeds random ones. Writes for
each hole what both programs make of it for tangent planes (order 1) and curvatures (order 2): the largest distance from the surface that the
hole was cut out of, and poles; of LOFT also the largest gap, angle and difference of curvature at its borders and between its patches. Needs
cadquery-ocp (tests/interop/requirements.txt), with --alone nothing.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

BASES = {
    "sphere": "rotate(revolve(arc((100*cos(55deg),0,-100*sin(55deg)), (100*cos(55deg),0,100*sin(55deg)), through: (100,0,0)), angle: 110deg),"
    " axis: (0,0,1), angle: -55deg)",
    "torus": "rotate(revolve(arc((60+25*cos(100deg),0,-25*sin(100deg)), (60+25*cos(100deg),0,25*sin(100deg)), through: (85,0,0)), angle: 80deg),"
    " axis: (0,0,1), angle: -40deg)",
    "saddle": "rotate(revolve(arc((60-25*cos(100deg),0,-25*sin(100deg)), (60-25*cos(100deg),0,25*sin(100deg)), through: (35,0,0)), angle: 80deg),"
    " axis: (0,0,1), angle: -40deg)",
    "bumpy": "rotate(grid([for j in 0..41: [for i in 0..41: ((i-20)*3, (j-20)*3, bump((i-20)*3, (j-20)*3))]]), axis: (0,1,0), angle: 90deg)",
}
# Surface, sides, radius of the hole, turn.
TEN = [
    ("sphere", 3, 20, 10), ("sphere", 5, 20, 10), ("sphere", 6, 30, 0), ("torus", 5, 14, 10), ("torus", 7, 12, 33),
    ("saddle", 5, 12, 20), ("saddle", 3, 12, 5), ("bumpy", 6, 20, 10), ("bumpy", 7, 18, 3), ("bumpy", 8, 22, 11),
]


def script(base, corners):
    points = ", ".join(f"(150, {y:.6f}, {z:.6f})" for y, z in corners)
    return f"""units mm
fn bump(x, y) = 4*sin(x*3deg)*cos(y*2.2deg) + 0.004*x*x - 0.003*x*y
surface whole = {BASES[base]}
let c = [{points}]
let n = len(c)
let rim = [for k in 0..n: project(line(c[k], c[mod(k+1,n)]), onto: whole, along: (1,0,0))]
surface cap = trim(whole, holes: [rim])
let one = fill(rim, to: [cap], order: 1)
let two = fill(rim, to: [cap], order: 2)
fn off(f) = max([for p in f: max([for i in 0..7: max([for j in 0..7: distance(p.at(i/6, j/6), whole)])])]) / 1mm
shell s1 of cap, one
shell s2 of cap, two
let joints = [for j in connection(s1): {{gap: j.gap_max, angle: j.angle_max, bend: j.curvature_max}}]
let bends = [for j in connection(s2): {{gap: j.gap_max, angle: j.angle_max, bend: j.curvature_max}}]
fn worst(all) = [{{gap: max([for j in all: j.gap]) / 1mm, angle: max([for j in all: j.angle]) / 1deg, bend: max([for j in all: j.bend]) * 1mm}}]
report "off" : [{{one: off(one), two: off(two)}}]
report "joints" : worst(joints)
report "bends" : worst(bends)
export cap to "cap.step"
"""


def polygon(sides, radius, turn, wobble=None):
    out = []
    for k in range(sides):
        a, r = 360 * k / sides + turn, radius
        if wobble:
            a, r = a + wobble.uniform(-0.25, 0.25) * 360 / sides, r * wobble.uniform(0.7, 1.2)
        out.append((3 + r * math.cos(math.radians(a)), 2 + r * math.sin(math.radians(a))))
    return out


def numbers(text, name):
    lines = text.split("\n" + name + "\n")[-1].split("\n")
    return dict(zip(lines[0].split(), (float(x) for x in lines[1].split())))


def ours(loft, base, corners, folder):
    path = os.path.join(folder, "hole.loft")
    with open(path, "w") as out:
        out.write(script(base, corners))
    run = subprocess.run([loft, "run", path, "-o", folder], capture_output=True, text=True)
    try:
        record = {name: numbers(run.stdout, name) for name in ("off", "joints", "bends")}
    except (IndexError, ValueError):
        record = {"failed": run.stderr[-800:]}
    codes = sorted({w for w in run.stderr.split() if len(w) == 4 and w[0] in "EWN" and w[1:].isdigit()})
    return {**record, "codes": codes}


def peer(folder):
    from OCP.BRep import BRep_Tool
    from OCP.BRepClass import BRepClass_FaceClassifier
    from OCP.BRepFill import BRepFill_Filling
    from OCP.BRepTools import BRepTools
    from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
    from OCP.GeomAbs import GeomAbs_C1, GeomAbs_G1
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_OUT, TopAbs_WIRE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS
    from OCP.gp import gp_Pnt2d

    reader = STEPControl_Reader()
    reader.ReadFile(os.path.join(folder, "cap.step"))
    reader.TransferRoots()
    face = TopoDS.Face(TopExp_Explorer(reader.OneShape(), TopAbs_FACE).Current())
    outer, wires = BRepTools.OuterWire_s(face), TopExp_Explorer(face, TopAbs_WIRE)
    while wires.Current().IsSame(outer):
        wires.Next()
    whole, record = BRep_Tool.Surface_s(face), {}
    # The filler reads the numbers 0, 1, 2 of continuity as G0, G1, G2.
    for name, order in (("one", GeomAbs_G1), ("two", GeomAbs_C1)):
        filling, edges = BRepFill_Filling(), TopExp_Explorer(wires.Current(), TopAbs_EDGE)
        while edges.More():
            filling.Add(TopoDS.Edge(edges.Current()), face, order)
            edges.Next()
        try:
            filling.Build()
            made = filling.Face()
            surface, (u0, u1, v0, v1) = BRep_Tool.Surface_s(made), BRepTools.UVBounds_s(made)
            far, n = 0.0, 16
            for u, v in ((u0 + (u1 - u0) * i / n, v0 + (v1 - v0) * j / n) for i in range(n + 1) for j in range(n + 1)):
                if BRepClass_FaceClassifier(made, gp_Pnt2d(u, v), 1e-9).State() != TopAbs_OUT:
                    far = max(far, GeomAPI_ProjectPointOnSurf(surface.Value(u, v), whole).LowerDistance())
            record[name] = {"off": far, "poles": surface.NbUPoles() * surface.NbVPoles()}
        except Exception as error:
            record[name] = {"failed": str(error)}
    return record


def main():
    loft, alone = sys.argv[1], "--alone" in sys.argv
    holes = [(f"{base} {sides}", base, polygon(sides, radius, turn)) for base, sides, radius, turn in TEN]
    if "--seeds" in sys.argv:
        at = sys.argv.index("--seeds")
        holes = []
        for seed in range(int(sys.argv[at + 1]), int(sys.argv[at + 2]) + 1):
            r = random.Random(seed)
            base, sides = r.choice(list(BASES)), r.randint(3, 8)
            radius = r.uniform(4, {"sphere": 35, "torus": 15, "saddle": 13, "bumpy": 25}[base])
            holes.append((f"seed {seed}: {base} {sides}", base, polygon(sides, radius, r.uniform(0, 360), r)))
    for name, base, corners in holes:
        with tempfile.TemporaryDirectory() as folder:
            record = {"hole": name, "loft": ours(loft, base, corners, folder)}
            if not alone:
                record["occt"] = peer(folder) if os.path.exists(os.path.join(folder, "cap.step")) else None
            print(json.dumps(record), flush=True)


if __name__ == "__main__":
    main()
