"""The places of the worst triangles of some meshes, drawn side by side: each in the plane of its triangle, with the triangles about it coloured by
their least angle. Needs `pip install matplotlib numpy`."""
import numpy as np

# Reach of a drawing about the middle of the triangle, over its longest side.
REACH = 5.0


def corner_angles(points, corners):
    """Angles of triangles at their corners, degrees."""
    p = points[corners]
    out, back = np.roll(p, -1, 1) - p, np.roll(p, 1, 1) - p
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(out, back), axis=2), (out * back).sum(2)))


class Worst:
    """Keeps the places of the worst triangles of the `count` meshes that have the worst ones."""

    def __init__(self, count=5):
        self.count, self.kept = count, []

    def look(self, title, points, corners, counts=None):
        """Looks at one mesh; `counts` says which corners do (all where it is not given)."""
        angles = corner_angles(points, corners)
        least = (angles if counts is None else np.where(counts, angles, 180)).min(1)
        worst = int(least.argmin())
        a, b, c = points[corners[worst]]
        longest = max(np.linalg.norm(b - a), np.linalg.norm(c - b), np.linalg.norm(a - c))
        x = (b - a) / np.linalg.norm(b - a)
        up = np.cross(x, c - a)
        y = np.cross(up / np.linalg.norm(up), x)
        middle = (a + b + c) / 3
        away = points[corners] - middle
        near = (np.linalg.norm(away, axis=2).min(1) < REACH * longest) & (np.abs(away @ np.cross(x, y)).max(1) < REACH * longest)
        flat = np.stack([away[near] @ x, away[near] @ y], axis=2)
        self.kept.append((least[worst], title, flat, angles[near].min(1), int(near[:worst].sum()), REACH * longest))
        self.kept = sorted(self.kept, key=lambda one: one[0])[: self.count]

    def draw(self, path):
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        from PIL import Image
        from matplotlib.collections import PolyCollection

        figure, axes = plt.subplots(1, len(self.kept), figsize=(3.2 * len(self.kept), 3.6), squeeze=False)
        for axis, (angle, title, flat, least, worst, reach) in zip(axes[0], self.kept):
            cells = PolyCollection(flat, array=least, cmap="RdYlBu", clim=(15, 60), edgecolor="black", linewidth=0.4)
            axis.add_collection(cells)
            axis.add_patch(plt.Polygon(flat[worst], fill=False, edgecolor="black", linewidth=2))
            axis.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xticks=[], yticks=[])
            axis.set_title(f"{title}\n{angle:.1f}°", fontsize=8)
        figure.tight_layout()
        figure.savefig(path, dpi=70, bbox_inches="tight")
        with Image.open(path) as drawn:
            drawn.convert("RGB").quantize(48).save(path, optimize=True)
