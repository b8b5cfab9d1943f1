"""Arc lengths and their inverse in NumPy and SciPy on the curve of `benches/curves.rs`.

    python -m venv env && env/bin/pip install numpy scipy && env/bin/python benches/peers/curves.py

Prints one JSON record per measurement; `cpu` is process CPU time in seconds of the measured part only. The curve is
the natural chord-length cubic spline through 40 points; both programs must state the same length.
"""
import json
import time

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

ANGLES = np.linspace(0, 1.8 * np.pi, 40)
POINTS = np.c_[50 + 40 * np.cos(ANGLES) * (1 + 0.2 * np.cos(5 * ANGLES)), 50 + 40 * np.sin(ANGLES), 10 * np.sin(3 * ANGLES)]
COUNT = 100_000


def record(what, start, **more):
    print(json.dumps({"peer": "numpy/scipy", "what": what, "cpu": round(time.process_time() - start, 5), **more}))


knots = np.r_[0, np.cumsum(np.linalg.norm(np.diff(POINTS, axis=0), axis=1))]
slope = CubicSpline(knots, POINTS, bc_type="natural").derivative()

start = time.process_time()
total = sum(quad(lambda x: float(np.linalg.norm(slope(x))), a, b, epsabs=1e-10)[0] for a, b in zip(knots, knots[1:]))
record("length by adaptive quadrature", start, length=total)

# All at once: 8-point Gauss per knot interval cut in 8, a table, then three Newton steps.
start = time.process_time()
nodes, weights = np.polynomial.legendre.leggauss(8)
edges = np.unique(np.concatenate([a + (b - a) * np.linspace(0, 1, 9) for a, b in zip(knots, knots[1:])]))


def lengths(low, high):
    x = ((low + high) / 2)[:, None] + ((high - low) / 2)[:, None] * nodes
    return (high - low) / 2 * (np.linalg.norm(slope(x), axis=-1) @ weights)


table = np.r_[0, np.cumsum(lengths(edges[:-1], edges[1:]))]
wanted = np.linspace(0, table[-1], COUNT)
found = np.interp(wanted, table, edges)
for _ in range(3):
    panel = np.clip(np.searchsorted(edges, found, side="right") - 1, 0, len(edges) - 2)
    miss = table[panel] + lengths(edges[panel], found) - wanted
    found = np.clip(found - miss / np.linalg.norm(slope(found), axis=1), edges[0], edges[-1])
cpu = time.process_time() - start
record(f"{COUNT} parameters at arc lengths", start, length=float(table[-1]), per_second=round(COUNT / cpu))
