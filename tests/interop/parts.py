"""Parts that an independent kernel (OpenCASCADE) makes, millimetres: what CAD systems send, with every kind of loop.

`PARTS` has a name and a maker for each; a maker gives a shape. Half of them are about one feature of a loop: a seam run twice, a pole or an
apex, a loop round the surface, a seam that starts anywhere, a face without a border, holes over a seam.
"""
import math

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_NurbsConvert,
    BRepBuilderAPI_Sewing,
    BRepBuilderAPI_Transform,
)
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepOffset import BRepOffset_Skin
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeOffsetShape, BRepOffsetAPI_MakePipe, BRepOffsetAPI_MakeThickSolid, BRepOffsetAPI_ThruSections
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeRevol,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
    BRepPrimAPI_MakeWedge,
)
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import (
    Geom_BezierSurface,
    Geom_Circle,
    Geom_CylindricalSurface,
    Geom_OffsetSurface,
    Geom_SphericalSurface,
    Geom_SurfaceOfLinearExtrusion,
    Geom_SurfaceOfRevolution,
    Geom_ToroidalSurface,
)
from OCP.Geom2d import Geom2d_Line
from OCP.GeomAPI import GeomAPI_PointsToBSpline, GeomAPI_PointsToBSplineSurface
from OCP.GeomAbs import GeomAbs_Arc
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Circ, gp_Dir, gp_Dir2d, gp_Elips, gp_Pln, gp_Pnt, gp_Pnt2d, gp_Trsf, gp_Vec
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound
from OCP.TopTools import TopTools_ListOfShape

O, X, Y, Z = gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0), gp_Dir(0, 0, 1)


# Tools


def at(x=0.0, y=0.0, z=0.0, along=(0, 0, 1), start=None):
    """A frame: origin, axis, and where angles start."""
    if start is None:
        return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(*along))
    return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(*along), gp_Dir(*start))


def box(dx, dy, dz, x=0.0, y=0.0, z=0.0):
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape()


def rod(radius, height, frame=None, angle=2 * math.pi):
    return BRepPrimAPI_MakeCylinder(frame or at(), radius, height, angle).Shape()


def cone(foot, head, height, frame=None):
    return BRepPrimAPI_MakeCone(frame or at(), foot, head, height).Shape()


def ball(radius, frame=None):
    return BRepPrimAPI_MakeSphere(frame or at(), radius).Shape()


def ring(major, minor, frame=None):
    return BRepPrimAPI_MakeTorus(frame or at(), major, minor).Shape()


def cut(a, *tools):
    for tool in tools:
        a = BRepAlgoAPI_Cut(a, tool).Shape()
    return a


def fuse(a, *others):
    for other in others:
        a = BRepAlgoAPI_Fuse(a, other).Shape()
    return a


def common(a, b):
    return BRepAlgoAPI_Common(a, b).Shape()


def turned(shape, axis, degrees):
    motion = gp_Trsf()
    motion.SetRotation(gp_Ax1(O, gp_Dir(*axis)), math.radians(degrees))
    return BRepBuilderAPI_Transform(shape, motion, True).Shape()


def moved(shape, x, y, z):
    motion = gp_Trsf()
    motion.SetTranslation(gp_Vec(x, y, z))
    return BRepBuilderAPI_Transform(shape, motion, True).Shape()


def mirrored(shape):
    motion = gp_Trsf()
    motion.SetMirror(gp_Ax2(O, X))
    return BRepBuilderAPI_Transform(shape, motion, True).Shape()


def parts_of(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    found = []
    while explorer.More():
        if not any(explorer.Current().IsSame(f) for f in found):
            found.append(explorer.Current())
        explorer.Next()
    return found


def edges(shape):
    return [TopoDS.Edge_s(e) for e in parts_of(shape, TopAbs_EDGE) if not BRep_Tool.Degenerated_s(TopoDS.Edge_s(e))]


def faces(shape):
    return [TopoDS.Face_s(f) for f in parts_of(shape, TopAbs_FACE)]


def on_edges(maker, shape, sizes, chosen=None):
    """What a maker of fillets or chamfers with these sizes makes of some edges, or of all."""
    for k, edge in enumerate(edges(shape)):
        if chosen is None or k in chosen:
            maker.Add(*sizes, edge)
    return maker.Shape()


def filleted(shape, radius, chosen=None):
    return on_edges(BRepFilletAPI_MakeFillet(shape), shape, [radius], chosen)


def wire(*pieces):
    maker = BRepBuilderAPI_MakeWire()
    for piece in pieces:
        maker.Add(piece)
    return maker.Wire()


def segment(a, b):
    return BRepBuilderAPI_MakeEdge(gp_Pnt(*a), gp_Pnt(*b)).Edge()


def polygon(*points):
    return wire(*[segment(a, b) for a, b in zip(points, points[1:] + points[:1])])


def circle(radius, frame=None):
    return wire(BRepBuilderAPI_MakeEdge(gp_Circ(frame or at(), radius)).Edge())


def ellipse(a, b, frame=None):
    return wire(BRepBuilderAPI_MakeEdge(gp_Elips(frame or at(), a, b)).Edge())


def spline(*points):
    list_ = TColgp_Array1OfPnt(1, len(points))
    for k, p in enumerate(points):
        list_.SetValue(k + 1, gp_Pnt(*p))
    return BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(list_).Curve()).Edge()


def face(wire_):
    return BRepBuilderAPI_MakeFace(wire_, True).Face()


def prism(base, x, y, z):
    return BRepPrimAPI_MakePrism(base, gp_Vec(x, y, z)).Shape()


def revolved(base, degrees=360.0, axis=(0, 0, 1)):
    turn = gp_Ax1(O, gp_Dir(*axis))
    if degrees == 360.0:
        return BRepPrimAPI_MakeRevol(base, turn).Shape()
    return BRepPrimAPI_MakeRevol(base, turn, math.radians(degrees)).Shape()


def loft(*wires, ruled=False, solid=True):
    maker = BRepOffsetAPI_ThruSections(solid, ruled)
    for w in wires:
        maker.AddWire(w)
    maker.Build()
    return maker.Shape()


def pipe(spine, profile):
    return BRepOffsetAPI_MakePipe(spine, profile).Shape()


def shelled(shape, open_faces, thickness):
    removed = TopTools_ListOfShape()
    for k in open_faces:
        removed.Append(faces(shape)[k])
    maker = BRepOffsetAPI_MakeThickSolid()
    maker.MakeThickSolidByJoin(shape, removed, thickness, 1e-3)
    return maker.Shape()


def offset(shape, distance):
    maker = BRepOffsetAPI_MakeOffsetShape()
    maker.PerformByJoin(shape, distance, 1e-4, BRepOffset_Skin, False, False, GeomAbs_Arc)
    return maker.Shape()


def as_splines(shape):
    return BRepBuilderAPI_NurbsConvert(shape, True).Shape()


def compound(*shapes):
    builder, made = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(made)
    for shape in shapes:
        builder.Add(made, shape)
    return made


def sewn(*shapes):
    sewing = BRepBuilderAPI_Sewing(1e-6)
    for shape in shapes:
        sewing.Add(shape)
    sewing.Perform()
    return sewing.SewedShape()


def whole(surface, *bounds):
    """A face of all of a surface, or between bounds of u and v."""
    return BRepBuilderAPI_MakeFace(surface, *bounds, 1e-7).Face()


# Parts


def stepped_shaft():
    profile = polygon((0, 0, 0), (12, 0, 0), (12, 0, 10), (8, 0, 10), (8, 0, 30), (5, 0, 30), (5, 0, 45), (0, 0, 45))
    return revolved(face(profile))


def vase():
    side = spline((10, 0, 0), (16, 0, 12), (8, 0, 26), (12, 0, 40))
    profile = wire(segment((0, 0, 0), (10, 0, 0)), side, segment((12, 0, 40), (0, 0, 40)), segment((0, 0, 40), (0, 0, 0)))
    return revolved(face(profile))


def drop():
    """Turned about its own ends: a point above and below."""
    side = spline((0, 0, -12), (9, 0, -8), (11, 0, 3), (0, 0, 20))
    return revolved(face(wire(side, segment((0, 0, 20), (0, 0, -12)))))


def s_pipe():
    spine = wire(spline((0, 0, 0), (0, 0, 20), (20, 0, 40), (20, 10, 60)))
    return pipe(spine, face(circle(4.0)))


def elbow():
    arc = GC_MakeArcOfCircle(gp_Circ(gp_Ax2(gp_Pnt(30, 0, 0), gp_Dir(0, -1, 0), gp_Dir(-1, 0, 0)), 30), 0.0, math.pi / 2, True).Value()
    tube = cut(face(circle(6.0)), prism(face(circle(4.0)), 0, 0, 1))
    return pipe(wire(BRepBuilderAPI_MakeEdge(arc).Edge()), tube)


def bezier_lid():
    poles = TColgp_Array2OfPnt(1, 4, 1, 4)
    for i in range(4):
        for j in range(4):
            poles.SetValue(i + 1, j + 1, gp_Pnt(10 * i, 10 * j, 6 * math.sin(i) * math.cos(j)))
    return whole(Geom_BezierSurface(poles))


def hilly():
    points = TColgp_Array2OfPnt(1, 9, 1, 7)
    for i in range(9):
        for j in range(7):
            points.SetValue(i + 1, j + 1, gp_Pnt(5 * i, 5 * j, 2 * math.sin(0.7 * i) * math.cos(0.9 * j)))
    return whole(GeomAPI_PointsToBSplineSurface(points).Surface())


def hilly_cut():
    return cut(hilly(), prism(face(circle(8, at(20, 15, -10))), 0, 0, 20))


def offset_sheet():
    return whole(Geom_OffsetSurface(GeomAPI_PointsToBSplineSurface(_hills()).Surface(), 2.0))


def beside(surface, distance, *bounds):
    return whole(Geom_OffsetSurface(surface, distance), *bounds)


def offset_hole(distance):
    """A hole through the offset of a surface that bends both ways."""
    return cut(beside(GeomAPI_PointsToBSplineSurface(_hills()).Surface(), distance), prism(face(circle(8, at(20, 20, -20))), 0, 0, 40))


def offset_turned(distance):
    """Round a spline that turns about z: half of it."""
    side = Geom_SurfaceOfRevolution(_side(), gp_Ax1(O, Z))
    return beside(side, distance, 0.3, 2.8, 0.1, 0.9)


def offset_swept(distance):
    return beside(Geom_SurfaceOfLinearExtrusion(_side(), Y), distance, 0.1, 0.9, -5.0, 12.0)


def net_of(shape):
    """The spline of the first face of a shape."""
    return BRep_Tool.Surface_s(faces(as_splines(shape))[0])


def _side():
    list_ = TColgp_Array1OfPnt(1, 4)
    for k, p in enumerate([(10, 0, 0), (16, 0, 12), (8, 0, 26), (12, 0, 40)]):
        list_.SetValue(k + 1, gp_Pnt(*p))
    return GeomAPI_PointsToBSpline(list_).Curve()


def _hills():
    points = TColgp_Array2OfPnt(1, 6, 1, 6)
    for i in range(6):
        for j in range(6):
            points.SetValue(i + 1, j + 1, gp_Pnt(8 * i, 8 * j, 1.5 * math.sin(0.5 * i + 0.4 * j)))
    return points


def thread():
    """A helical groove of a pipe along a helix on a cylinder."""
    cylinder = Geom_CylindricalSurface(gp_Ax3(O, Z), 10.0)
    line = Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(2 * math.pi, 6.0))
    edge = BRepBuilderAPI_MakeEdge(line, cylinder, 0.0, 2 * math.hypot(2 * math.pi, 6.0)).Edge()
    from OCP.BRepLib import BRepLib

    BRepLib.BuildCurves3d_s(edge)
    profile = face(circle(1.5, at(10, 0, 0, (0, 10, 6 / (2 * math.pi)))))
    return pipe(wire(edge), profile)


def flange():
    body = fuse(rod(30, 8), rod(14, 30))
    holes = [rod(3, 20, at(22 * math.cos(a), 22 * math.sin(a), -5)) for a in (math.pi * k / 3 for k in range(6))]
    return cut(body, rod(9, 60, at(0, 0, -5)), *holes)


def crossing_pipes():
    outer = fuse(rod(10, 60, at(0, 0, -30)), rod(8, 60, at(-30, 0, 0, (1, 0, 0))))
    return cut(outer, rod(8, 80, at(0, 0, -40)), rod(6, 80, at(-40, 0, 0, (1, 0, 0))))


def seam_everywhere(degrees):
    """A tube with a side hole whose seam starts at an angle: in front of, in and behind the hole."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return cut(rod(10, 40, at(start=(c, s, 0))), rod(4, 40, at(0, 0, 20, (1, 0, 0))))


def sphere_hole(along):
    return cut(ball(15), rod(4, 40, at(0, 0, 0, along)))


def torus_cut_by_box():
    return cut(ring(20, 6), box(60, 60, 60, 0, 0, -30))


def gear_blank():
    teeth = [box(6, 4, 10, 18, -2, 0) for _ in range(1)]
    body = rod(20, 10)
    for k in range(8):
        body = cut(body, turned(teeth[0], (0, 0, 1), 45 * k + 10))
    return cut(body, rod(5, 20, at(0, 0, -5)))


def knob():
    return filleted(fuse(rod(6, 20), ball(10, at(0, 0, 24))), 1.5, {0})


def sphere_patch(u0, u1, v0, v1):
    return whole(Geom_SphericalSurface(gp_Ax3(O, Z), 12.0), u0, u1, v0, v1)


def torus_patch(u0, u1, v0, v1):
    return whole(Geom_ToroidalSurface(gp_Ax3(O, Z), 20.0, 6.0), u0, u1, v0, v1)


PARTS = [
    ("box", lambda: box(10, 20, 30)),
    ("wedge", lambda: BRepPrimAPI_MakeWedge(10, 20, 30, 4).Shape()),
    ("cylinder", lambda: rod(10, 30)),
    ("cylinder_tilted", lambda: rod(10, 30, at(1, 2, 3, (1, 2, 3)))),
    ("cylinder_part", lambda: rod(10, 30, None, 1.5 * math.pi)),
    ("cone", lambda: cone(10, 4, 20)),
    ("cone_apex", lambda: cone(10, 0, 20)),
    ("cone_apex_down", lambda: cone(0, 10, 20)),
    ("ball", lambda: ball(12)),
    ("torus", lambda: ring(20, 6)),
    ("tube", lambda: cut(rod(10, 30), rod(7, 40, at(0, 0, -5)))),
    ("boss", lambda: fuse(box(40, 40, 10, -20, -20), rod(8, 30))),
    ("box_hole", lambda: cut(box(40, 40, 10), rod(8, 30, at(20, 20, -5)))),
    ("half_ball", lambda: cut(ball(12), box(40, 40, 40, -20, -20, -40))),
    ("half_ball_side", lambda: cut(ball(12), box(40, 40, 40, 0, -20, -20))),
    ("ball_octant", lambda: common(ball(12), box(20, 20, 20))),
    ("ball_cut_box", lambda: cut(ball(12), box(20, 20, 20, 3, -4, -5))),
    ("ball_cap_tilted", lambda: cut(ball(12), turned(box(60, 60, 60, -30, -30, 4), (1, 1, 0), 70))),
    ("ball_zone", lambda: common(ball(12), box(60, 60, 8, -30, -30, -3))),
    ("ball_hole_pole", lambda: sphere_hole((0, 0, 1))),
    ("ball_hole_seam", lambda: sphere_hole((1, 0, 0))),
    ("ball_hole_side", lambda: sphere_hole((0, 1, 0))),
    ("ball_hole_tilted", lambda: sphere_hole((1, 2, 2))),
    ("ball_through_pole", lambda: cut(ball(12), rod(4, 40, at(4, 0, -20)))),
    ("ball_patch", lambda: sphere_patch(0.3, 2.0, -0.5, 0.9)),
    ("ball_patch_pole", lambda: sphere_patch(0.3, 2.0, 0.2, math.pi / 2)),
    ("ball_patch_seam", lambda: sphere_patch(5.5, 7.5, -0.5, 0.9)),
    ("torus_half", torus_cut_by_box),
    ("torus_plane", lambda: cut(ring(20, 6), box(60, 60, 20, -30, -30, 2))),
    ("torus_hole", lambda: cut(ring(20, 6), rod(2, 40, at(20, 0, -20)))),
    ("torus_hole_seam", lambda: cut(ring(20, 6), rod(2, 40, at(0, 0, 0, (1, 0, 0))))),
    ("torus_patch", lambda: torus_patch(5.0, 7.5, 4.0, 8.0)),
    ("ring_band", lambda: torus_patch(0.0, 2 * math.pi, 0.5, 2.5)),
    ("cut_oblique", lambda: cut(rod(10, 40), turned(box(80, 80, 40, -40, -40, 26), (0, 1, 0), 20))),
    ("cut_oblique_cone", lambda: cut(cone(12, 5, 40), turned(box(80, 80, 40, -40, -40, 22), (0, 1, 0), 15))),
    ("cone_cut_at_apex", lambda: cut(cone(10, 0, 20), box(40, 40, 40, 0, -20, -10))),
    ("cone_slot", lambda: cut(cone(10, 0, 20), box(40, 4, 8, -20, -2, -1))),
    ("tube_hole_0", lambda: seam_everywhere(0)),
    ("tube_hole_10", lambda: seam_everywhere(10)),
    ("tube_hole_23", lambda: seam_everywhere(23.578178478201835)),
    ("tube_hole_90", lambda: seam_everywhere(90)),
    ("tube_hole_180", lambda: seam_everywhere(180)),
    ("crossing_pipes", crossing_pipes),
    ("flange", flange),
    ("gear", gear_blank),
    ("box_filleted", lambda: filleted(box(30, 20, 10), 2.0)),
    ("rod_filleted", lambda: filleted(rod(10, 30), 2.0, {0, 2})),
    ("boss_filleted", lambda: filleted(fuse(box(40, 40, 10, -20, -20), rod(8, 30)), 1.5)),
    ("knob", knob),
    ("capsule", lambda: fuse(rod(8, 20), ball(8), ball(8, at(0, 0, 20)))),
    ("elliptic_rod", lambda: prism(face(ellipse(12, 7)), 0, 0, 20)),
    ("elliptic_tilted", lambda: prism(face(ellipse(12, 7, at(3, 2, 1, (1, 2, 3)))), 5, 10, 15)),
    ("elliptic_tube", lambda: cut(prism(face(ellipse(12, 7)), 0, 0, 20), prism(face(ellipse(9, 4, at(0, 0, -5))), 0, 0, 40))),
    ("stepped_shaft", stepped_shaft),
    ("vase", vase),
    ("drop", drop),
    ("turned_part", lambda: revolved(face(polygon((4, 0, 0), (9, 0, 2), (7, 0, 12), (3, 0, 9))), 250)),
    ("loft_square_circle", lambda: loft(polygon((-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)), circle(6, at(0, 0, 20)))),
    ("loft_circles", lambda: loft(circle(8), circle(5, at(0, 0, 12)), circle(9, at(3, 0, 25)))),
    ("loft_ruled", lambda: loft(circle(8), ellipse(10, 4, at(0, 0, 20)), ruled=True)),
    ("pipe", s_pipe),
    ("elbow", elbow),
    ("thread", thread),
    ("bezier_lid", bezier_lid),
    ("hills", hilly),
    ("hills_hole", hilly_cut),
    ("offset_sheet", offset_sheet),
    ("offset_below", lambda: beside(GeomAPI_PointsToBSplineSurface(_hills()).Surface(), -2.0)),
    ("offset_turned_over", lambda: offset_sheet().Reversed()),
    ("offset_hole", lambda: offset_hole(1.5)),
    ("offset_hole_below", lambda: offset_hole(-1.5)),
    ("offset_revolved", lambda: offset_turned(1.0)),
    ("offset_revolved_in", lambda: offset_turned(-1.0)),
    ("offset_swept", lambda: offset_swept(1.0)),
    ("offset_swept_in", lambda: offset_swept(-1.0)),
    ("offset_ball", lambda: beside(Geom_SphericalSurface(gp_Ax3(O, Z), 12.0), 1.5, 0.3, 2.0, -0.5, 0.9)),
    ("offset_ring", lambda: beside(Geom_ToroidalSurface(gp_Ax3(O, Z), 20.0, 6.0), -1.5, 0.3, 2.0, -0.5, 0.9)),
    ("offset_net_ring", lambda: beside(net_of(ring(20, 6)), -1.5, 0.1, 0.7, 0.2, 0.6)),
    ("offset_net_ring_all", lambda: beside(net_of(ring(20, 6)), 1.5)),
    ("offset_box", lambda: offset(box(20, 15, 10), 3.0)),
    ("shelled_box", lambda: shelled(box(30, 20, 15), [5], -2.0)),
    ("shelled_rod", lambda: shelled(rod(10, 30), [1], -1.5)),
    ("mirrored_cone", lambda: mirrored(turned(cone(9, 3, 15, at(2, 3, 1)), (1, 1, 0), 30))),
    ("two_bodies", lambda: compound(box(10, 10, 10), moved(ball(5), 30, 0, 0))),
    ("spline_ball", lambda: as_splines(ball(12))),
    ("spline_torus", lambda: as_splines(ring(20, 6))),
    ("spline_cut_tube", lambda: as_splines(seam_everywhere(0))),
    ("spline_cone", lambda: as_splines(cone(10, 0, 20))),
    ("hollow", lambda: cut(ball(15), ball(9))),
]


def around(a, b):
    """Length of an ellipse with these half axes, by arithmetic and geometric means."""
    total, power, x, y = a * a, 0.5, a, b
    total -= 0.5 * (a * a - b * b)
    while abs(x - y) > 1e-15 * a:
        x, y, half = 0.5 * (x + y), math.sqrt(x * y), 0.5 * (x - y)
        power *= 2
        total -= power * half * half
    return 2 * math.pi * total / x


def beside_length(distance, start=0.1, end=0.9, steps=100_000):
    """Length of the offset of `_side` in its plane: the sum of its chords."""
    curve, places = _side(), []
    for k in range(steps + 1):
        p, d = gp_Pnt(), gp_Vec()
        curve.D1(start + (end - start) * k / steps, p, d)
        normal = d.Crossed(gp_Vec(0, 1, 0)).Normalized()
        places.append((p.X() + distance * normal.X(), p.Z() + distance * normal.Z()))
    return sum(math.dist(a, b) for a, b in zip(places, places[1:]))


# Areas that are known exactly where the other kernel measures badly.
EXACT = {
    "offset_swept": [17 * beside_length(1.0)],
    "offset_swept_in": [17 * beside_length(-1.0)],
    "offset_net_ring_all": [4 * math.pi**2 * 20 * 7.5],
    "elliptic_rod": [20 * around(12, 7)],
    "elliptic_tilted": [math.sqrt(350) * around(12, 7)],
    "elliptic_tube": [20 * around(12, 7), 20 * around(9, 4)],
}
