"""An independent kernel (OpenCASCADE) reads the shells in IGES files that models write: solids where they close, faces that share edges.

`row` judges one file as `step_out` does one of STEP.
"""
from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_LabelSequence
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from bodies import judge


def read(path):
    """The document of a file, in millimetres."""
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    reader = IGESCAFControl_Reader()
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


def roots_of(document):
    """(name, shape) of what stands in a file by itself."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    labels, found = TDF_LabelSequence(), []
    tool.GetFreeShapes(labels)
    for k in range(1, labels.Length() + 1):
        label, name = labels.Value(k), TDataStd_Name()
        said = name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""
        found.append((said, tool.GetShape_s(label)))
    return found


def row(path, label, thing, size):
    """The row of a shell in a file of its own, and whether it is right."""
    cells = {"thing": label, "kind": "shell", "faces": None, "area": None, "volume": None, "free": None, "why": ""}
    try:
        roots = roots_of(read(path))
    except AssertionError as error:
        return {**cells, "why": str(error)}, False
    why = judge(cells, [shape for _, shape in roots], thing, "shell", size)
    names = {name for name, _ in roots}
    # Letters that the format has not are written in others.
    if thing["name"].isascii() and not names & {thing["name"].replace("[", "_").replace("]", ""), thing["name"]}:
        why.append(f"names {sorted(names)[:4]}")
    cells["why"] = ", ".join(why)
    return cells, not why
