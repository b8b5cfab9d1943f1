"""Peers of `cargo bench --bench network`: the same curves, noded by others; one JSON line per run.

usage: network.py occt|shapely planar|ruled N      N: number of planar curves, or of curves per family (ruled)

Needs `pip install gmsh` (OpenCASCADE's boolean fragment) or `pip install shapely numpy` (GEOS union of 64-chord
polylines: approximate nodes, right counts). CPU time of the noding alone, inputs not included.
"""
import json
import math
import sys
import time


def lcg(x):
    while True:
        x = (x * 6364136223846793005 + 1442695040888963407) % 2**64
        yield (x >> 11) / 2**53


def planar(n):
    r = lcg(7)
    curves = []
    for k in range(n):
        a, b = 100 * next(r), 100 * next(r)
        c, d = 16 * next(r) - 8, 16 * next(r) - 8
        at = (lambda s, t: (s, t, 0.0)) if (k // 3) % 2 == 0 else (lambda s, t: (t, s, 0.0))
        if k % 3 == 0:
            curves.append(("line", [at(0, a), at(100, b)]))
        elif k % 3 == 1:
            curves.append(("arc", [at(0, a), at(50, (a + b) / 2 + c + (1 if c >= 0 else -1)), at(100, b)]))
        else:
            curves.append(("bezier", [at(0, a), at(33, a + (b - a) / 3 + 2 * c), at(66, b - (b - a) / 3 + 2 * d), at(100, b)]))
    return curves


def ruled(m):
    at = lambda x, y: (x, y, x * y / 50)
    steps = [100 * (i + 0.5) / m for i in range(m)]
    curves = [("line", [at(x, 0), at(x, 100)]) for x in steps] + [("line", [at(0, y), at(100, y)]) for y in steps]
    for i in range(m):
        c = 100 * (i + 0.37) / m - 50
        x0, x1 = max(0, -c), min(100, 100 - c)
        xm = (x0 + x1) / 2
        curves.append(("bezier", [at(x0, x0 + c), (xm, xm + c, (x0 * x1 + c * xm) / 50), at(x1, x1 + c)]))
    return curves


def occt(curves):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    make = gmsh.model.occ
    ids = []
    for kind, poles in curves:
        p = [make.addPoint(*x) for x in poles]
        ids.append(make.addLine(*p) if kind == "line" else make.addCircleArc(*p, center=False) if kind == "arc" else make.addBezier(p))
    pairs = [(1, i) for i in ids]
    start = time.process_time()
    make.fragment(pairs[:1], pairs[1:])
    cpu = time.process_time() - start
    make.synchronize()
    links = gmsh.model.getEntities(1)
    nodes = {d[1] for link in links for d in gmsh.model.getBoundary([link], oriented=False)}
    return len(nodes), len(links), cpu


def shapely(curves, chords=64):
    import numpy as np
    from shapely import LineString, MultiLineString, get_coordinates, get_parts, union_all

    t = np.linspace(0, 1, chords + 1)[:, None]
    lines = []
    for kind, poles in curves:
        p = np.array(poles)[:, :2]
        if kind == "line":
            q = p
        elif kind == "bezier":
            n = len(p) - 1
            q = sum(math.comb(n, i) * t**i * (1 - t) ** (n - i) * p[i] for i in range(n + 1))
        else:
            a, b, c = p
            m = 2 * np.array([b - a, c - a])
            o = np.linalg.solve(m, [b @ b - a @ a, c @ c - a @ a])
            angles = np.unwrap([np.arctan2(*(x - o)[::-1]) for x in (a, b, c)])
            h = np.interp(t[:, 0] * 2, [0, 1, 2], angles)
            q = o + np.linalg.norm(a - o) * np.c_[np.cos(h), np.sin(h)]
        lines.append(LineString(q))
    start = time.process_time()
    noded = union_all(MultiLineString(lines))
    cpu = time.process_time() - start
    parts = get_parts(noded)
    ends = np.array([get_coordinates(part)[[0, -1]] for part in parts]).reshape(-1, 2)
    return len(np.unique(ends.round(9), axis=0)), len(parts), cpu


if __name__ == "__main__":
    peer, kind, n = sys.argv[1], sys.argv[2], int(sys.argv[3])
    made = planar(n) if kind == "planar" else ruled(n)
    nodes, links, cpu = {"occt": occt, "shapely": shapely}[peer](made)
    print(json.dumps({"peer": peer, "kind": kind, "curves": len(made), "nodes": nodes, "links": links, "cpu_s": round(cpu, 4)}))
