"""An independent kernel (OpenCASCADE) reads the IGES files that models write and measures them again.

A model of models/surfaces has millimetres, writes all its surfaces, and the curves that these stand on, to one IGES file
of its own name. The areas of the faces must add up to those of the report, and the curves must lie on the faces within
`param allowed`, which the model states.
"""
import os

from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESControl import IGESControl_Reader
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

# Area found again to this share: quadrature of the other kernel.
AREA = 1e-6
# Places looked at along a curve.
PLACES = 21


def shape_of(path):
    """The one shape of an IGES file, in millimetres."""
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    reader = IGESControl_Reader()
    if reader.ReadFile(path) != IFSelect_RetDone:
        raise AssertionError(f"{path} is not read")
    reader.TransferRoots()
    return reader.OneShape()


def parts(shape, kind, avoiding=None):
    explorer = TopExp_Explorer(shape, kind, avoiding) if avoiding is not None else TopExp_Explorer(shape, kind)
    found = []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def area(shape):
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties, 1e-9)
    return properties.Mass()


def distance(point, shape):
    """From a point to the nearest place of a shape."""
    vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex()
    return BRepExtrema_DistShapeShape(vertex, shape).Value()


def farthest_of_curves(shape):
    """How far the loose curves of a file leave its faces, at places along them."""
    faces, worst = parts(shape, TopAbs_FACE), 0.0
    for edge in parts(shape, TopAbs_EDGE, TopAbs_FACE):
        curve = BRepAdaptor_Curve(TopoDS.Edge_s(edge))
        first, last = curve.FirstParameter(), curve.LastParameter()
        for k in range(PLACES):
            at = curve.Value(first + (last - first) * k / (PLACES - 1))
            worst = max(worst, min(distance((at.X(), at.Y(), at.Z()), face) for face in faces))
    return worst


def check(run, model, folder):
    """Areas and curves of one model."""
    name = os.path.splitext(os.path.basename(model))[0]
    report = run(model, os.path.join(folder, f"surfaces_{name}"))
    within = float(next(line for line in open(model, encoding="utf-8") if line.startswith("param allowed")).split("=")[1].replace("mm", ""))
    shape = shape_of(os.path.join(folder, f"surfaces_{name}", f"{name}.igs"))
    wanted = sum(surface["area"] for surface in report["surfaces"])
    found = sum(area(face) for face in parts(shape, TopAbs_FACE))
    if not abs(found - wanted) <= AREA * wanted:
        raise AssertionError(f"areas add up to {found} mm2, expected {wanted}")
    worst = farthest_of_curves(shape)
    if not worst <= within:
        raise AssertionError(f"a curve leaves the faces by {worst} mm, allowed {within}")
