"""usage: p10_hulls.py LOFT DIR    hydrostatics of the Wigley hull, by loft and by navaltoolbox 0.9.3 (`pip install navaltoolbox numpy`)

Writes wigley.stl (104 956 triangles, the sides upright above the water to z = 0.2, with a deck) and prints for each program the CPU seconds of what it does, from
differences of whole processes for loft, and how far the volume is from the closed form. The drafts lie beside the rows of the mesh and on one.
"""
import os
import resource
import subprocess
import sys
import time

import numpy as np

LOFT, FOLDER = os.path.abspath(sys.argv[1]), sys.argv[2]
L, B, T, TOP = 10.0, 1.0, 0.625, 0.2
os.makedirs(FOLDER, exist_ok=True)


def volume(draft):
    """Closed form of the volume below a draft."""
    z = draft - T
    return 2 / 3 * L * B * ((z - z**3 / (3 * T**2)) - (-T + T / 3))


def stl(path, along=320, up=80):
    x = np.linspace(-L / 2, L / 2, along + 1)
    z = np.r_[np.linspace(-T, 0, up + 1), TOP]
    x, z = np.meshgrid(x, z, indexing="ij")
    y = B / 2 * (1 - (2 * x / L) ** 2) * (1 - (np.minimum(z, 0) / T) ** 2)
    found = []
    for side in (1, -1):
        p = np.stack([x, side * y, z], -1)
        a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
        deck = [p[:-1, -1], p[1:, -1], p[1:, -1] * [1, 0, 1], p[:-1, -1] * [1, 0, 1]]
        for q in ([a, b, c, d], deck):
            q = [corner.reshape(-1, 3) for corner in (q if side < 0 else q[::-1])]
            found += [np.stack([q[0], q[1], q[2]], 1), np.stack([q[0], q[2], q[3]], 1)]
    triangles = np.concatenate(found).astype(np.float32)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    kept = np.linalg.norm(normals, axis=1) > 1e-12
    record = np.zeros(kept.sum(), dtype=[("n", "<3f4"), ("v", "<9f4"), ("a", "<u2")])
    record["n"], record["v"] = normals[kept], triangles[kept].reshape(-1, 9)
    with open(path, "wb") as out:
        out.write(b"\0" * 80 + np.uint32(len(record)).tobytes() + record.tobytes())
    return len(record)


def run(name, text):
    """Least CPU seconds of three whole runs, and what the last one printed."""
    with open(os.path.join(FOLDER, name), "w") as out:
        out.write(text)
    best = 1e9
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([LOFT, "check", name, "--threads", "1"], cwd=FOLDER, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        assert done.returncode == 0, done.stdout + done.stderr
    return best, done.stdout


SIDE = """units m
let side = bezier_surface([[(-5, 0, -0.625), (0, 0, -0.625), (5, 0, -0.625)], [(-5, 0, -0.3125), (0, 1, -0.3125), (5, 0, -0.3125)], [(-5, 0, 0), (0, 1, 0), (5, 0, 0)]])
let wall = ruled(side.v(1), move(side.v(1), by: (0, 0, 0.2)))
let edge = wall.v(1)
let deck = plane([edge, line(wall.at(1, 1), wall.at(0, 1))])
let hull = [side, wall, deck]
"""
MESH = 'units m\nimport "wigley.stl" as file\nlet hull = file.mesh\n'


def cases(prelude, states):
    rest = run("one.loft", prelude + "let one = hydrostatics(hull, draft: 0.4m, base: -0.625m)\n")[0]
    for label, count, text in states:
        print(f"loft, {label}: {1e3 * (run('more.loft', prelude + text)[0] - rest) / count:.2f} ms")
    return rest


n = stl(os.path.join(FOLDER, "wigley.stl"))
start = run("empty.loft", "units m\n")[0]
states = [
    ("a state", 500, "let rows = curves_of_form(hull, drafts: linspace(0.05m, 0.61m, 501), base: -0.625m)\n"),
    ("a state heeled by 10 degrees, trimmed by 1", 100, "let rows = curves_of_form(hull, drafts: linspace(0.05m, 0.5m, 101), heel: 10deg, trim: 1deg, base: -0.625m)\n"),
    (
        "GZ at 0 to 90 degrees by 5, free trim",
        1,
        "let one = hydrostatics(hull, draft: 0.4m, base: -0.625m)\nlet arms = righting_arms(hull, mass: 1500kg, cog: (0.1, 0, -0.3), heels: [for k in 0..19: k * 5deg], base: -0.625m)\n",
    ),
]
print("surfaces of one side, wall and deck")
print(f"loft, first state and whole process: {1e3 * (cases(SIDE, states) - start):.1f} ms over an empty script ({1e3 * start:.1f} ms)")
print(f"{n} triangles")
print(f"loft, read and first state: {1e3 * (cases(MESH, states[:2]) - start):.1f} ms over an empty script")
for draft in (0.4, 0.625 * 0.5):
    found = run("volume.loft", MESH + f'report "v": [{{v: hydrostatics(hull, draft: {draft}m, base: -0.625m).volume * 1e9 / 1m3}}]\n')[1]
    value = float(found.split("\nv\n")[1].split()[1]) * 1e-9
    print(f"loft, draft {draft}: volume off by {value / volume(draft) - 1:.2e}")

import navaltoolbox as nt

began = time.process_time()
hull = nt.Hull(os.path.join(FOLDER, "wigley.stl"))
calculator = nt.HydrostaticsCalculator(nt.Vessel(hull), 1000.0)
print(f"navaltoolbox, read: {1e3 * (time.process_time() - began):.1f} ms")
for draft in (0.4, 0.625 * 0.5):
    began = time.process_time()
    state = calculator.from_draft(draft - T, 0.0, 0.0)
    spent = time.process_time() - began
    print(f"navaltoolbox, draft {draft}: {1e3 * spent:.1f} ms, volume off by {state.volume / volume(draft) - 1:.2e}")
