"""Random plates with holes, for loft and for Gmsh: the same outlines and holes from one seed.

A plate is a rectangle, an L or a closed spline of about 240 mm × 150 mm, with 8 to 40 holes (circles, slots, closed splines) whose webs are
at least `web` wide: 1 mm to 4 mm, drawn with the plate. Everything lies in z = 0 and in millimetres."""
import math
import random

WIDTH, HEIGHT = 240.0, 150.0


class Plate:
    """Outline and holes; each is a list of pieces: ("circle", centre, radius), ("slot", a, b, radius) or ("spline", points)."""

    def __init__(self, seed):
        draw = random.Random(seed)
        self.seed, self.web = seed, draw.choice([1.0, 1.5, 2.0, 3.0, 4.0])
        self.kind = ("rectangle", "L", "spline")[seed % 3]
        if self.kind == "rectangle":
            self.outline = [(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)]
        elif self.kind == "L":
            x, y = WIDTH * draw.uniform(0.35, 0.6), HEIGHT * draw.uniform(0.35, 0.6)
            self.outline = [(0, 0), (WIDTH, 0), (WIDTH, y), (x, y), (x, HEIGHT), (0, HEIGHT)]
        else:
            n = draw.randint(8, 14)
            at = lambda k: (1 + draw.uniform(-0.12, 0.12), 2 * math.pi * k / n)
            polar = [at(k) for k in range(n)]
            self.outline = [(WIDTH / 2 * (1 + r * math.cos(t)), HEIGHT / 2 * (1 + r * math.sin(t))) for r, t in polar]
        self.border = spline(self.outline) if self.kind == "spline" else self.outline
        # The curve that tells where a spline's plate is lies off that of loft and that of Gmsh.
        self.slack = 4.0 if self.kind == "spline" else 0.0
        self.holes, discs = [], []
        wanted, tries = draw.randint(8, 40), 0
        while len(self.holes) < wanted and tries < 4000:
            tries += 1
            kind = draw.choices(["circle", "slot", "spline"], [6, 2, 2])[0]
            centre = (draw.uniform(0, WIDTH), draw.uniform(0, HEIGHT))
            radius = draw.uniform(1.2, 9.0)
            turn, longer = draw.uniform(0, math.pi), draw.uniform(1.2, 3.0)
            waves = [draw.uniform(-0.15, 0.15) for _ in range(8)]
            if kind == "slot":
                half = radius * (longer - 1)
                a = (centre[0] - half * math.cos(turn), centre[1] - half * math.sin(turn))
                b = (centre[0] + half * math.cos(turn), centre[1] + half * math.sin(turn))
                hole, own = ("slot", a, b, radius), capsule(a, b, radius)
            elif kind == "spline":
                at = lambda k: (radius * (1 + waves[k]), turn + 2 * math.pi * k / 8)
                points = [(centre[0] + r * math.cos(t), centre[1] + r * math.sin(t)) for r, t in map(at, range(8))]
                hole, own = ("spline", points), [(centre, 1.25 * radius)]
            else:
                hole, own = ("circle", centre, radius), [(centre, radius)]
            if all(self.is_clear(c, r + self.slack) for c, r in own) and all(math.dist(c, d) > r + s + self.web for c, r in own for d, s in discs):
                self.holes.append(hole)
                discs += own

    def is_clear(self, centre, radius):
        """Whether a disc lies inside the outline, a web away from it."""
        corners = self.border
        edges = list(zip(corners, corners[1:] + corners[:1]))
        crossed = sum((a[1] > centre[1]) != (b[1] > centre[1]) and crossing(a, b, centre[1]) > centre[0] for a, b in edges)
        return crossed % 2 == 1 and all(to_segment(centre, a, b) > radius + self.web for a, b in edges)

    def loft(self, settings):
        """The script, with one mesh `fine` of these settings and its file."""
        lines = ["units mm"]
        name = "spline" if self.kind == "spline" else "polyline"
        lines.append(f"curve rim = {name}([{', '.join(map(point, self.outline))}], closed: true)")
        for k, hole in enumerate(self.holes):
            if hole[0] == "circle":
                lines.append(f"curve h{k} = circle(center: {point(hole[1])}, radius: {hole[2]!r})")
            elif hole[0] == "spline":
                lines.append(f"curve h{k} = spline([{', '.join(map(point, hole[1]))}], closed: true)")
            else:
                p, q, r, s, left, right = sides(*hole[1:])
                arcs = f"arc({point(q)}, {point(r)}, through: {point(right)})", f"arc({point(s)}, {point(p)}, through: {point(left)})"
                lines.append(f"curve h{k} = line({point(p)}, {point(q)}) + {arcs[0]} + line({point(r)}, {point(s)}) + {arcs[1]}")
        names = ", ".join(f"h{k}" for k in range(len(self.holes)))
        lines += [f"surface plate = trim(plane(rim), holes: [{names}])", f"mesh fine of plate {{ {settings} }}", 'export fine to "fine.obj"']
        return "\n".join(lines) + "\n"

    def gmsh(self, gmsh):
        """The same in Gmsh's current model."""
        occ = gmsh.model.occ

        def closed_spline(points):
            tags = [occ.addPoint(x, y, 0) for x, y in points]
            return occ.addCurveLoop([occ.addSpline(tags + tags[:1])])

        if self.kind == "spline":
            loops = [closed_spline(self.outline)]
        else:
            tags = [occ.addPoint(x, y, 0) for x, y in self.outline]
            loops = [occ.addCurveLoop([occ.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1])])]
        for hole in self.holes:
            if hole[0] == "circle":
                loops.append(occ.addCurveLoop([occ.addCircle(*hole[1], 0, hole[2])]))
            elif hole[0] == "spline":
                loops.append(closed_spline(hole[1]))
            else:
                # A half circle about its centre may go either way: it goes through the middle of the round end.
                p, q, r, s, left, right = (occ.addPoint(x, y, 0) for x, y in sides(*hole[1:]))
                arc = lambda start, through, end: occ.addCircleArc(start, through, end, center=False)
                loops.append(occ.addCurveLoop([occ.addLine(p, q), arc(q, right, r), occ.addLine(r, s), arc(s, left, p)]))
        occ.addPlaneSurface(loops)
        occ.synchronize()


def sides(a, b, radius):
    """Corners of a slot in turn, and the middles of its round ends at `a` and at `b`."""
    way = ((b[0] - a[0]) / math.dist(a, b), (b[1] - a[1]) / math.dist(a, b))
    off = lambda p, x, y: (p[0] + radius * (x * way[0] - y * way[1]), p[1] + radius * (x * way[1] + y * way[0]))
    return off(a, 0, -1), off(b, 0, -1), off(b, 0, 1), off(a, 0, 1), off(a, -1, 0), off(b, 1, 0)


def capsule(a, b, radius):
    """Discs that cover a slot but for a hundredth of its radius."""
    n = max(1, math.ceil(math.dist(a, b) / (0.2 * radius)))
    return [((a[0] + (b[0] - a[0]) * k / n, a[1] + (b[1] - a[1]) * k / n), radius) for k in range(n + 1)]


def spline(points):
    """Points along a closed Catmull-Rom curve: near enough to tell where the plate is."""
    n, found = len(points), []
    for k in range(n):
        p, q, r, s = (points[(k + j - 1) % n] for j in range(4))
        for i in range(10):
            t = i / 10
            weights = (-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, -(t**2) + t**3)
            found.append(tuple(0.5 * sum(w * c[d] for w, c in zip(weights, (p, q, r, s))) for d in (0, 1)))
    return found


def crossing(a, b, y):
    return a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])


def to_segment(p, a, b):
    length = math.dist(a, b) ** 2
    t = 0 if length == 0 else max(0, min(1, ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length))
    return math.dist(p, (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))


def point(p):
    return f"({p[0]!r}, {p[1]!r})"
