"""Roundings and walls against the same ones built by OpenCASCADE: areas and volumes of the shells of models/rounded.loft."""
import math
import os

from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepGProp import BRepGProp
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeThickSolid
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.Geom import Geom_BezierSurface
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Ax1, gp_Ax2, gp_Circ, gp_Dir, gp_Pnt, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopoDS import TopoDS

from surfaces import area, parts

HERE = os.path.dirname(os.path.abspath(__file__))
# The other kernel's fillets of leaning surfaces are this far off, as a share: of the leaning post by 2.7e-5, where the integral over the
# ball's arcs agrees with the model to 1e-7.
WITHIN = 1e-4
UP = gp_Dir(0, 0, 1)


def volume(shape):
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, 1e-9)
    return abs(properties.Mass())


def box(low, high):
    return BRepPrimAPI_MakeBox(gp_Pnt(*low), gp_Pnt(*high)).Shape()


def circle(center, normal, radius):
    edge = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(*center), normal), radius)).Edge()
    return BRepBuilderAPI_MakeWire(edge).Wire()


def rounded(shape, radius, chosen):
    """The solid with a rounding along the edges of which all places looked at are chosen."""
    fillet = BRepFilletAPI_MakeFillet(shape)
    seen = []
    for edge in parts(shape, TopAbs_EDGE):
        if any(edge.IsSame(other) for other in seen):
            continue
        seen.append(edge)
        curve = BRepAdaptor_Curve(TopoDS.Edge_s(edge))
        first, last = curve.FirstParameter(), curve.LastParameter()
        places = [curve.Value(first + (last - first) * k / 4) for k in range(5)]
        if all(chosen(p.X(), p.Y(), p.Z()) for p in places):
            fillet.Add(radius, TopoDS.Edge_s(edge))
    fillet.Build()
    if not fillet.IsDone():
        raise AssertionError("the other kernel makes no rounding")
    return fillet.Shape()


def area_of(shape, flat):
    """Of the faces that are no planes, and of the planes whose centre is chosen."""
    total = 0.0
    for face in parts(shape, TopAbs_FACE):
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, properties, 1e-9)
        c = properties.CentreOfMass()
        if BRepAdaptor_Surface(TopoDS.Face_s(face)).GetType() != GeomAbs_Plane or flat(c.X(), c.Y(), c.Z()):
            total += properties.Mass()
    return total


def thick(sheet, by):
    """The wall of a sheet on one side."""
    maker = BRepOffsetAPI_MakeThickSolid()
    maker.MakeThickSolidBySimple(sheet, by)
    maker.Build()
    if not maker.IsDone():
        raise AssertionError("the other kernel makes no wall")
    return maker.Shape()


def upright():
    post = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -5), UP), 20, 45).Shape()
    solid = BRepAlgoAPI_Fuse(box((-50, -50, -10), (50, 50, 0)), post).Shape()
    solid = rounded(solid, 4, lambda x, y, z: abs(z) < 1e-6 and abs(math.hypot(x, y) - 20) < 1e-6)
    return area(solid), volume(solid)


def edge():
    solid = rounded(box((0, 200, 0), (60, 240, 30)), 7, lambda x, y, z: abs(z) < 1e-6 and abs(y - 200) < 1e-6)
    return area_of(solid, lambda x, y, z: abs(z) < 1e-6 or abs(y - 200) < 1e-6), None


def tee():
    main = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 400, -100), UP), 50, 200).Shape()
    branch = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 400, 0), gp_Dir(1, 0, 0)), 20, 120).Shape()
    on = lambda x, y, z: abs(math.hypot(x, y - 400) - 50) < 1e-3 and abs(math.hypot(y - 400, z) - 20) < 1e-3
    solid = rounded(BRepAlgoAPI_Fuse(main, branch).Shape(), 6, on)
    return area_of(solid, lambda x, y, z: False), None


def joint():
    post = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(circle((0, 600, -10), UP, 20)).Face(), gp_Vec(20, 0, 60)).Shape()
    solid = BRepAlgoAPI_Fuse(box((-50, 550, -10), (50, 650, 0)), post).Shape()
    solid = rounded(solid, 4, lambda x, y, z: abs(z) < 1e-4 and abs(math.hypot(x - 20 / 6, y - 600) - 20) < 1e-3)
    return area_of(solid, lambda x, y, z: abs(z) < 1e-4), None


def pipe_wall():
    solid = thick(BRepPrimAPI_MakePrism(circle((0, 800, 0), UP, 31), gp_Vec(0, 0, 50)).Shape(), 2)
    return area(solid), volume(solid)


def dome_wall():
    arc = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 1000, 0), gp_Dir(0, -1, 0), gp_Dir(1, 0, 0)), 40), 0, math.pi / 2).Edge()
    solid = thick(BRepPrimAPI_MakeRevol(arc, gp_Ax1(gp_Pnt(0, 1000, 0), UP)).Shape(), 3)
    return area(solid), volume(solid)


def ring_wall():
    ring = BRepPrimAPI_MakeRevol(circle((60, 1200, 0), gp_Dir(0, 1, 0), 15), gp_Ax1(gp_Pnt(0, 1200, 0), UP), 2 * math.pi / 3).Shape()
    solid = thick(ring, 2)
    return area(solid), volume(solid)


def saddle_wall():
    net = TColgp_Array2OfPnt(1, 2, 1, 2)
    for i, x in enumerate([0, 6]):
        for j, y in enumerate([0, 6]):
            net.SetValue(i + 1, j + 1, gp_Pnt(10 * x, 1400 + 10 * y, (x - 3) * (y - 3)))
    solid = thick(BRepBuilderAPI_MakeFace(Geom_BezierSurface(net), 1e-6).Face(), 2)
    return area(solid), volume(solid)


CASES = [upright, edge, tee, joint, pipe_wall, dome_wall, ring_wall, saddle_wall]


def check(run, folder):
    """Areas and volumes of all shells."""
    report = run(os.path.join(HERE, "models", "rounded.loft"), os.path.join(folder, "rounded"))
    shells = {shell["name"]: shell for shell in report["shells"]}
    wrong = []
    for case in CASES:
        found, wanted = shells[case.__name__], case()
        for name, value in zip(["area", "volume"], wanted):
            if value is not None and not abs(found[name] - value) <= WITHIN * value:
                wrong.append(f"{case.__name__}: {name} {found[name]}, the other kernel has {value}")
    if wrong:
        raise AssertionError("; ".join(wrong))
