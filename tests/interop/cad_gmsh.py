"""A second program (gmsh) reads the STEP and IGES files of shells: python cad_gmsh.py FILE ... prints one JSON record for each.

A process of its own: gmsh brings a build of OpenCASCADE that must not meet another one.
"""
import collections
import json
import subprocess
import sys

LONGEST = 300
# gmsh integrates with a fixed number of points: 2.7 % of the area of a bottle of rational pieces is wrong. `bodies` measures the same faces to 1e-6.
AREA = 5e-2


def measured(gmsh, path):
    """Faces, area in square millimetres and free edges of a file as gmsh imports it."""
    gmsh.clear()
    gmsh.model.occ.importShapes(path, highestDimOnly=False)
    gmsh.model.occ.synchronize()
    faces = gmsh.model.getEntities(2)
    uses = collections.Counter()
    for face in faces:
        uses.update(abs(tag) for _, tag in gmsh.model.getBoundary([face], combined=False, oriented=True))
    # A pole is an edge without length.
    free = [tag for tag, count in uses.items() if count == 1 and gmsh.model.occ.getMass(1, tag) > 1e-6]
    return {"faces": len(faces), "area": sum(gmsh.model.occ.getMass(2, tag) for _, tag in faces), "free": len(free)}


def read(paths):
    """What gmsh finds in each file, by path; a text where it does not read one."""
    done = subprocess.run([sys.executable, __file__, *paths], capture_output=True, text=True, timeout=LONGEST)
    # The libraries print as well.
    lines = [line for line in done.stdout.splitlines() if line.startswith('{"path"')]
    found = {record.pop("path"): record for record in map(json.loads, lines)}
    return {path: found.get(path, {"why": f"ended with {done.returncode}: {done.stderr[-200:]}"}) for path in paths}


def row(record, label, thing, size, faces):
    """The row of a shell, compared with its report and with the faces that the other kernel found; free edges are shown."""
    cells = {"thing": label, "kind": "shell", "faces": record.get("faces"), "area": None, "volume": None, "free": record.get("free"), "why": ""}
    if "why" in record:
        return {**cells, "why": record["why"]}, False
    cells["area"] = record["area"] / (thing["area"] * size**2)
    why = [] if abs(cells["area"] - 1) <= AREA else ["area"]
    if record["faces"] != faces:
        why.append(f"{faces} faces elsewhere")
    cells["why"] = ", ".join(why)
    return cells, not why


def main(paths):
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    for path in paths:
        try:
            record = measured(gmsh, path)
        except Exception as error:
            record = {"why": f"gmsh says {error}"[:200]}
        print(json.dumps({"path": path, **record}), flush=True)
    gmsh.finalize()


if __name__ == "__main__":
    main(sys.argv[1:])
