"""Random shells of 10 to 60 faces as scripts for loft, with what is known of each: faces, Euler number and, where it can be had without loft, area.

Kinds, in turn: bicubic patches of one smooth lattice, with trimmed holes; solids of revolution, in sectors, with poles and holes; boxes with
rounded edges and drilled tunnels; domes of arcs with faces of three and four sides; round tubes with elbows and caps; ducts of rounded
rectangles with elbows; nets of splines. Lengths in millimetres, shells of 60 to 250 mm."""
import math
import random

import numpy as np

KINDS = ("patches", "turned", "box", "dome", "tube", "duct", "net")


class Shell:
    """`lines` of the script, up to the shell `all`; `faces`, `euler`, `area` (or None), `kind`."""

    def __init__(self, seed):
        self.seed, self.kind = seed, KINDS[seed % len(KINDS)]
        self.draw = random.Random(1000 + seed)
        self.lines, self.surfaces, self.faces, self.area, self.euler = ["units mm"], [], 0, 0.0, 0
        globals()[self.kind](self)

    def face(self, name, value, area, count=1):
        """Adds a surface of so many faces."""
        self.lines.append(f"surface {name} = {value}")
        self.surfaces.append(name)
        self.faces += count
        self.area = None if area is None or self.area is None else self.area + area

    def loft(self, settings, files=True):
        """The script, with one mesh `fine` of these settings and files of mesh and shell."""
        end = [f"shell all of {', '.join(self.surfaces)}", f"mesh fine of all {{ {settings} }}"]
        files = ['export fine to "fine.obj"', 'export all to "all.step"', "report [{area: all.area}]"] if files else []
        return "\n".join(self.lines + end + files) + "\n"


def at(p):
    return "(" + ", ".join(map(number, p)) + ")"


def number(x):
    return repr(round(float(x), 9))


def unit(v):
    return np.asarray(v, float) / np.linalg.norm(v)


def turned_about(v, axis, angle):
    """A vector turned about an axis."""
    v, axis = np.asarray(v, float), unit(axis)
    return v * math.cos(angle) + np.cross(axis, v) * math.sin(angle) + axis * (axis @ v) * (1 - math.cos(angle))


class Hole:
    """An ellipse or a polygon in (u, v), star-shaped about its centre."""

    def __init__(self, draw, centre, radii):
        self.centre, self.radii = np.array(centre), np.array(radii)
        self.corners = None
        if draw.random() < 0.25:
            n, turn = draw.randint(3, 6), draw.uniform(0, 2 * math.pi)
            angles = turn + 2 * math.pi * np.arange(n) / n
            self.corners = self.centre + self.radii * np.stack([np.cos(angles), np.sin(angles)], 1)

    def curve(self):
        (u, v), (a, b) = self.centre, self.radii
        if self.corners is not None:
            return f"polyline([{', '.join(map(at, self.corners))}], closed: true)"
        if abs(a - b) < 1e-12:
            return f"circle(center: {at((u, v, 0))}, radius: {number(a)})"
        major, minor = ((a, 0, 0), (0, b, 0)) if a > b else ((0, b, 0), (-a, 0, 0))
        return f"ellipse({at((u, v, 0))}, major: {at(major)}, minor: {at(minor)}, from: 0deg, to: 360deg)"

    def integral(self, density):
        """Of a density of (u, v) over the hole."""
        x, w = np.polynomial.legendre.leggauss(24)
        x, w = 0.5 * (x + 1), 0.5 * w
        pieces = []
        if self.corners is None:
            for k in range(8):
                t = 2 * math.pi * (k + x) / 8
                rim = self.radii * np.stack([np.cos(t), np.sin(t)], 1)
                turn = 2 * math.pi / 8 * self.radii.prod() * np.ones_like(t)
                pieces.append((rim, turn))
        else:
            for p, q in zip(self.corners - self.centre, np.roll(self.corners, -1, 0) - self.centre):
                rim = p + x[:, None] * (q - p)
                pieces.append((rim, np.full(len(x), p[0] * q[1] - p[1] * q[0])))
        total = 0.0
        for rim, turn in pieces:
            for s, ws in zip(x, w):
                u, v = (self.centre + s * rim).T
                total += ws * s * float(np.sum(w * turn * density(u, v)))
        return total


def trimmed(shell, name, value, whole, holes, density):
    """A face with holes in (u, v)."""
    for k, hole in enumerate(holes):
        shell.lines.append(f"let {name}_h{k} = {hole.curve()}")
    names = ", ".join(f"{name}_h{k}" for k in range(len(holes)))
    area = None if whole is None else whole - sum(hole.integral(density) for hole in holes)
    shell.face(name, f"trim({value}, holes: [{names}], uv: true)" if holes else value, area)
    shell.euler -= len(holes)


BEZIER = np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6


def patches(shell):
    """Bicubic patches between the knots of one cubic B-spline lattice."""
    draw = shell.draw
    n, m = draw.randint(3, 8), draw.randint(3, 7)
    widths = [[draw.uniform(0.6, 1.6) for _ in range(k + 3)] for k in (n, m)]
    x, y = (25 * np.cumsum(w) for w in widths)
    waves = [(draw.uniform(4, 14), draw.uniform(0.01, 0.05), draw.uniform(0, 6), draw.uniform(0.01, 0.05)) for _ in range(3)]
    lattice = np.zeros((m + 3, n + 3, 3))
    for j in range(m + 3):
        for i in range(n + 3):
            z = sum(a * math.sin(f * x[i] + p) * math.cos(g * y[j]) for a, f, p, g in waves)
            lattice[j, i] = x[i] + draw.uniform(-3, 3), y[j] + draw.uniform(-3, 3), z
    shell.euler = 1
    for j in range(m):
        for i in range(n):
            net = np.einsum("ab,bcd,ec->aed", BEZIER, lattice[j : j + 4, i : i + 4], BEZIER)
            rows = ", ".join("[" + ", ".join(map(at, row)) + "]" for row in net)
            density = lambda u, v, net=net: bezier_density(net, u, v)
            holes = []
            if draw.random() < 0.3:
                if draw.random() < 0.25:
                    holes = [Hole(draw, (0.27, draw.uniform(0.3, 0.7)), (0.17, 0.2)), Hole(draw, (0.72, draw.uniform(0.3, 0.7)), (0.2, 0.2))]
                else:
                    radius = draw.uniform(0.08, 0.35)
                    centre = [draw.uniform(0.45, 0.55) for _ in range(2)]
                    holes = [Hole(draw, centre, (radius, radius if draw.random() < 0.5 else radius * draw.uniform(0.5, 1.1)))]
            trimmed(shell, f"p{j}_{i}", f"bezier_surface([{rows}])", square(density), holes, density)


def bezier_density(net, u, v):
    b = lambda t: np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3])
    d = lambda t: 3 * np.stack([-((1 - t) ** 2), (1 - t) ** 2 - 2 * t * (1 - t), 2 * t * (1 - t) - t * t, t * t])
    du, dv = np.einsum("ak,bk,abd->kd", b(v), d(u), net), np.einsum("ak,bk,abd->kd", d(v), b(u), net)
    return np.linalg.norm(np.cross(du, dv), axis=1)


def square(density):
    """The integral of a density over 0…1 in both directions."""
    x, w = np.polynomial.legendre.leggauss(24)
    u, v = np.meshgrid(0.5 * (x + 1), 0.5 * (x + 1))
    return float(np.sum(0.25 * np.outer(w, w).ravel() * density(u.ravel(), v.ravel())))


def rounded(points, radii):
    """Lines and arcs along a polyline (of two or three coordinates) with rounded corners: ("line", a, b) and ("arc", a, b, middle, centre)."""
    pieces, last = [], np.asarray(points[0], float)
    for p, q, r, radius in zip(points, points[1:], points[2:], radii):
        p, q, r = (np.asarray(x, float) for x in (p, q, r))
        back, on = unit(p - q), unit(r - q)
        half = math.acos(np.clip(back @ on, -1, 1)) / 2
        reach = radius / math.tan(half)
        a, b = q + reach * back, q + reach * on
        centre = q + unit(back + on) * radius / math.sin(half)
        middle = centre - unit(back + on) * radius
        pieces += [("line", last, a), ("arc", a, b, middle, centre)]
        last = b
    return pieces + [("line", last, np.asarray(points[-1], float))]


def curve(piece):
    return f"line({at(piece[1])}, {at(piece[2])})" if piece[0] == "line" else f"arc({at(piece[1])}, {at(piece[2])}, through: {at(piece[3])})"


def turned(shell):
    """A profile of lines and arcs in x and z, turned about z: in sectors, or whole."""
    draw = shell.draw
    corners = draw.randint(3, 6)
    ends = [draw.random() < 0.75, draw.random() < 0.75]
    z, points = 0.0, []
    for k in range(corners):
        points.append((draw.uniform(25, 60), 0.0, z))
        z += draw.uniform(25, 50)
    if ends[0]:
        points.insert(0, (0.0, 0.0, points[0][2] - draw.choice([0.0, 0.0, 15.0, 40.0])))
    if ends[1]:
        points.append((0.0, 0.0, points[-1][2] + draw.choice([0.0, 0.0, 15.0, 40.0])))
    least = min(math.dist(p, q) for p, q in zip(points, points[1:]))
    radii = [draw.uniform(0.08, 0.25) * least for _ in points[1:-1]]
    pieces = rounded(points, radii)
    if ends[1] and draw.random() < 0.7:
        # A part of a sphere instead of the last cone.
        a = pieces[-1][1]
        pieces[-1] = ("arc", a, np.array([0.0, 0.0, a[2] + a[0]]), np.array([a[0] * math.sqrt(0.5), 0, a[2] + a[0] * math.sqrt(0.5)]), np.array([0, 0, a[2]]))
    fewest, most = -(-10 // len(pieces)), max(60 // len(pieces), 1)
    sectors = draw.choice([k for k in (1, 2, 3, 4, 5, 6) if fewest <= k <= most])
    shell.euler = sum(ends)
    for k, piece in enumerate(pieces):
        turn = 2 * math.pi / sectors
        density = revolved_density(piece, turn)
        for j in range(sectors):
            start = [piece[0]] + [turned_about(p, (0, 0, 1), j * turn) for p in piece[1:]]
            inner = min(piece[1][0], piece[2][0]) > 5
            holes = []
            length = math.dist(piece[1], piece[2])
            if inner and piece[0] == "line" and draw.random() < 0.35 and length > 8:
                around = turn * 0.5 * (piece[1][0] + piece[2][0])
                radius = draw.uniform(0.15, 0.35) * min(length, around / 2)
                holes = [Hole(draw, (draw.uniform(0.4, 0.6), 0.5), (radius / around, radius / length))]
            value = f"revolve({curve(start)}, axis: (0, 0, 1), about: (0, 0, 0), angle: {360 / sectors!r}deg)"
            trimmed(shell, f"t{k}_{j}", value, square(density), holes, density)


def revolved_density(piece, turn):
    """Area per (u, v) of a piece of a profile turned by so much, for lines and for arcs by their angle."""
    if piece[0] == "line":
        r, dr, length = piece[1][0], piece[2][0] - piece[1][0], math.dist(piece[1], piece[2])
        return lambda u, v: turn * length * np.abs(r + dr * v)
    a, b, _, c = piece[1:]
    angle = 2 * math.asin(min(1.0, math.dist(a, b) / 2 / math.dist(a, c)))
    radius = math.dist(a, c)
    normal = unit(np.cross(a - c, b - c))
    return lambda u, v: turn * radius * angle * np.abs([c[0] + turned_about(a - c, normal, angle * t)[0] for t in np.atleast_1d(v)])


def box(shell):
    """A box whose edges are quarters of cylinders and whose corners are octants of spheres, with tunnels along z, x or y."""
    draw = shell.draw
    sides = np.array([draw.uniform(40, 120) for _ in range(3)])
    r = draw.uniform(0.06, 0.3) * sides.min()
    inner = sides / 2 - r
    axes = np.eye(3)
    tunnels = {0: [], 1: [], 2: []}
    main = draw.randrange(3)
    for _ in range(draw.randint(0, 9)):
        u, v = [k for k in range(3) if k != main]
        radius = draw.uniform(0.04, 0.16) * min(inner[u], inner[v]) * 2
        centre = np.array([draw.uniform(-1, 1) * max(inner[k] - radius - 1.5, 0) for k in (u, v)])
        fits = all(inner[k] - radius - 1.5 > 0 for k in (u, v))
        if fits and all(math.dist(centre, c) > radius + s + 1.5 for c, s in tunnels[main]):
            tunnels[main].append((centre, radius))
    shell.euler = 2 - 2 * len(tunnels[main])
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        for sign in (-1, 1):
            corner = lambda a, b: sign * sides[d] / 2 * axes[d] + a * inner[u] * axes[u] + b * inner[v] * axes[v]
            rim = f"polyline([{', '.join(at(corner(a, b)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)))}], closed: true)"
            name = f"side{d}{'n' if sign < 0 else 'p'}"
            holes, area = [], 4 * inner[u] * inner[v]
            for k, (centre, radius) in enumerate(tunnels[d]):
                about = sign * sides[d] / 2 * axes[d]
                for value, axis in zip(centre, [k for k in range(3) if k != d]):
                    about = about + value * axes[axis]
                holes.append(f"{name}_c{k}")
                shell.lines.append(f"let {holes[-1]} = circle(center: {at(about)}, radius: {number(radius)}, normal: {at(axes[d])})")
                area -= math.pi * radius**2
                if sign < 0:
                    wall = 2 * math.pi * radius * sides[d]
                    shell.face(f"tunnel{k}", f"extrude({holes[-1]}, by: {at(sides[d] * axes[d])})", wall)
            plane = f"plane({rim})"
            shell.face(name, f"trim({plane}, holes: [{', '.join(holes)}])" if holes else plane, area)
        for a in (-1, 1):
            for b in (-1, 1):
                middle = a * inner[u] * axes[u] + b * inner[v] * axes[v] - inner[d] * axes[d]
                ways = (a * axes[u], unit(a * axes[u] + b * axes[v]), b * axes[v])
                p, through, q = (at(middle + r * way) for way in ways)
                name = f"edge{d}{'n' if a < 0 else 'p'}{'n' if b < 0 else 'p'}"
                shell.face(name, f"extrude(arc({p}, {q}, through: {through}), by: {at(2 * inner[d] * axes[d])})", math.pi * r * inner[d])
    for signs in [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]:
        centre = np.array(signs) * inner
        way = [s * e for s, e in zip(signs, axes)]
        p, through, q = (at(centre + r * w) for w in (way[0], unit(way[0] + way[2]), way[2]))
        turn = 90 * signs[0] * signs[1]
        name = "corner" + "".join("n" if s < 0 else "p" for s in signs)
        about = f"line({at(centre)}, {at(centre + axes[2])})"
        shell.face(name, f"revolve(arc({p}, {q}, through: {through}), axis: {about}, angle: {turn}deg)", math.pi / 2 * r * r)


def dome(shell):
    """Faces of three and four arcs between points of a sphere: an octahedron divided in four, or an icosahedron, some pairs of its faces as one,
    some left out."""
    draw = shell.draw
    points, triangles = (octahedron if draw.random() < 0.4 else icosahedron)()
    radius = draw.uniform(40, 90)
    points = [unit(p + np.array([draw.uniform(-0.08, 0.08) for _ in range(3)])) * radius for p in points]
    faces = pairs(draw, [tuple(t) for t in triangles], draw.choice([0.0, 0.4, 0.8]))
    for _ in range(min(draw.choice([0, 0, 1, 2, 3]), len(faces) - 10)):
        faces.pop(draw.randrange(len(faces)))
    bulge = draw.uniform(0.9, 1.06)
    edges = {}
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1]):
            edges.setdefault((min(a, b), max(a, b)), f"e{len(edges)}")
    for (a, b), name in edges.items():
        middle = unit(points[a] + points[b]) * radius * bulge
        shell.lines.append(f"curve {name} = arc({at(points[a])}, {at(points[b])}, through: {at(middle)})")
    for k, face in enumerate(faces):
        names = [edges[min(a, b), max(a, b)] for a, b in zip(face, face[1:] + face[:1])]
        shell.face(f"f{k}", f"coons({', '.join(names)})", None)
    shell.euler = len({p for face in faces for p in face}) - len(edges) + len(faces)


def octahedron():
    points = [np.array(p, float) for p in ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    coarse = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (1, 0, 5), (2, 1, 5), (3, 2, 5), (0, 3, 5)]
    middles, fine = {}, []

    def middle(a, b):
        if (min(a, b), max(a, b)) not in middles:
            middles[min(a, b), max(a, b)] = len(points)
            points.append(unit(points[a] + points[b]))
        return middles[min(a, b), max(a, b)]

    for a, b, c in coarse:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        fine += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return points, fine


def icosahedron():
    g = (1 + math.sqrt(5)) / 2
    points = [np.array(p, float) for a in (-1, 1) for b in (-g, g) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    side = min(np.linalg.norm(points[0] - p) for p in points[1:])
    near = lambda i, j: abs(np.linalg.norm(points[i] - points[j]) - side) < 1e-9
    triangles = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near(i, j) and near(j, k) and near(k, i)]
    out = lambda t: np.linalg.det([points[n] for n in t]) > 0
    return points, [t if out(t) else (t[0], t[2], t[1]) for t in triangles]


def pairs(draw, triangles, share):
    """Triangles, of which some that share a side are one face of four."""
    faces, used = [], set()
    order = list(range(len(triangles)))
    draw.shuffle(order)
    for k in order:
        if k in used:
            continue
        used.add(k)
        t = triangles[k]
        partner = None
        if draw.random() < share:
            sides = {(b, a): c for a, b, c in ((t[0], t[1], t[2]), (t[1], t[2], t[0]), (t[2], t[0], t[1]))}
            for n in order:
                o = triangles[n]
                shared = [(a, b, c) for a, b, c in ((o[0], o[1], o[2]), (o[1], o[2], o[0]), (o[2], o[0], o[1])) if (a, b) in sides]
                if n not in used and shared:
                    a, b, c = shared[0]
                    partner = (n, (a, sides[a, b], b, c))
                    break
        if partner:
            used.add(partner[0])
            faces.append((partner[1][0], partner[1][3], partner[1][2], partner[1][1])[::-1])
        else:
            faces.append(t)
    return faces


def path(draw, legs, bend, least):
    """Lines and arcs of a path of so many legs in space, with elbows of radius `bend`."""
    way, points = unit([draw.uniform(-1, 1) for _ in range(3)]), [np.zeros(3)]
    for _ in range(legs):
        points.append(points[-1] + way * draw.uniform(2.2, 4.0) * least)
        side = unit(np.cross(way, [draw.uniform(-1, 1) for _ in range(3)]))
        angle = draw.uniform(0.5, 1.5)
        way = math.cos(angle) * way + math.sin(angle) * side
    return rounded(points, [bend] * (legs - 1))


def swept(shell, pieces, section, holes_of):
    """Pieces of a section along pieces of a path; `section(frame)` gives its pieces at a frame (origin, normal, binormal)."""
    origin, way = pieces[0][1], unit(pieces[0][2] - pieces[0][1])
    normal = unit(np.cross(way, [0.3, 0.5, 0.8]))
    first = (origin, normal, np.cross(way, normal))
    frame = first
    for k, piece in enumerate(pieces):
        profile = section(frame)
        for j, part in enumerate(profile):
            name = f"s{k}_{j}"
            if piece[0] == "line":
                by = piece[2] - piece[1]
                whole = length(part) * math.dist(piece[1], piece[2])
                holes = holes_of(part, math.dist(piece[1], piece[2]))
                trimmed(shell, name, f"extrude({curve(part)}, by: {at(by)})", whole, holes, lambda u, v, w=whole: w * np.ones_like(u))
            else:
                centre, a, b = piece[4], piece[1] - piece[4], piece[2] - piece[4]
                axis = unit(np.cross(a, b))
                angle = math.acos(np.clip(unit(a) @ unit(b), -1, 1))
                area = angle * about_axis(part, centre, axis)
                value = f"revolve({curve(part)}, axis: line({at(centre)}, {at(centre + 10 * axis)}), angle: {math.degrees(angle)!r}deg)"
                shell.face(name, value, area)
        if piece[0] == "line":
            frame = (frame[0] + piece[2] - piece[1], *frame[1:])
        else:
            frame = (centre + turned_about(frame[0] - centre, axis, angle), *(turned_about(x, axis, angle) for x in frame[1:]))
    return first, frame


def length(part):
    if part[0] == "line":
        return math.dist(part[1], part[2])
    radius = math.dist(part[1], part[4])
    return 2 * radius * math.asin(min(1.0, math.dist(part[1], part[2]) / 2 / radius))


def about_axis(part, centre, axis):
    """The integral of the distance from an axis along a line or arc in a plane through the axis."""
    x, w = np.polynomial.legendre.leggauss(24)
    total = 0.0
    for s, ws in zip(0.5 * (x + 1), 0.5 * w):
        if part[0] == "line":
            p = part[1] + s * (part[2] - part[1])
        else:
            a, b = part[1] - part[4], part[2] - part[4]
            angle = 2 * math.asin(min(1.0, math.dist(part[1], part[2]) / 2 / np.linalg.norm(a)))
            p = part[4] + turned_about(a, np.cross(a, b), angle * s)
        total += ws * np.linalg.norm(np.cross(p - centre, axis)) * length(part)
    return total


def tube(shell):
    """A round tube with elbows, in quarters or thirds round, its ends open, flat or round."""
    draw = shell.draw
    r = draw.uniform(8, 20)
    pieces = path(draw, draw.randint(2, 4), r * draw.uniform(1.4, 2.0), r * draw.uniform(2.2, 3.0))
    count = draw.choice([k for k in (2, 3, 4, 6) if 10 <= k * len(pieces) <= 52])

    def section(frame):
        spot = lambda t: frame[0] + r * (math.cos(t) * frame[1] + math.sin(t) * frame[2])
        step = 2 * math.pi / count
        return [("arc", spot(k * step), spot((k + 1) * step), spot((k + 0.5) * step), frame[0]) for k in range(count)]

    def holes_of(part, long):
        around = length(part)
        if draw.random() < 0.35 and long > 6:
            radius = draw.uniform(0.12, 0.4) * min(around, long)
            return [Hole(draw, (0.5, 0.5), (radius / long, radius / around))]
        return []

    first, last = swept(shell, pieces, section, holes_of)
    for name, frame, out in (("a", first, -1), ("b", last, 1)):
        kind = draw.choice(["open", "flat", "round"])
        rims = [curve(part) for part in section(frame)]
        way = np.cross(frame[1], frame[2]) * out
        if kind == "flat":
            shell.face(f"cap_{name}", f"plane([{', '.join(rims)}])", math.pi * r * r)
        elif kind == "round":
            for k, part in enumerate(section(frame)):
                tip = frame[0] + r * way
                side = part[1] - frame[0]
                arc = f"arc({at(part[1])}, {at(tip)}, through: {at(frame[0] + unit(side + r * way) * r)})"
                value = f"revolve({arc}, axis: line({at(frame[0])}, {at(frame[0] + 10 * np.cross(frame[1], frame[2]))}), angle: {360 / count!r}deg)"
                shell.face(f"cap_{name}{k}", value, 2 * math.pi * r * r / count)
        shell.euler += kind != "open"


def duct(shell):
    """A rectangle with rounded corners along lines and elbows, its ends open or flat."""
    draw = shell.draw
    a, b = draw.uniform(12, 30), draw.uniform(12, 30)
    r = draw.uniform(0.08, 0.4) * min(a, b)
    pieces = path(draw, draw.randint(2, 4), 0.5 * math.hypot(a, b) * draw.uniform(1.3, 2.0), 0.5 * math.hypot(a, b) * draw.uniform(1.8, 2.6))

    def section(frame):
        spot = lambda x, y: frame[0] + x * frame[1] + y * frame[2]
        h, k, found = a / 2, b / 2, []
        for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            centre = spot(sx * (h - r), sy * (k - r))
            ends = [centre + r * sx * frame[1], centre + r * sy * frame[2]]
            p, q = ends if sx * sy > 0 else ends[::-1]
            found.append(("arc", p, q, centre + r * unit(p + q - 2 * centre), centre))
        return [x for n in range(4) for x in (found[n], ("line", found[n][2], found[(n + 1) % 4][1]))]

    def holes_of(part, long):
        if part[0] == "line" and draw.random() < 0.35 and min(long, length(part)) > 6:
            radius = draw.uniform(0.15, 0.4) * min(length(part), long)
            return [Hole(draw, (draw.uniform(0.45, 0.55), 0.5), (radius / long, radius / length(part)))]
        return []

    first, last = swept(shell, pieces, section, holes_of)
    for name, frame in (("a", first), ("b", last)):
        if draw.random() < 0.5:
            rims = [curve(part) for part in section(frame)]
            shell.face(f"cap_{name}", f"plane([{', '.join(rims)}])", a * b - (4 - math.pi) * r * r)
            shell.euler += 1


def net(shell):
    """A surface through a net of splines, a face for each of its cells."""
    draw = shell.draw
    n, m = draw.randint(5, 9), draw.randint(4, 7)
    x, y = (30 * np.cumsum([draw.uniform(0.6, 1.5) for _ in range(k)]) for k in (n, m))
    waves = [(draw.uniform(4, 12), draw.uniform(0.01, 0.04), draw.uniform(0, 6), draw.uniform(0.01, 0.04)) for _ in range(3)]
    z = lambda i, j: sum(a * math.sin(f * x[i] + p) * math.cos(g * y[j]) for a, f, p, g in waves)
    points = [[(x[i] + draw.uniform(-4, 4), y[j] + draw.uniform(-4, 4), z(i, j)) for i in range(n)] for j in range(m)]
    for j in range(m):
        shell.lines.append(f"curve u{j} = spline([{', '.join(at(points[j][i]) for i in range(n))}])")
    for i in range(n):
        shell.lines.append(f"curve v{i} = spline([{', '.join(at(points[j][i]) for j in range(m))}])")
    lists = ", ".join(f"u{j}" for j in range(m)), ", ".join(f"v{i}" for i in range(n))
    word = draw.choice(["coons", "gordon"])
    shell.face("net", f"coons(u: [{lists[0]}], v: [{lists[1]}])" if word == "coons" else f"gordon([{lists[0]}], [{lists[1]}])", None, (n - 1) * (m - 1))
    shell.euler = 1
