"""usage: p1_gmsh.py N    The face of benches/mesh.rs in Gmsh: transfinite quads, N by N, one thread.

Two circular arcs and two splines round a square of 100; prints the CPU seconds of the meshing alone and the peak memory.
Needs `pip install gmsh`."""
import resource
import sys
import time

import gmsh


def centre(a, b, c):
    """Centre of the circle through three points."""
    sub = lambda p, q: [x - y for x, y in zip(p, q)]
    dot = lambda p, q: sum(x * y for x, y in zip(p, q))
    cross = lambda p, q: [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    u, v = sub(b, a), sub(c, a)
    w = cross(u, v)
    left, right = cross(v, w), cross(w, u)
    return [a[k] + (dot(u, u) * left[k] + dot(v, v) * right[k]) / (2 * dot(w, w)) for k in range(3)]


n = int(sys.argv[1])
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
geo = gmsh.model.geo
corners = [(0.0, 0, 0), (100.0, 0, 0), (100.0, 100, 0), (0.0, 100, 0)]
a, b, c, d = (geo.addPoint(*p) for p in corners)


def arc(start, end, p, through, q):
    return geo.addCircleArc(start, geo.addPoint(*centre(p, through, q)), end)


def through(start, inner, end):
    return geo.addSpline([start, *(geo.addPoint(*p) for p in inner), end])


south = arc(a, b, corners[0], (50, -10, 8), corners[1])
east = through(b, [(108, 33, 6), (95, 66, -4)], c)
north = arc(d, c, corners[3], (50, 112, 10), corners[2])
west = through(a, [(-6, 33, 5), (7, 66, 12)], d)
face = geo.addSurfaceFilling([geo.addCurveLoop([south, east, -north, -west])])
for curve in (south, east, north, west):
    geo.mesh.setTransfiniteCurve(curve, n + 1)
geo.mesh.setTransfiniteSurface(face)
geo.mesh.setRecombine(2, face)
geo.synchronize()
start = time.process_time()
gmsh.model.mesh.generate(2)
seconds = time.process_time() - start
quads = len(gmsh.model.mesh.getElementsByType(3)[0])
memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(f"gmsh {gmsh.GMSH_API_VERSION}: {quads} quads, {seconds:.3f} s CPU, {memory:.0f} MB")
