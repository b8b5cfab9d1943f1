"""Assemblies that came in from STEP go out as assemblies: python assembly_out.py LOFT WORK prints a row for each.

An assembly of the other kernel is imported, exported, and read again by that kernel: its tree must have the same names at the same
depths in the same order, as many products, and every leaf the volume, the centre and the colour that it had.
"""
import math
import os
import shutil
import sys

from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_LabelSequence
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool
from OCP.XCAFPrs import XCAFPrs_DocumentExplorer

import cad_in
import parts
import tables
from bodies import name_of
from step_out import read, run

# Share by which volumes may differ, and how far centres may be apart, mm.
VOLUME, APART = 1e-6, 1e-6


class Document:
    """An assembly in the making."""

    def __init__(self):
        self.document = TDocStd_Document(TCollection_ExtendedString("MDTV-XCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(self.document)
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(self.document.Main())
        self.colors = XCAFDoc_DocumentTool.ColorTool_s(self.document.Main())

    def named(self, label, name):
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        return label

    def part(self, name, shape, *rgb):
        label = self.named(self.shapes.AddShape(shape, False), name)
        if rgb:
            self.paint(label, *rgb)
        return label

    def whole(self, name):
        return self.named(self.shapes.NewShape(), name)

    def paint(self, label, *rgb):
        self.colors.SetColor(label, Quantity_Color(*rgb, Quantity_TOC_RGB), XCAFDoc_ColorType.XCAFDoc_ColorSurf)

    def put(self, name, into, part, at, axis=(0, 0, 1), degrees=0):
        motion = gp_Trsf()
        motion.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(*axis)), math.radians(degrees))
        motion.SetTranslationPart(gp_Vec(*at))
        return self.named(self.shapes.AddComponent(into, part, TopLoc_Location(motion)), name)

    def write(self, path):
        self.shapes.UpdateAssemblies()
        writer = STEPCAFControl_Writer()
        writer.Transfer(self.document, STEPControl_AsIs)
        if writer.Write(path) != IFSelect_RetDone:
            raise AssertionError(f"{path} is not written")


def pairs(path):
    cad_in.write_assembly(path, next(iter(cad_in.STEP)))


def tower():
    """Three floors of two rooms with a lamp each, and a lamp beside: a lamp stands at seven places in four depths."""
    made = Document()
    lamp, wall = made.part("lamp", parts.rod(1, 4), 1, 1, 0), made.part("wall", parts.box(8, 6, 1), 0, 0, 1)
    room, floor, tower = made.whole("room"), made.whole("floor"), made.whole("tower")
    made.put("light", room, lamp, (4, 3, 1), (1, 2, 3), 40)
    made.put("ground", room, wall, (0, 0, 0))
    made.put("east", floor, room, (10, 0, 0), (0, 0, 1), 30)
    made.put("west", floor, room, (-10, 0, 0), (0, 1, 1), 170)
    for k in range(3):
        made.put(f"floor {k}", tower, floor, (0, 0, 20 * k), (0, 0, 1), 25 * k)
    made.put("beacon", tower, lamp, (0, 0, 70), (1, 0, 0), 90)
    return made


def painted():
    """The same part three times, once in a colour of its own, and a part of two solids."""
    made = Document()
    pin, rack = made.part("pin", parts.rod(1, 4), 1, 0, 0), made.whole("rack")
    for k in range(3):
        label = made.put(f"pin {k}", rack, pin, (5 * k, 0, 0))
        if k == 1:
            made.paint(label, 0, 1, 0)
    made.put("block", rack, made.part("block", parts.box(3, 4, 5)), (0, 20, 0))
    return made


def alone():
    """An assembly of a single part, once."""
    made = Document()
    whole = made.whole("cover")
    made.put("the lid", whole, made.part("lid", parts.box(3, 4, 5)), (1, 2, 3), (0, 0, 1), 45)
    made.put("the pin", whole, made.part("pin", parts.rod(1, 4)), (0, 0, 9))
    return made


def beside():
    """Products that stand in no other one."""
    made = Document()
    made.part("bracket", parts.box(3, 4, 5), 0, 1, 0)
    made.part("pin", parts.rod(1, 4))
    return made


def lone():
    """One product."""
    made = Document()
    made.part("bracket", parts.box(3, 4, 5), 0, 1, 0)
    return made


CASES = [("pairs", pairs), ("tower", lambda path: tower().write(path)), ("painted", lambda path: painted().write(path))]
CASES += [("single places", lambda path: alone().write(path)), ("beside each other", lambda path: beside().write(path))]
CASES += [("one product", lambda path: lone().write(path))]


def tree_of(path):
    """Rows of (depth, name there, name of the product, volume, centre, colour), and how many products there are."""
    document = read(path)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    rows, explorer = [], XCAFPrs_DocumentExplorer(document, 0)
    while explorer.More():
        node = explorer.Current()
        row = [explorer.CurrentDepth(), name_of(node.Label), name_of(node.RefLabel), None, None, None]
        if not node.IsAssembly:
            shape = tool.GetShape_s(node.RefLabel).Located(node.Location)
            properties = GProp_GProps()
            BRepGProp.VolumeProperties_s(shape, properties, 1e-10)
            row[3], row[4] = properties.Mass(), properties.CentreOfMass()
            if node.Style.IsSetColorSurf():
                color = node.Style.GetColorSurf()
                row[5] = tuple(round(x, 4) for x in (color.Red(), color.Green(), color.Blue()))
        rows.append(row)
        explorer.Next()
    labels = TDF_LabelSequence()
    tool.GetShapes(labels)
    return rows, labels.Length()


def faults(before, after):
    """What differs, in words."""
    if [row[:3] for row in before[0]] != [row[:3] for row in after[0]]:
        return f"the tree is {[row[:3] for row in after[0]]}"
    for a, b in zip(before[0], after[0]):
        if a[3] is not None and (abs(b[3] / a[3] - 1) > VOLUME or a[4].Distance(b[4]) > APART):
            return f"{a[1]} has volume {b[3]}, expected {a[3]}, its centre {a[4].Distance(b[4])} mm off"
        if a[5] != b[5]:
            return f"{a[1]} has colour {b[5]}, expected {a[5]}"
    return "" if before[1] == after[1] else f"{after[1]} products, expected {before[1]}"


def table(loft, work, _chosen=()):
    """Prints a row for each assembly; the labels of those that are wrong, and how many there are."""
    wrong = []
    for name, write in CASES:
        folder = os.path.join(work, name.replace(" ", "_"))
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        path = os.path.join(folder, "assembly.step")
        write(path)
        code, _, said = run(loft, folder, "part.loft", 'units mm\nimport "assembly.step" as part\nexport part to "again.step"\n')
        if code == 0:
            before, after = tree_of(path), tree_of(os.path.join(folder, "again.step"))
            why = faults(before, after)
            shown = f"{len(after[0]):>3} places {after[1]:>3} products"
        else:
            shown, why = "", said
        print(f"assembly {name:<20} {shown} {why}".rstrip(), flush=True)
        if why:
            wrong.append(f"assembly {name}")
    return wrong, len(CASES)


if __name__ == "__main__":
    sys.exit(tables.main(table))
