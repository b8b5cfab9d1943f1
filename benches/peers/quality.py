"""Measures that all meshing benchmarks share: quality of triangles and quads, CPU time of a block, peak memory.

Quality of a triangle: 2 r_in / R_circ (1 equilateral, 0 flat). Scaled Jacobian of a quad: the least sine of its corners."""
import json
import resource
import time

import numpy as np


class Cpu:
    """CPU seconds of a block, user and system."""

    def __enter__(self):
        self.start = time.process_time()
        return self

    def __exit__(self, *_):
        self.seconds = time.process_time() - self.start


def triangles(points, corners):
    """Mean and least quality, least angle and its first percentile in degrees."""
    a, b, c = (points[corners[:, k]] for k in range(3))
    x, y, z = (np.linalg.norm(p - q, axis=1) for p, q in ((b, c), (c, a), (a, b)))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    quality = 16 * area**2 / ((x + y + z) * x * y * z)
    corner = lambda side, p, q: np.arccos(np.clip((p**2 + q**2 - side**2) / (2 * p * q), -1, 1))
    least = np.degrees(np.minimum(np.minimum(corner(x, y, z), corner(y, z, x)), corner(z, x, y)))
    return {
        "triangles": len(corners),
        "quality": round(float(quality.mean()), 4),
        "worst": round(float(quality.min()), 4),
        "angle": round(float(least.min()), 2),
        "angle_1_percent": round(float(np.percentile(least, 1)), 2),
    }


def quads(points, corners):
    """Mean and least scaled Jacobian, share of inner nodes that do not have four quads."""
    v = points[corners]
    normal = np.cross(v[:, 2] - v[:, 0], v[:, 3] - v[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    sines = []
    for k in range(4):
        on, back = v[:, (k + 1) % 4] - v[:, k], v[:, k - 1] - v[:, k]
        lengths = np.linalg.norm(on, axis=1) * np.linalg.norm(back, axis=1)
        sines.append(np.einsum("ij,ij->i", np.cross(on, back), normal) / lengths)
    least = np.min(sines, 0)
    sides = np.sort(np.concatenate([corners[:, [k, (k + 1) % 4]] for k in range(4)]), 1)
    once, count = np.unique(sides, axis=0, return_counts=True)
    border = np.zeros(len(points), bool)
    border[once[count == 1].ravel()] = True
    used, number = np.unique(corners, return_counts=True)
    inner = ~border[used]
    return {
        "quads": len(corners),
        "jacobian": round(float(least.mean()), 4),
        "worst_jacobian": round(float(least.min()), 4),
        "irregular": round(float((number[inner] != 4).mean()), 4),
    }


def gmsh_mesh(gmsh):
    """Points, triangles and quads of Gmsh's current model, numbered from 0."""
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    number = np.zeros(int(tags.max()) + 1, np.int64)
    number[tags.astype(np.int64)] = np.arange(len(tags))
    of = lambda kind, n: number[gmsh.model.mesh.getElementsByType(kind)[1].astype(np.int64)].reshape(-1, n)
    return np.asarray(xyz).reshape(-1, 3), of(2, 3), of(3, 4)


def show(**figures):
    """One line of JSON, peak memory included."""
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({**figures, "memory_mb": round(memory)}))
