"""Reads GLB with trimesh, pygltflib and Khronos' validator, and 3MF with trimesh and lib3mf, and compares counts, areas, names, sets
and bodies with what is known of the mesh.

`facts` are those of read_back, with the names of the surfaces and, where they are known, `metre` (model units in a metre), `box` (least and
greatest coordinates) and `bodies` {name: volume}, of the model.
"""
import os
import subprocess

import numpy as np

from read_back import SINGLE, area_of, expect, n_triangles

HERE = os.path.dirname(os.path.abspath(__file__))
# How far the volume of a coarse mesh may be from that of its surfaces.
COARSE = 0.15
# How far the box of a coarse mesh may be from that of its surfaces, as a share of its size.
ROUGH = 5e-3


def quoted(name):
    """The name of a set in a file of JSON or XML: ribs[3] -> ribs_3."""
    return name.replace("][", "_").replace("[", "_").replace("]", "")


def surfaces(facts):
    return {quoted(name) for name in facts["surfaces"]}


def expect_set(facts, name, halves):
    """A set of faces has as many triangles as it should: two for each quad."""
    known = {quoted(name): group["elements"] for name, group in facts["groups"].items()}
    if facts["triangles"] == 0 or facts["quads"] == 0:
        expect(f"triangles of {name}", halves, known[name] * (2 if facts["quads"] else 1))


def trimesh_scene(path):
    import trimesh

    return trimesh.load_scene(path, process=False)


# GLB


def glb_trimesh(path, facts, _):
    import trimesh

    scene = trimesh_scene(path)
    meshes = [shape for shape in scene.geometry.values() if isinstance(shape, trimesh.Trimesh)]
    expect("triangles", sum(len(mesh.faces) for mesh in meshes), n_triangles(facts))
    expect("area", sum(mesh.area for mesh in meshes) * facts.get("metre", 1.0) ** 2, facts["area"], SINGLE)
    expect("materials", {mesh.visual.material.name for mesh in meshes}, surfaces(facts))
    for mesh in meshes:
        # A normal of a vertex is on the side to which its triangles turn.
        sides = np.einsum("ij,ikj->ik", mesh.face_normals, mesh.vertex_normals[mesh.faces])
        if not (sides > 0.5).all():
            raise AssertionError(f"a normal is {sides.min()} off its triangle")


def glb_pygltflib(path, facts, _):
    """Numbers by their offsets in the buffer, places in the axes of the model, sets by their ranges."""
    from pygltflib import GLTF2

    gltf = GLTF2().load(path)
    blob, metre = gltf.binary_blob(), facts.get("metre", 1.0)

    def numbers(index):
        accessor = gltf.accessors[index]
        view = gltf.bufferViews[accessor.bufferView]
        kind, width = {5126: ("<f4", 3), 5125: ("<u4", 1)}[accessor.componentType]
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        return np.frombuffer(blob, kind, accessor.count * width, start).reshape(-1, width)

    (node,), (mesh,) = gltf.nodes, gltf.meshes
    expect("name", mesh.name, node.name)
    triangles, lines, points, places, names = [], [], [], [], set()
    for primitive in mesh.primitives:
        place = numbers(primitive.attributes.POSITION).astype(float) + np.array(node.translation)
        # z is up in the model.
        place = np.stack([place[:, 0], -place[:, 2], place[:, 1]], -1) * metre
        places.append(place)
        indices = np.arange(len(place)) if primitive.indices is None else numbers(primitive.indices).ravel()
        {4: triangles, 1: lines, 0: points}[primitive.mode].append((place, indices))
        if primitive.mode == 4:
            names.add(primitive.extras["name"])
            expect("the name of the material", gltf.materials[primitive.material].name, primitive.extras["name"])
    expect("surfaces", names, surfaces(facts))
    expect("triangles", sum(len(indices) for _, indices in triangles) // 3, n_triangles(facts))
    expect("area", sum(area_of(place, [indices.reshape(-1, 3)]) for place, indices in triangles), facts["area"], SINGLE)
    if facts["lines"] is not None:
        expect("lines", sum(len(indices) for _, indices in lines) // 2, facts["lines"])
    if "box" in facts:
        every = np.concatenate(places)
        for side, wanted in zip([every.min(axis=0), every.max(axis=0)], facts["box"]):
            expect(f"box {side}", bool(np.allclose(side, wanted, atol=ROUGH * np.ptp(every))), True)
    groups = {group["name"]: group["elements"] for group in mesh.extras["groups"]}
    wanted = {quoted(name) for name, group in facts["groups"].items() if group["elements"]}
    if not wanted <= set(groups):
        raise AssertionError(f"groups {sorted(wanted - set(groups))} are missing")
    for name in wanted:
        runs = groups[name]
        modes = {mesh.primitives[run["primitive"]].mode for run in runs}
        if modes == {4}:
            expect_set(facts, name, sum(run["count"] for run in runs))


def glb_validator(path, _facts, _share):
    """Khronos' validator finds no error and no warning."""
    packages = os.path.join(HERE, "..", "..", "target", "interop", "gltf", "node_modules")
    script = os.path.join(HERE, "validate_glb.js")
    done = subprocess.run(["node", script, path], env={**os.environ, "NODE_PATH": packages}, capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"{done.stdout[-1500:]}{done.stderr[-500:]}")


# 3MF


def to_millimetres(facts):
    """Length in millimetres of one model unit; decks whose unit nobody knows are in millimetres."""
    return 1000.0 / facts["metre"] if "metre" in facts else 1.0


def expect_bodies(facts, volumes):
    """Bodies by name, with volumes in cubic millimetres."""
    if "bodies" in facts:
        expect("bodies", set(volumes), set(facts["bodies"]))
        for name, volume in facts["bodies"].items():
            expect(f"volume of {name}", volumes[name], volume * to_millimetres(facts) ** 3, COARSE)


def threemf_trimesh(path, facts, share):
    scene = trimesh_scene(path)
    expect("unit", scene.units, "millimeter")
    bodies = scene.geometry
    expect("triangles", sum(len(body.faces) for body in bodies.values()), n_triangles(facts))
    expect("area", sum(body.area for body in bodies.values()), facts["area"] * to_millimetres(facts) ** 2, share)
    for name, body in bodies.items():
        if not (body.is_watertight and body.is_winding_consistent and body.volume > 0):
            raise AssertionError(f"{name}: watertight {body.is_watertight}, even {body.is_winding_consistent}, volume {body.volume}")
    expect_bodies(facts, {name: body.volume for name, body in bodies.items()})


def threemf_lib3mf(path, facts, share):
    import lib3mf

    wrapper = lib3mf.Wrapper() if hasattr(lib3mf, "Wrapper") else lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(path)
    expect("warnings", [reader.GetWarning(k) for k in range(reader.GetWarningCount())], [])
    expect("unit", model.GetUnit(), lib3mf.ModelUnit.MilliMeter)
    triangles, area, volumes, sets = 0, 0.0, {}, {}
    objects = model.GetMeshObjects()
    while objects.MoveNext():
        body = objects.GetCurrentMeshObject()
        expect(f"{body.GetName()} is closed and points outwards", body.IsManifoldAndOriented(), True)
        points = np.array([list(vertex.Coordinates) for vertex in body.GetVertices()])
        corners = np.array([list(triangle.Indices) for triangle in body.GetTriangleIndices()])
        triangles += len(corners)
        area += area_of(points, [corners])
        a, b, c = (points[corners[:, k]] for k in range(3))
        volumes[body.GetName()] = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
        for k in range(body.GetTriangleSetCount()):
            own = body.GetTriangleSet(k)
            sets[own.GetName()] = sets.get(own.GetName(), 0) + len(own.GetTriangleList())
    expect("triangles", triangles, n_triangles(facts))
    # Coordinates are single there.
    expect("area", area, facts["area"] * to_millimetres(facts) ** 2, max(share, SINGLE))
    expect_bodies(facts, volumes)
    names = set()
    materials = model.GetBaseMaterialGroups()
    while materials.MoveNext():
        group = materials.GetCurrentBaseMaterialGroup()
        names |= {group.GetName(k) for k in group.GetAllPropertyIDs()}
    expect("materials", names, surfaces(facts))
    if not surfaces(facts) <= set(sets):
        raise AssertionError(f"sets {sorted(surfaces(facts) - set(sets))} are missing")
    for name, count in sets.items():
        expect_set(facts, name, count)
    items = model.GetBuildItems()
    expect("items to build", items.Count(), len(volumes))
