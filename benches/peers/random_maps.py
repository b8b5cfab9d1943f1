"""usage: random_maps.py LOFT [--cases N] [--first SEED] [--before OTHER] [--write FOLDER]

Meshes random bent surfaces that have a map with quads under a chord error, an angle, or both, and prints one line a mesh and a table of least, 10 %, median
and largest value of every figure: extruded and turned profiles with roundings of a twentieth to a two thousandth of the size, ruled waves, skins, slim
ellipses, walls with a floor, walls on each other. With --before the same by another program, whose elements, seconds and least angles are set beside
ours. `--write` writes the script of each case and `truth.json` with its quads into a folder. Whole runs of one thread."""
import argparse
import json
import pathlib
import random
import resource
import subprocess
import tempfile

KINDS = 9
# Seconds after which a run is ended.
LONGEST = 60


def spline(rnd, count, size, height, y):
    step = size / (count - 1)
    shift = lambda i: rnd.uniform(-0.3, 0.3) * step if 0 < i < count - 1 else 0
    points = [(i * step + shift(i), y + rnd.uniform(-0.3, 0.3) * height, rnd.uniform(-height, height)) for i in range(count)]
    return "spline([" + ", ".join("(%.4f, %.4f, %.4f)" % p for p in points) + "])"


def rim(size, rounding, z=0.0, scale=1.0):
    places = [(0, 0), (1, 0), (1, 0.4), (0.6, 0.7), (0, 0.5)]
    points = ", ".join("(%.3f, %.3f, %.3f)" % (x * size * scale, y * size * scale, z) for x, y in places)
    return f"polyline([{points}], closed: true, round: {rounding:.4f}mm)"


def profile(size, rounding, places):
    points = ", ".join("(%.3f, 0, %.3f)" % (x * size, z * size) for x, z in places)
    return f"polyline([{points}], round: {rounding:.4f}mm)"


def case(seed):
    """A script with a mesh `m`, and its chord error in mm or `None`."""
    rnd = random.Random(seed)
    size = rnd.choice([50, 100, 400])
    height = size * rnd.choice([0.02, 0.1, 0.25])
    rounding = size * rnd.choice([0.0005, 0.002, 0.01, 0.05])
    name = "s"
    match seed % KINDS:
        case 0:
            body = f"surface s = ruled({spline(rnd, rnd.randint(4, 12), size, height, 0)}, {spline(rnd, rnd.randint(4, 12), size, height, size / 2)})"
        case 1:
            bends = profile(size, rounding, [(0, 0), (0.3, 0), (0.35, 0.2), (0.6, 0.25), (1, 0)])
            body = f"surface s = extrude({bends}, by: (0, {size * 0.3:.3f}, 0))"
        case 2:
            bends = profile(size, rounding, [(0.1, 0), (0.3, 0), (0.35, 0.2), (0.5, 0.25), (0.45, 1)])
            body = f"surface s = revolve({bends}, angle: {rnd.choice([40, 180, 360])}deg)"
        case 3:
            body = f"surface s = extrude({rim(size, rounding)}, by: (0, {size * rnd.random() * 0.3:.2f}, {size}))"
        case 4:
            body = f"curve rim = {rim(size, rounding)}\nsurface wall = extrude(rim, by: (0, 0, {size * 0.3:.2f}))\nsurface floor = plane(rim)\nshell s of wall, floor"
        case 5:
            sections = [rim(size, rounding), rim(size, rounding * 2, size * 0.5, 0.8), rim(size, rounding, size, 1.1)]
            body = f"surface s = skin([{', '.join(sections)}])"
        case 6:
            a, b = spline(rnd, 6, size, height, 0), spline(rnd, 6, size, height, size)
            body = f"curve a = {a}\ncurve b = {b}\nsurface s = coons(a, line(a.end, b.end), b, line(a.start, b.start))"
        case 7:
            body = (f"curve p = {rim(size, rounding)}\ncurve q = {rim(size, rounding * 1.5, size * 0.4, 0.9)}\nsurface low = ruled(p, q)\n"
                    f"surface high = extrude(q, by: (0, 0, {size * 0.3:.2f}))\nshell s of low, high")
        case _:
            oval = f"ellipse(center: ({size}, 0, 0), major: ({size * 0.3:.3f}, 0, 0), minor: (0, 0, {size * 0.02:.3f}))"
            body = f"surface s = revolve({oval}, angle: {rnd.choice([60, 360])}deg)"
    chord, angle = size * rnd.choice([0.0003, 0.001, 0.004]), rnd.choice([None, 8, 15])
    which = rnd.choice(["chord", "angle", "both"]) if angle else "chord"
    limits = (f"  chord_error: {chord:.5f}mm" if which != "angle" else "") + (f"  angle_error: {angle}deg" if which != "chord" else "")
    mesh = f"mesh m of {name} {{ size: {size * rnd.choice([0.04, 0.1]):.4f}mm{limits}  elements: quads }}"
    check = f'check "kept": m.chord_error <= {chord:.5f}mm\n' if which != "angle" else ""
    return f"units mm\n{body}\n{mesh}\n{check}"


def run(program, script):
    """Exit status, CPU seconds and the mesh of a run."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([program, "run", script, "--threads", "1", "--json"], capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return f"over {LONGEST} s", None, None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    meshes = json.loads(done.stdout)["meshes"] if done.stdout else []
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, round(seconds, 3), meshes[0] if meshes else None


def figures(status, seconds, mesh):
    if mesh is None:
        return {"status": status}
    return {"status": status, "quads": mesh["quads"], "seconds": seconds, "least angle": round(mesh["min_angle"], 1), "worst": round(mesh["min_quality"], 3)}


def table(rows):
    keys = [key for key in rows[0] if all(isinstance(row.get(key), (int, float)) for row in rows)]
    for key in keys:
        values = sorted(row[key] for row in rows)
        print(f"| {key} | {values[0]} | {values[len(values) // 10]} | {values[len(values) // 2]} | {values[-1]} |")


def main():
    ask = argparse.ArgumentParser(usage=__doc__)
    ask.add_argument("loft")
    ask.add_argument("--cases", type=int, default=45)
    ask.add_argument("--first", type=int, default=0)
    ask.add_argument("--before")
    ask.add_argument("--write")
    asked = ask.parse_args()
    folder = pathlib.Path(asked.write or tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    rows, truth = [], {}
    for seed in range(asked.first, asked.first + asked.cases):
        script = folder / f"map{seed}.loft"
        script.write_text(case(seed))
        own = figures(*run(asked.loft, script))
        line = {f"ours: {key}": value for key, value in own.items()}
        if asked.before:
            other = figures(*run(asked.before, script))
            line |= {f"before: {key}": value for key, value in other.items()}
            if own.get("quads") and other.get("quads"):
                line["ratio of quads"] = round(own["quads"] / other["quads"], 3)
        print(seed, line, flush=True)
        if own.get("quads"):
            rows.append(line)
            truth[script.stem] = {"quads": own["quads"], "least_angle": own["least angle"]}
    if asked.write:
        (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    table([row for row in rows if not asked.before or "ratio of quads" in row])


main()
