"""Random trimmed nets, for loft, for OpenCASCADE and for numpy: the same surface and holes from one seed.

A net is about 100 mm wide, of degree 2 to 5 and 10 to 40 spans each way, with knots that are even, uneven or steep (neighbouring spans up to 12 times as long),
weights of 1, up to a quarter, or up to three times as large or as small, and control points that may be drawn together in the plane, so that lengths
along u and v change over it. It is a sheet, rolled about a line, or bent both ways (dome or saddle), with waves on it; the least radius of
curvature is that drawn with the net: from 50 times its width, all but flat, to a fifth of it. One to twelve circles and closed splines of the
plane of (u, v) are its holes."""
import math
import random

import numpy as np

WIDTH = 100.0


class Side:
    """Knots and degree of one direction."""

    def __init__(self, degree, stops):
        self.degree, self.stops = degree, np.asarray(stops)
        self.knots = np.r_[np.zeros(degree), self.stops, np.ones(degree)]
        self.count = len(self.stops) - 1 + degree

    def greville(self):
        return np.array([self.knots[i + 1 : i + 1 + self.degree].mean() for i in range(self.count)])

    def basis(self, t, order=1):
        """The first of the `degree` + 1 points at each t, and their values and derivatives up to an order."""
        t = np.clip(t, 0, 1)
        span = np.clip(np.searchsorted(self.stops, t, side="right") - 1, 0, len(self.stops) - 2) + self.degree
        rows = [[np.ones_like(t)]]
        for d in range(1, self.degree + 1):
            row = [np.zeros_like(t) for _ in range(d + 1)]
            for r, below in enumerate(rows[-1]):
                low, high = self.knots[span - d + 1 + r], self.knots[span + 1 + r]
                share = below / (high - low)
                row[r] = row[r] + (high - t) * share
                row[r + 1] = row[r + 1] + (t - low) * share
            rows.append(row)
        found = []
        for k in range(order + 1):
            values = rows[self.degree - k] if k <= self.degree else None
            for d in range(self.degree - k + 1, self.degree + 1) if values is not None else ():
                slopes = [np.zeros_like(t) for _ in range(d + 1)]
                for r, below in enumerate(values):
                    share = d * below / (self.knots[span + 1 + r] - self.knots[span - d + 1 + r])
                    slopes[r], slopes[r + 1] = slopes[r] - share, slopes[r + 1] + share
                values = slopes
            found.append(np.stack(values, -1) if values is not None else np.zeros((len(t), self.degree + 1)))
        return span - self.degree, found

    def matrices(self, t, order):
        """Of values and derivatives at each t by all points."""
        first, found = self.basis(t, order)
        at = first[:, None] + np.arange(self.degree + 1)
        made = []
        for values in found:
            made.append(np.zeros((len(t), self.count)))
            np.put_along_axis(made[-1], at, values, 1)
        return made


class Surface:
    """A rational net: `points` of u by v by 3, and weights."""

    def __init__(self, u, v, points, weights):
        self.u, self.v, self.points, self.weights = u, v, points, weights
        self.poles = np.concatenate([points * weights[..., None], weights[..., None]], -1)

    def evaluate(self, u, v):
        """Points with ∂u and ∂v."""
        (i, (a, a1)), (j, (b, b1)) = self.u.basis(u), self.v.basis(v)
        net = self.poles[(i[:, None] + np.arange(a.shape[1]))[:, :, None], (j[:, None] + np.arange(b.shape[1]))[:, None, :]]
        by_v, by_v1 = np.matmul(b[:, None, None, :], net)[:, :, 0], np.matmul(b1[:, None, None, :], net)[:, :, 0]
        total = lambda p, rows: np.matmul(p[:, None, :], rows)[:, 0]
        s, su, sv = total(a, by_v), total(a1, by_v), total(a, by_v1)
        p = s[:, :3] / s[:, 3:]
        return p, (su[:, :3] - su[:, 3:] * p) / s[:, 3:], (sv[:, :3] - sv[:, 3:] * p) / s[:, 3:]

    def curvatures(self, n=241):
        """Largest principal curvature in size, and the area about it, on a grid."""
        t = (np.arange(n) + 0.5) / n
        a, b = self.u.matrices(t, 2), self.v.matrices(t, 2)
        of = lambda i, j: np.einsum("xi,ijk,yj->xyk", a[i], self.poles, b[j], optimize=True)
        s = {(i, j): of(i, j) for i, j in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))}
        w = s[0, 0][..., 3:]
        p = s[0, 0][..., :3] / w
        d = lambda i, j, rest: (s[i, j][..., :3] - rest) / w
        du, dv = (d(i, j, s[i, j][..., 3:] * p) for i, j in ((1, 0), (0, 1)))
        wu, wv = s[1, 0][..., 3:], s[0, 1][..., 3:]
        duu = d(2, 0, s[2, 0][..., 3:] * p + 2 * wu * du)
        dvv = d(0, 2, s[0, 2][..., 3:] * p + 2 * wv * dv)
        duv = d(1, 1, s[1, 1][..., 3:] * p + wu * dv + wv * du)
        normal = np.cross(du, dv)
        area = np.linalg.norm(normal, axis=-1)
        normal /= area[..., None]
        e, f, g = (du * du).sum(-1), (du * dv).sum(-1), (dv * dv).sum(-1)
        l, m, k = ((x * normal).sum(-1) for x in (duu, duv, dvv))
        det = e * g - f * f
        mean, gauss = (e * k - 2 * f * m + g * l) / (2 * det), (l * k - m * m) / det
        return np.abs(mean) + np.sqrt(np.maximum(mean**2 - gauss, 0)), area / n**2


class Net:
    """The surface of a seed and its holes: ("circle", centre, radius) or ("spline", points), in (u, v)."""

    def __init__(self, seed, spans=(10, 40)):
        draw = random.Random(1000 + seed)
        self.seed = seed
        self.kind = ("sheet", "rolled", "doubly bent")[seed % 3]
        self.knots = draw.choice(["even", "uneven", "steep"])
        ratio = {"even": 1.0, "uneven": 3.0, "steep": 12.0}[self.knots]
        u, v = (Side(draw.randint(2, 5), stops(draw, draw.randint(*spans), ratio)) for _ in range(2))
        self.heavy = draw.choice([1.0, 1.25, 3.0])
        self.drawn = draw.choice([0.0, 0.0, 0.5, 0.75])
        self.radius = WIDTH * 0.2 * 250 ** draw.choice([0.0, draw.random() ** 2, draw.random()])
        self.holes = holes(draw)
        self.surface = self.bent(draw, u, v)
        curvature, area = self.surface.curvatures()
        self.bend = float((curvature * area).sum())

    def bent(self, draw, u, v):
        """The surface of which one place in a thousand has a smaller radius than that of the seed."""
        tall = draw.uniform(0.6, 1.0)
        pull = [(draw.uniform(0.3, 0.7), self.drawn * draw.choice([-1, 1])) for _ in range(2)]
        x, y = (pulled(side.greville(), *pull[k]) for k, side in enumerate((u, v)))
        # About as dense as the points, so that no wave is shorter than three of the widest spans.
        widest = max(3 * np.diff(u.stops).max(), 3 * np.diff(v.stops).max(), 0.3)
        waves = [(draw.uniform(0.5, 1) / widest, draw.uniform(0, 2 * math.pi), draw.uniform(0, 2 * math.pi), draw.random()) for _ in range(4)]
        x, y = np.meshgrid(x, y, indexing="ij")
        wave = sum(a * np.sin(2 * math.pi * f * (x * math.cos(t) + y * math.sin(t)) + q) / f**2 for f, t, q, a in waves)
        i, j = np.meshgrid(np.arange(u.count), np.arange(v.count), indexing="ij")
        weights = self.heavy ** np.sin(draw.uniform(0.3, 0.9) * i + draw.uniform(0.3, 0.9) * j)
        share, saddle = draw.uniform(0.1, 0.6), draw.choice([-1.0, 1.0])

        def surface(amount):
            shift = wave * amount * WIDTH * (1.0 if self.kind == "sheet" else share * 0.2)
            turn = 2.0 * min(amount * 6, 1.4)
            if self.kind == "rolled":
                radius = WIDTH / turn
                angle = (x - 0.5) * turn
                at = np.stack([(radius - shift) * np.sin(angle), tall * WIDTH * y, radius - (radius - shift) * np.cos(angle)], -1)
            elif self.kind == "doubly bent":
                a, b = (x - 0.5) * WIDTH, (y - 0.5) * tall * WIDTH
                at = np.stack([a, b, (a**2 + saddle * b**2) * amount * 2 / WIDTH + shift], -1)
            else:
                at = np.stack([x * WIDTH, y * tall * WIDTH, shift], -1)
            return Surface(u, v, np.round(at, 6), np.round(weights, 6))

        low, high = 0.0, 1.0
        for _ in range(24):
            middle = 0.5 * (low + high)
            sharpest = np.quantile(surface(middle).curvatures(101)[0], 0.999)
            low, high = (middle, high) if sharpest * self.radius < 1 else (low, middle)
        return surface(low)

    def limits(self, triangles=(2_000, 15_000, 120_000)):
        """Chord errors at which OpenCASCADE makes about so many triangles."""
        return [float(f"{self.bend / (1.117 * n):.3g}") for n in triangles]

    def loft(self, limit, settings="", name="net.obj"):
        """The script, with one mesh `fine` within a chord error and its file; without a file where `name` is empty."""
        row = lambda values: "[" + ", ".join(values) + "]"
        number = lambda x: f"{float(x):.6f}".rstrip("0").rstrip(".")
        points = [row(f"({', '.join(map(number, p))})" for p in line) for line in self.surface.points.swapaxes(0, 1)]
        weights = [row(map(number, line)) for line in self.surface.weights.T]
        knots = [row(map(repr, map(float, side.knots))) for side in (self.surface.u, self.surface.v)]
        lines = ["units mm", "let net = [", *(f"  {line}," for line in points[:-1]), f"  {points[-1]}", "]"]
        lines += ["let weights = [", *(f"  {line}," for line in weights[:-1]), f"  {weights[-1]}", "]", "surface whole = nurbs_surface("]
        lines += [f"  net, degree_u: {self.surface.u.degree}, degree_v: {self.surface.v.degree},", f"  knots_u: {knots[0]},", f"  knots_v: {knots[1]},"]
        lines += ["  weights: weights", ")"]
        for k, hole in enumerate(self.holes):
            made = f"circle(center: {point(hole[1])}, radius: {hole[2]!r})" if hole[0] == "circle" else f"spline({row(map(point, hole[1]))}, closed: true)"
            lines.append(f"curve h{k} = {made}")
        lines.append(f"surface face = trim(whole, holes: [{', '.join(f'h{k}' for k in range(len(self.holes)))}], uv: true)")
        lines.append(f"mesh fine of face {{ size: {WIDTH:.0f}mm  chord_error: {limit!r}mm{settings} }}")
        lines += [f'export fine to "{name}"'] if name else []
        return "\n".join(lines) + "\n"


def stops(draw, spans, ratio):
    """Knots from 0 to 1 whose distances are up to `ratio` apart."""
    widths = [ratio ** draw.random() for _ in range(spans)]
    return [round(sum(widths[:k]) / sum(widths), 6) for k in range(spans)] + [1.0]


def pulled(t, to, amount):
    """Places drawn together about `to` (or apart), in order and from 0 to 1."""
    of = lambda t: t - amount * 0.16 * np.tanh((t - to) / 0.16)
    return (of(t) - of(0.0)) / (of(1.0) - of(0.0))


def holes(draw):
    """One to twelve, at least 0.02 apart and 0.03 from the sides of the net."""
    found, discs = [], []
    wanted = draw.randint(1, 12)
    for _ in range(2000):
        if len(found) == wanted:
            break
        kind, radius = draw.choice(["circle", "spline"]), draw.uniform(0.025, 0.11)
        reach = radius * (1.25 if kind == "spline" else 1.0)
        centre = [draw.uniform(reach + 0.03, 1 - reach - 0.03) for _ in range(2)]
        waves, turn = [draw.uniform(-0.15, 0.15) for _ in range(8)], draw.uniform(0, math.pi)
        if any(math.dist(centre, other) < reach + far + 0.02 for other, far in discs):
            continue
        discs.append((centre, reach))
        at = lambda k: (radius * (1 + waves[k]), turn + 2 * math.pi * k / 8)
        ring = [(centre[0] + r * math.cos(t), centre[1] + r * math.sin(t)) for r, t in map(at, range(8))]
        rounded = lambda p: tuple(round(x, 6) for x in p)
        found.append(("circle", rounded(centre), round(radius, 6)) if kind == "circle" else ("spline", [rounded(p) for p in ring]))
    return found


def point(p):
    return f"({p[0]!r}, {p[1]!r})"
