"""Reads mesh files with gmsh, meshio, pyNastran and plyfile, and those of scenes.py, and compares counts, areas and sets with what is known of the mesh.

`facts` has nodes, lines (None: not known), triangles, quads, order, area and groups {name: {nodes, elements}}.
"""
import contextlib
import io
import os
import re

import numpy as np

# One part in this many: binary STL holds single precision, text everything.
SINGLE, DOUBLE = 1e-5, 1e-9


def expect(what, found, wanted, share=0.0):
    if share:
        if not abs(found - wanted) <= share * abs(wanted):
            raise AssertionError(f"{what}: found {found}, expected {wanted}")
    elif found != wanted:
        raise AssertionError(f"{what}: found {found}, expected {wanted}")


def area_of(points, cells):
    """Sum of the areas of triangles and quads given by their corners; a quad is its two triangles, as loft measures it."""
    total = 0.0
    for corners in cells:
        for fan in ([0, 1, 2], [0, 2, 3])[: corners.shape[1] - 2]:
            a, b, c = (points[corners[:, k]] for k in fan)
            total += 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    return total


def in_file(name, strict):
    """The name of a set in a file, as product text says: ribs[3] -> ribs_3; strict decks are ASCII."""
    plain = name.replace("][", "_").replace("[", "_").replace("]", "")
    if not strict:
        return re.sub(r"\s", "_", plain)
    # The one name of the tests that is not in Latin letters, by the Revised Romanisation of Korean.
    name = re.sub(r"[^A-Za-z0-9]", "_", plain.replace("지붕", "jibung"))
    return name if name[:1].isalpha() else "s" + name


def readers(path, facts):
    """(label, check) for each program that reads this kind of file."""
    import scenes

    ending = path.rsplit(".", 1)[1]
    binary = "binary" in os.path.basename(path)
    table = {
        "stl": [("meshio", meshio_stl), ("gmsh", gmsh_stl)],
        "obj": [("meshio", meshio_faces), ("gmsh", gmsh_faces)],
        # gmsh calls its reader of binary PLY experimental, and it reads single precision only; meshio knows no edges.
        "ply": [("plyfile", plyfile_all)],
        "vtu": [("meshio", meshio_vtu)],
        "msh": [("meshio", meshio_msh), ("gmsh", gmsh_msh)],
        # gmsh writes INP but does not read it. meshio knows S8R and STRI65, not S8 and S6.
        "inp": [("meshio", meshio_inp)] if facts["order"] == 1 or "solver_names" in path else [("lines", lines_inp)],
        "glb": [("trimesh", scenes.glb_trimesh), ("pygltflib", scenes.glb_pygltflib), ("gltf-validator", scenes.glb_validator)],
        "3mf": [("trimesh", scenes.threemf_trimesh), ("lib3mf", scenes.threemf_lib3mf)],
        "bdf": [("meshio", meshio_bdf), ("gmsh", gmsh_bdf), ("pyNastran", pynastran_bdf)],
    }
    share = SINGLE if ending == "stl" and binary else DOUBLE
    return [(label, lambda check=check: check(path, facts, share)) for label, check in table[ending]]


def n_triangles(facts):
    return facts["triangles"] + 2 * facts["quads"]


# meshio


def meshio_mesh(path):
    import meshio

    with contextlib.redirect_stdout(io.StringIO()), np.errstate(all="ignore"):
        try:
            return meshio.read(path)
        except SystemExit as error:
            raise AssertionError("meshio gives up") from error


def blocks(mesh, *kinds):
    return [cells.data for cells in mesh.cells if cells.type in kinds]


def count(mesh, *kinds):
    return sum(len(data) for data in blocks(mesh, *kinds))


def meshio_area(mesh):
    flat = [data[:, :3] for data in blocks(mesh, "triangle", "triangle6")]
    return area_of(mesh.points, flat + [data[:, :4] for data in blocks(mesh, "quad", "quad8")])


def meshio_counts(mesh, facts, share):
    expect("nodes", len(mesh.points), facts["nodes"])
    second = facts["order"] == 2
    expect("triangles", count(mesh, "triangle6" if second else "triangle"), facts["triangles"])
    expect("quads", count(mesh, "quad8" if second else "quad"), facts["quads"])
    if facts["lines"] is not None:
        expect("lines", count(mesh, "line3", "line"), facts["lines"])
    expect("area", meshio_area(mesh), facts["area"], share)


def meshio_stl(path, facts, share):
    mesh = meshio_mesh(path)
    expect("triangles", count(mesh, "triangle"), n_triangles(facts))
    expect("area", meshio_area(mesh), facts["area"], share)
    if "binary" not in os.path.basename(path):
        with open(path, encoding="utf-8") as file:
            solids = [line.split(maxsplit=1)[1].strip() for line in file if line.startswith("solid")]
        known = {in_file(name, False) for name in facts["groups"]}
        if not solids or not set(solids) <= known:
            raise AssertionError(f"solids {solids} are not among the sets {sorted(known)}")


def meshio_faces(path, facts, share):
    mesh = meshio_mesh(path)
    expect("triangles", count(mesh, "triangle"), facts["triangles"])
    expect("quads", count(mesh, "quad"), facts["quads"])
    expect("area", meshio_area(mesh), facts["area"], share)
    with open(path, encoding="utf-8") as file:
        text = file.read().splitlines()
    named = {word for line in text if line.startswith("g ") for word in line.split()[1:]}
    faces = {in_file(name, False) for name, group in facts["groups"].items() if group["elements"]}
    if not faces <= named:
        raise AssertionError(f"groups {sorted(faces - named)} are missing")


def meshio_vtu(path, facts, share):
    mesh = meshio_mesh(path)
    meshio_counts(mesh, facts, share)
    for name, group in facts["groups"].items():
        name = in_file(name, False)
        if group["elements"]:
            found = sum(int(data.sum()) for data in mesh.cell_data[name])
            expect(f"elements of {name}", found, group["elements"])
        else:
            expect(f"nodes of {name}", int(mesh.point_data[name].sum()), group["nodes"])


def meshio_msh(path, facts, share):
    mesh = meshio_mesh(path)
    meshio_counts(mesh, facts, share)
    for name, group in facts["groups"].items():
        name = in_file(name, False)
        sets = mesh.cell_sets[name]
        found = {}
        for cells, members in zip(mesh.cells, sets):
            found[cells.type] = found.get(cells.type, 0) + (0 if members is None else len(members))
        points = found.pop("vertex", 0)
        expect(f"elements of {name}", sum(found.values()), group["elements"])
        if not group["elements"]:
            expect(f"nodes of {name}", points, group["nodes"])


def meshio_inp(path, facts, share):
    mesh = meshio_mesh(path)
    meshio_counts(mesh, facts, share)
    for name, group in facts["groups"].items():
        name = in_file(name, True)
        expect(f"nodes of {name}", len(mesh.point_sets[name]), group["nodes"])
        if group["elements"]:
            found = sum(len(members) for members in mesh.cell_sets[name] if members is not None)
            expect(f"elements of {name}", found, group["elements"])


def lines_inp(path, facts, _):
    """Cards and numbers of a deck by their text alone, for elements that meshio does not know."""
    with open(path, encoding="utf-8") as file:
        counts, card, longest = {}, "", 0
        for line in file:
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                card = line.strip()
                counts.setdefault(card, 0)
                continue
            counts[card] += line.count(",") + 1 if "SET=" in card and "ELEMENT" not in card else 1
            longest = max(longest, max(len(part.strip()) for part in line.split(",")))
    if longest > 20:
        raise AssertionError(f"a number of {longest} characters: the solvers read 20")
    expect("nodes", counts["*NODE"], facts["nodes"])
    of = lambda kind: sum(n for card, n in counts.items() if card.startswith(f"*ELEMENT, TYPE={kind},"))
    expect("triangles", of("S6") + of("STRI65"), facts["triangles"])
    expect("quads", of("S8") + of("S8R"), facts["quads"])
    for name, group in facts["groups"].items():
        expect(f"nodes of {name}", counts[f"*NSET, NSET={in_file(name, True)}"], group["nodes"])


def meshio_bdf(path, facts, share):
    mesh = meshio_mesh(path)
    # meshio does not know CBEAM3, the line element of order 2.
    meshio_counts(mesh, facts if facts["order"] == 1 else {**facts, "lines": None}, max(share, DOUBLE))
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for name in facts["groups"]:
        if f"of {in_file(name, True)}\n" not in text:
            raise AssertionError(f"no SET for {name}")
    properties = {ref for refs in mesh.cell_data["nastran:ref"] for ref in np.unique(refs)}
    expect("properties", len(properties), len(re.findall(r"^(?:PSHELL|PBAR) ", text, re.M)))


def pynastran_bdf(path, facts, _):
    from pyNastran.bdf.bdf import read_bdf

    model = read_bdf(path, xref=False, debug=None)
    expect("nodes", len(model.nodes), facts["nodes"])
    kinds = {}
    for element in model.elements.values():
        kinds[element.type] = kinds.get(element.type, 0) + 1
    second = facts["order"] == 2
    wanted = {"CTRIA6" if second else "CTRIA3": facts["triangles"], "CQUAD8" if second else "CQUAD4": facts["quads"]}
    if facts["lines"] is not None:
        wanted["CBEAM3" if second else "CBAR"] = facts["lines"]
    expect("cards", kinds, {kind: n for kind, n in wanted.items() if n})


# plyfile


def plyfile_all(path, facts, share):
    from plyfile import PlyData

    ply = PlyData.read(path)
    vertices, faces = ply["vertex"], ply["face"]["vertex_indices"]
    points = np.stack([vertices["x"], vertices["y"], vertices["z"]], -1)
    by_size = {n: np.array([face for face in faces if len(face) == n]).reshape(-1, n) for n in (3, 4)}
    expect("triangles", len(by_size[3]), facts["triangles"])
    expect("quads", len(by_size[4]), facts["quads"])
    expect("area", area_of(points, [by_size[3].astype(int), by_size[4].astype(int)]), facts["area"], share)
    if facts["lines"]:
        expect("edges", len(ply["edge"]["vertex1"]), facts["lines"])


# gmsh

LINES, TRIANGLES, QUADS = (1, 8), (2, 9), (3, 16)


class Gmsh:
    """A file opened by gmsh; warnings and errors that it logs are failures."""

    def __init__(self, path):
        self.path = path

    def __enter__(self):
        import gmsh

        self.gmsh = gmsh
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        try:
            gmsh.merge(self.path)
        except Exception:
            gmsh.logger.stop()
            gmsh.finalize()
            raise
        said = [line for line in gmsh.logger.get() if not line.startswith(("Info", "Progress"))]
        gmsh.logger.stop()
        if said:
            gmsh.finalize()
            raise AssertionError(f"gmsh says {said[:3]}")
        return self

    def __exit__(self, *_):
        self.gmsh.finalize()

    def elements(self, entities=(None,)):
        """Element tags and corner nodes by type."""
        found = {}
        for entity in entities:
            types, tags, nodes = self.gmsh.model.mesh.getElements(*(entity or ()))
            for kind, some, on in zip(types, tags, nodes):
                found.setdefault(int(kind), []).append(on.reshape(len(some), -1))
        return {kind: np.concatenate(parts) for kind, parts in found.items()}

    def area(self, elements):
        tags, xyz, _ = self.gmsh.model.mesh.getNodes()
        place = np.zeros(int(tags.max()) + 1, dtype=int)
        place[tags.astype(int)] = np.arange(len(tags))
        cells = [place[nodes[:, :3].astype(int)] for kind, nodes in elements.items() if kind in TRIANGLES]
        cells += [place[nodes[:, :4].astype(int)] for kind, nodes in elements.items() if kind in QUADS]
        return area_of(xyz.reshape(-1, 3), cells)


def total(elements, kinds):
    return sum(len(nodes) for kind, nodes in elements.items() if kind in kinds)


def gmsh_stl(path, facts, _):
    with Gmsh(path) as file:
        expect("triangles", total(file.elements(), TRIANGLES), n_triangles(facts))


def gmsh_faces(path, facts, share):
    with Gmsh(path) as file:
        elements = file.elements()
        expect("triangles", total(elements, TRIANGLES), facts["triangles"])
        expect("quads", total(elements, QUADS), facts["quads"])
        expect("area", file.area(elements), facts["area"], share)


def gmsh_bdf(path, facts, share):
    gmsh_faces(path, facts, share)
    with Gmsh(path) as file:
        expect("nodes", len(file.gmsh.model.mesh.getNodes()[0]), facts["nodes"])
        expect("surfaces", len(file.gmsh.model.getEntities(2)), len(re.findall(r"^PSHELL", open(path).read(), re.M)))


def gmsh_msh(path, facts, share):
    gmsh_faces(path, facts, share)
    with Gmsh(path) as file:
        model = file.gmsh.model
        expect("nodes", len(model.mesh.getNodes()[0]), facts["nodes"])
        found = {}
        for dimension, tag in model.getPhysicalGroups():
            name = model.getPhysicalName(dimension, tag)
            elements = file.elements([(dimension, entity) for entity in model.getEntitiesForPhysicalGroup(dimension, tag)])
            n = sum(len(nodes) for nodes in elements.values())
            expect(f"nodes of {name} that gmsh finds", len(model.mesh.getNodesForPhysicalGroup(dimension, tag)[0]) > 0, True)
            key = "nodes" if dimension == 0 else "elements"
            found.setdefault(name, {"nodes": 0, "elements": 0})[key] += n
        for name, group in facts["groups"].items():
            sets = found[in_file(name, False)]
            expect(f"elements of {name}", sets["elements"], group["elements"])
            if not group["elements"]:
                expect(f"nodes of {name}", sets["nodes"], group["nodes"])
        model.mesh.getDuplicateNodes()
        expect("nodes twice", len(model.mesh.getDuplicateNodes()), 0)
