"""usage: p3_occt.py CHORD_ERROR   The face of benches/models/nurbs.loft in OpenCASCADE's incremental mesher, one thread.

Prints the CPU seconds of the mesher alone, the number of triangles, their quality, the largest distance of 20 places of each of at
most 150 000 triangles from the surface, and the peak memory. Needs `pip install cadquery-ocp==7.9.3.1.1 numpy`."""
import sys

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.Geom import Geom_BSplineSurface
from OCP.Geom2d import Geom2d_Circle
from OCP.gp import gp_Ax2d, gp_Circ2d, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.IMeshTools import IMeshTools_Parameters
from OCP.ShapeFix import ShapeFix_Face
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopLoc import TopLoc_Location
from quality import Cpu, show, triangles

N, DEGREE = 20, 3
KNOTS = np.r_[np.zeros(DEGREE), np.linspace(0, 1, N - DEGREE + 1), np.ones(DEGREE)]
AT = 100 * np.array([KNOTS[i + 1 : i + 4].mean() for i in range(N)])
X, Y = np.meshgrid(AT, AT, indexing="ij")
Z = 8 * np.sin(2 * np.pi * X / 50) * np.cos(2 * np.pi * Y / 40) + 3 * np.sin(2 * np.pi * (X + Y) / 70)
I, J = np.meshgrid(np.arange(N), np.arange(N), indexing="ij")
WEIGHTS = 1 + 0.15 * np.sin(1.3 * I + 0.7 * J)
POLES = np.stack([X * WEIGHTS, Y * WEIGHTS, Z * WEIGHTS, WEIGHTS], -1)


def basis(t):
    """First of four poles, values and slopes of the cubic basis."""
    t = np.clip(t, 0, 1)
    span = np.clip(np.searchsorted(KNOTS, t, side="right") - 1, DEGREE, N - 1)
    values = [[np.ones_like(t)]]
    for d in range(1, DEGREE + 1):
        row = [np.zeros_like(t) for _ in range(d + 1)]
        for r, below in enumerate(values[-1]):
            low, high = KNOTS[span - d + 1 + r], KNOTS[span + 1 + r]
            row[r] = row[r] + (high - t) * below / (high - low)
            row[r + 1] = row[r + 1] + (t - low) * below / (high - low)
        values.append(row)
    slopes = [0, 0, 0, 0]
    for r, below in enumerate(values[2]):
        share = 3 * below / (KNOTS[span + 1 + r] - KNOTS[span + r - 2])
        slopes[r], slopes[r + 1] = slopes[r] - share, slopes[r + 1] + share
    return span - DEGREE, np.stack(values[3], -1), np.stack(slopes, -1)


def evaluate(u, v):
    """Points with ∂u and ∂v."""
    (i, a, a1), (j, b, b1) = basis(u), basis(v)
    net = POLES[(i[:, None] + np.arange(4))[:, :, None], (j[:, None] + np.arange(4))[:, None, :]]
    total = lambda p, q: np.einsum("ni,nj,nijk->nk", p, q, net, optimize=True)
    s, su, sv = total(a, b), total(a1, b), total(a, b1)
    p = s[:, :3] / s[:, 3:]
    return p, (su[:, :3] - su[:, 3:] * p) / s[:, 3:], (sv[:, :3] - sv[:, 3:] * p) / s[:, 3:]


def distance(points, u, v, steps=4):
    """Of points from the surface, by Gauss–Newton from places near the feet."""
    for _ in range(steps):
        p, du, dv = evaluate(u, v)
        d = points - p
        e, f, g = (du * du).sum(1), (du * dv).sum(1), (dv * dv).sum(1)
        r, s = (du * d).sum(1), (dv * d).sum(1)
        det = e * g - f * f
        u, v = np.clip(u + (g * r - f * s) / det, 0, 1), np.clip(v + (e * s - f * r) / det, 0, 1)
    return np.linalg.norm(points - evaluate(u, v)[0], axis=1)


def chord_error(points, uv, corners, n=6, most=150_000):
    """The largest distance of places of triangles, of some at random where there are too many."""
    if len(corners) > most:
        corners = corners[np.random.default_rng(1).choice(len(corners), most, replace=False)]
    weights = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
    weights = weights[weights.max(1) < 1]
    worst = 0.0
    for part in np.array_split(corners, max(1, len(corners) // 8000)):
        p = np.einsum("wk,tkd->twd", weights, points[part]).reshape(-1, 3)
        at = np.einsum("wk,tkd->twd", weights, uv[part]).reshape(-1, 2)
        worst = max(worst, distance(p, at[:, 0], at[:, 1]).max())
    return float(worst)


def surface():
    """The net in OpenCASCADE."""
    poles, weights = TColgp_Array2OfPnt(1, N, 1, N), TColStd_Array2OfReal(1, N, 1, N)
    for i in range(N):
        for j in range(N):
            poles.SetValue(i + 1, j + 1, gp_Pnt(float(X[i, j]), float(Y[i, j]), float(Z[i, j])))
            weights.SetValue(i + 1, j + 1, float(WEIGHTS[i, j]))
    stops = np.linspace(0, 1, N - DEGREE + 1)
    knots, often = TColStd_Array1OfReal(1, len(stops)), TColStd_Array1OfInteger(1, len(stops))
    for i, t in enumerate(stops):
        knots.SetValue(i + 1, float(t))
        often.SetValue(i + 1, 4 if i in (0, len(stops) - 1) else 1)
    return Geom_BSplineSurface(poles, weights, knots, knots, often, often, DEGREE, DEGREE, False, False)


def face():
    """The net without nine circles of its parameters."""
    whole = surface()
    made = BRepBuilderAPI_MakeFace(whole, 1e-7)
    for i in range(3):
        for j in range(3):
            axis = gp_Ax2d(gp_Pnt2d(0.2 + 0.3 * i, 0.2 + 0.3 * j), gp_Dir2d(1, 0))
            circle = Geom2d_Circle(gp_Circ2d(axis, 0.06, False))
            made.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle, whole).Edge()).Wire())
    made = made.Face()
    BRepLib.BuildCurves3d_s(made)
    fix = ShapeFix_Face(made)
    fix.Perform()
    return fix.Face()


def main():
    limit = float(sys.argv[1])
    made = face()
    wish = IMeshTools_Parameters()
    # An angle that never decides.
    wish.Deflection, wish.Angle, wish.InParallel, wish.Relative = limit, 20.0, False, False
    with Cpu() as cpu:
        BRepMesh_IncrementalMesh(made, wish)
    mesh = BRep_Tool.Triangulation_s(made, TopLoc_Location())
    nodes = [mesh.Node(k + 1) for k in range(mesh.NbNodes())]
    places = [mesh.UVNode(k + 1) for k in range(mesh.NbNodes())]
    points = np.array([(p.X(), p.Y(), p.Z()) for p in nodes])
    uv = np.array([(p.X(), p.Y()) for p in places])
    corners = np.array([mesh.Triangle(k + 1).Get() for k in range(mesh.NbTriangles())]) - 1
    error = chord_error(points, uv, corners)
    show(peer="occt", cpu=round(cpu.seconds, 3), error=round(error, 7), **triangles(points, corners))


if __name__ == "__main__":
    main()
