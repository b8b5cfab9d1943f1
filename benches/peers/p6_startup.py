"""usage: p6_startup.py DIR    100 000 points and 100 000 lines, for loft and for Gmsh

Writes points100k.loft and points100k.geo. To compare, time the whole processes:

    loft run points100k.loft -o out
    gmsh -0 points100k.geo -o points100k.geo_unrolled -v 0
"""
import os
import sys

folder = sys.argv[1]
os.makedirs(folder, exist_ok=True)
n = 100000


def write(name, lines):
    with open(os.path.join(folder, name), "w") as out:
        out.write("\n".join(lines) + "\n")


def place(i):
    return f"{i * 0.001:.3f}, {(i * 7919) % 1000 / 1000:.3f}, 0"


loft = [f"point p{i} = ({place(i)})" for i in range(n)]
loft += [f"curve c{i} = line(p{i}, p{(i + 1) % n})" for i in range(n)]
write("points100k.loft", loft)

geo = [f"Point({i + 1}) = {{{place(i)}, 0.1}};" for i in range(n)]
geo += [f"Line({i + 1}) = {{{i + 1}, {(i + 1) % n + 1}}};" for i in range(n)]
write("points100k.geo", geo)
