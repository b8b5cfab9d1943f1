"""What is looked at in a shell that came out of a file: faces, validity, area, free edges, and of a closed one the volume."""
from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from surfaces import area, parts

# Shares by which areas and volumes may differ: quadrature of the other kernel.
AREA = VOLUME = 1e-6


def document_of(reader, path):
    """What a reader of the other kernel finds in a file, with names, colours and layers, in millimetres."""
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.SetLayerMode(True)
    if reader.ReadFile(path) != IFSelect_RetDone:
        raise AssertionError(f"{path} is not read")
    document = TDocStd_Document(TCollection_ExtendedString("MDTV-XCAF"))
    if not reader.Transfer(document):
        raise AssertionError(f"{path} is not transferred")
    return document


def name_of(label):
    """The name of a label of a document; empty where it has none."""
    name = TDataStd_Name()
    return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""


def volume(shape):
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, 1e-10)
    return properties.Mass()


def free_edges(shape):
    """The edges that one face uses once."""
    uses = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(shape, TopAbs_EDGE, TopAbs_FACE, uses)
    free = []
    for k in range(1, uses.Extent() + 1):
        edge = TopoDS.Edge_s(uses.FindKey(k))
        if uses.FindFromIndex(k).Size() == 1 and not BRep_Tool.Degenerated_s(edge):
            face = TopoDS.Face_s(uses.FindFromIndex(k).First())
            free += [] if BRep_Tool.IsClosed_s(edge, face) else [edge]
    return free


def judge(cells, roots, thing, kind, size):
    """Fills the cells of a row; what is wrong in words."""
    faces = [f for root in roots for f in parts(root, TopAbs_FACE)]
    solids = [s for root in roots for s in parts(root, TopAbs_SOLID)]
    why = []
    cells["faces"] = len(faces)
    # Patches along several lines and arcs are a face each.
    if kind == "surface" and len(faces) < thing["patches"]:
        why.append(f"{thing['patches']} patches")
    if not all(BRepCheck_Analyzer(root).IsValid() for root in roots):
        why.append("not valid")
    cells["area"] = sum(area(f) for f in faces) / (thing["area"] * size**2)
    if abs(cells["area"] - 1) > AREA:
        why.append("area")
    cells["free"] = sum(len(free_edges(root)) for root in roots)
    if kind == "shell" and thing["closed"]:
        if not solids:
            why.append("no solid")
        elif cells["free"]:
            why.append("free edges")
        else:
            cells["volume"] = sum(volume(s) for s in solids) / (thing["volume"] * size**3)
            if abs(cells["volume"] - 1) > VOLUME:
                why.append("volume")
    elif kind == "shell" and not cells["free"]:
        why.append("no free edge")
    return why
