"""An independent kernel (OpenCASCADE) reads the shells in IGES files that models write: solids where they close, faces that share edges.

`row` judges one file as `step_out` does one of STEP.
"""
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.TDF import TDF_LabelSequence
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from bodies import document_of, judge, name_of


def roots_of(document):
    """(name, shape) of what stands in a file by itself."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    labels, found = TDF_LabelSequence(), []
    tool.GetFreeShapes(labels)
    for k in range(1, labels.Length() + 1):
        found.append((name_of(labels.Value(k)), tool.GetShape_s(labels.Value(k))))
    return found


def row(path, label, thing, size):
    """The row of a shell in a file of its own, and whether it is right."""
    cells = {"thing": label, "kind": "shell", "faces": None, "area": None, "volume": None, "free": None, "why": ""}
    try:
        roots = roots_of(document_of(IGESCAFControl_Reader(), path))
    except AssertionError as error:
        return {**cells, "why": str(error)}, False
    why = judge(cells, [shape for _, shape in roots], thing, "shell", size)
    names = {name for name, _ in roots}
    # Letters that the format has not are written in others.
    if thing["name"].isascii() and not names & {thing["name"].replace("[", "_").replace("]", ""), thing["name"]}:
        why.append(f"names {sorted(names)[:4]}")
    cells["why"] = ", ".join(why)
    return cells, not why
