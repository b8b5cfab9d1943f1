"""Elements that bend, measured by other programs through their own shape functions: nodes in another order than the
program's would give another length or area. The model is a quarter of a cylinder of radius 1 and height 1 with its foot."""
import math

import numpy as np

import read_back

# Elements of order 2 and 200 mm follow a circle of radius 1 m within this share; those of order 1 do not by far.
BENT = 1e-4
POINTS = 0.5 + np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)]) / 2
WEIGHTS = np.array([5, 8, 5]) / 18
# A rule for triangles that is exact for polynomials of degree 4 (Dunavant): barycentric corner, weight.
TRIANGLE = [(0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322)]


def expected(order, steps):
    """Length of the foot in so many steps, and area of the wall."""
    length = math.pi / 2 if order == 2 else steps * 2 * math.sin(math.pi / (4 * steps))
    return length, length


def rule(dimension, corners):
    """Places in a reference element from 0 to 1, and their weights."""
    if dimension == 1:
        return [((u,), w) for u, w in zip(POINTS, WEIGHTS)]
    if corners == 4:
        return [((u, v), wu * wv) for u, wu in zip(POINTS, WEIGHTS) for v, wv in zip(POINTS, WEIGHTS)]
    places = []
    for a, w in TRIANGLE:
        for u, v in [(a, a), (a, 1 - 2 * a), (1 - 2 * a, a)]:
            places.append(((u, v), w / 2))
    return places


def measure(at, dimension, corners):
    """Length or area of an element from `at(place)`, by differences of its own shape functions."""
    total, h = 0.0, 1e-5
    for place, weight in rule(dimension, corners):
        slopes = []
        for k in range(dimension):
            ahead, behind = list(place), list(place)
            ahead[k] += h
            behind[k] -= h
            slopes.append((at(ahead) - at(behind)) / (2 * h))
        total += weight * (np.linalg.norm(slopes[0]) if dimension == 1 else np.linalg.norm(np.cross(*slopes)))
    return total


def compare(found, order, steps, lines=True):
    length, area = expected(order, steps)
    if lines:
        read_back.expect("length", found[1], length, BENT)
    read_back.expect("area", found[2], area, BENT)


def by_gmsh(path, order, steps, lines=True):
    """Gmsh integrates the Jacobians of its own elements."""
    with read_back.Gmsh(path) as file:
        mesh, found = file.gmsh.model.mesh, {1: 0.0, 2: 0.0}
        for kind in mesh.getElementTypes():
            dimension = mesh.getElementProperties(kind)[1]
            if dimension == 0:
                continue
            places, weights = mesh.getIntegrationPoints(kind, "Gauss4")
            _, determinants, _ = mesh.getJacobians(kind, places)
            found[dimension] += float((np.array(determinants).reshape(-1, len(weights)) * weights).sum())
    compare(found, order, steps, lines)


def by_vtk(path, order, steps):
    """VTK evaluates places in its own cells."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid, found = reader.GetOutput(), {0: 0.0, 1: 0.0, 2: 0.0}
    for k in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(k)

        def at(place, cell=cell):
            point, weights = [0.0] * 3, [0.0] * cell.GetNumberOfPoints()
            from vtkmodules.vtkCommonCore import reference

            cell.EvaluateLocation(reference(0), list(place) + [0.0] * (3 - len(place)), point, weights)
            return np.array(point)

        dimension = cell.GetCellDimension()
        if dimension:
            found[dimension] += measure(at, dimension, cell.GetNumberOfEdges())
    compare(found, order, steps)


def by_pynastran(path, order, steps):
    """pyNastran names the nodes of each card as the manual does; ends or corners first, then the middles of the sides."""
    from pyNastran.bdf.bdf import read_bdf

    model = read_bdf(path, xref=False, debug=None)
    point = {number: node.xyz for number, node in model.nodes.items()}
    found, kinds = {1: 0.0, 2: 0.0}, set()
    for element in model.elements.values():
        kinds.add(element.type)
        nodes = [point[n] for n in element.node_ids if n]
        line = element.type.startswith("CB")
        corners = 2 if line else 3 if "TRIA" in element.type else 4
        if line and not np.linalg.norm(np.cross(element.x, nodes[1] - nodes[0])) > 1e-3:
            raise AssertionError(f"beam {element.eid} lies along its own plane {element.x}")
        sides = [(0, 1)] if line else [(k, (k + 1) % corners) for k in range(corners)]
        for (a, b), mid in zip(sides, nodes[corners:]):
            # The middle of a side stands beside the middle of its chord.
            if not np.linalg.norm(mid - (nodes[a] + nodes[b]) / 2) <= 0.1 * np.linalg.norm(nodes[b] - nodes[a]):
                raise AssertionError(f"{element.type} {element.eid}: node {mid} is not in the middle of its side")
        if line and len(nodes) == 3:
            found[1] += measure(lambda u: quadratic(nodes, u[0]), 1, 2)
        elif line:
            found[1] += float(np.linalg.norm(nodes[1] - nodes[0]))
    wanted = {1: {"CBAR"}, 2: {"CBEAM3"}}[order]
    if not wanted <= kinds:
        raise AssertionError(f"cards {sorted(kinds)}, expected {sorted(wanted)}")
    read_back.expect("length", found[1], expected(order, steps)[0], BENT)


def quadratic(nodes, u):
    """Place on a line of three nodes: end, end, middle."""
    return nodes[0] * (1 - u) * (1 - 2 * u) + nodes[1] * u * (2 * u - 1) + nodes[2] * 4 * u * (1 - u)


def checks(folder, order, steps):
    """(label, check) for each file of the model in a folder."""
    path = lambda name: f"{folder}/{name}"
    for name in ["curved.msh", "curved_binary.msh"]:
        yield f"{name} by gmsh", lambda name=name: by_gmsh(path(name), order, steps)
    for name in ["curved.vtu", "curved_text.vtu"]:
        yield f"{name} by vtk", lambda name=name: by_vtk(path(name), order, steps)
    yield "curved.bdf by gmsh", lambda: by_gmsh(path("curved.bdf"), order, steps, lines=order == 1)
    yield "curved.bdf by pyNastran", lambda: by_pynastran(path("curved.bdf"), order, steps)
    # The corners alone, whatever the order.
    yield "curved.obj by gmsh", lambda: by_gmsh(path("curved.obj"), 1, steps, lines=False)
    yield "curved.ply by plyfile", lambda: by_plyfile(path("curved.ply"), steps)
    yield "curved.stl by gmsh", lambda: by_gmsh(path("curved.stl"), 1, steps, lines=False)


def by_plyfile(path, steps):
    from plyfile import PlyData

    ply = PlyData.read(path)
    vertices, edges = ply["vertex"], ply["edge"]
    points = np.stack([vertices["x"], vertices["y"], vertices["z"]], -1)
    length = np.linalg.norm(points[edges["vertex1"]] - points[edges["vertex2"]], axis=1).sum()
    faces = ply["face"]["vertex_indices"]
    area = sum(read_back.area_of(points, [np.array([face])]) for face in faces)
    read_back.expect("length", length, expected(1, steps)[0], BENT)
    read_back.expect("area", area, expected(1, steps)[1], BENT)
