"""Reading and writing of CAD files against OpenCASCADE: python p8_cad.py LOFT [FILE …]

Writes 1 024 bicubic faces of one sewn shell as STEP and IGES, then reads them and every FILE with both programs and writes what STEP
and IGES gave back. Prints one JSON record each: CPU seconds of the other kernel for the call alone, of LOFT for the whole process, which
also builds every face, joins their edges and measures their area. Needs cadquery-ocp (tests/interop/requirements.txt).
"""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_Sewing
from OCP.Geom import Geom_BezierSurface
from OCP.IGESControl import IGESControl_Reader, IGESControl_Writer
from OCP.Message import Message
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.gp import gp_Pnt

# Faces along each side, and the side of one, mm.
COUNT, SIDE = 32, 10.0
# Bernstein coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
FROM_VALUES = [[1, 0, 0, 0], [-5 / 6, 3, -3 / 2, 1 / 3], [1 / 3, -3 / 2, 3, -5 / 6], [0, 0, 0, 1]]


def height(x, y):
    return 60 * math.sin(x / 40) * math.cos(y / 55)


def face(i, j):
    values = [[height((i + p / 3) * SIDE, (j + q / 3) * SIDE) for q in range(4)] for p in range(4)]
    poles = TColgp_Array2OfPnt(1, 4, 1, 4)
    for p in range(4):
        for q in range(4):
            z = sum(FROM_VALUES[p][a] * FROM_VALUES[q][b] * values[a][b] for a in range(4) for b in range(4))
            poles.SetValue(p + 1, q + 1, gp_Pnt((i + p / 3) * SIDE, (j + q / 3) * SIDE, z))
    return BRepBuilderAPI_MakeFace(Geom_BezierSurface(poles), 1e-7).Face()


def shell():
    sewing = BRepBuilderAPI_Sewing(1e-6)
    for i in range(COUNT):
        for j in range(COUNT):
            sewing.Add(face(i, j))
    sewing.Perform()
    return sewing.SewedShape()


def is_step(path):
    return path.lower().endswith((".step", ".stp"))


def peer_write(shape, path):
    start = time.process_time()
    if is_step(path):
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_AsIs)
    else:
        writer = IGESControl_Writer("MM", 1)
        writer.AddShape(shape)
        writer.ComputeModel()
    writer.Write(path)
    return time.process_time() - start


def peer_read(path):
    start = time.process_time()
    reader = STEPControl_Reader() if is_step(path) else IGESControl_Reader()
    reader.ReadFile(path)
    reader.TransferRoots()
    shape = reader.OneShape()
    return time.process_time() - start, shape


def ours(loft, folder, path, out):
    """CPU seconds of a whole process that reads a file, joins its faces and writes them where `out` says."""
    script = os.path.join(folder, "model.loft")
    export = f'export part to "{out}"' if out else "report \"area\": [{area: sum([for s in part.surfaces: area(s)])}]\nshell all of part"
    with open(script, "w", encoding="utf-8") as file:
        file.write(f'units mm\nimport "{os.path.abspath(path)}" as part\n{export}\n')
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([loft, "run", script, "-o", folder, "--allow", os.path.dirname(os.path.abspath(path))], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"cpu": round(cpu, 4), "exit": done.returncode, **({"said": done.stderr[-300:]} if done.returncode else {})}


def main():
    loft, files = sys.argv[1], sys.argv[2:]
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    shape = shell()
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("step", "igs"):
            path = os.path.join(folder, f"bicubic.{kind}")
            print(json.dumps({"peer": "write", "file": f"bicubic.{kind}", "cpu": round(peer_write(shape, path), 4)}), flush=True)
            files = [*files, path]
        for path in files:
            name = os.path.basename(path)
            read, _ = peer_read(path)
            print(json.dumps({"peer": "read", "file": name, "cpu": round(read, 4)}), flush=True)
            print(json.dumps({"ours": "read", "file": name, **ours(loft, folder, path, None)}), flush=True)
            for out in ("out.step", "out.igs"):
                print(json.dumps({"ours": f"read and write {out[4:]}", "file": name, **ours(loft, folder, path, out)}), flush=True)


if __name__ == "__main__":
    main()
