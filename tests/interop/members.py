"""Every element type of an INP deck under a load whose answer theory knows, solved by CalculiX.

Beam: length 2, square section of side 0.1, E 2.1e11, force F across at the tip: F L^3 / (3 E I).
Quarter of a circle, radius 1, clamped at its foot, force F outwards at its head: the head moves outwards by
pi F R^3 / (4 E I), by bending.
Truss: F L / (E A). Strip: length 2, width 0.2; pulled, its middle moves by F L / (2 E A); bent, its tip by F L^3 / (3 E I).
There is no Poisson's ratio and all is slender, so theory without shear holds. Sections are thin against the elements:
CalculiX makes solids of beams, trusses and shells, which give way beside hinges over about their own thickness.
"""
import math
import os

import solve

SHARE = 0.02
YOUNG = 2.1e11
FORCE = 1000.0

HEAD = """*INCLUDE, INPUT={deck}
*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.
{section}
*BOUNDARY
{held}
*STEP
*STATIC
*CLOAD
{loads}
*NODE PRINT, NSET={seen}
U
*END STEP
"""


class Member:
    def __init__(self, name, model, settings, deck, section, held, pulled, direction, seen, wanted):
        self.name, self.model, self.settings, self.deck = name, model, settings, deck
        self.section, self.held, self.pulled, self.direction = section, held, pulled, direction
        self.seen, self.wanted = seen, wanted

    def run(self, run_loft, work):
        folder = os.path.join(work, "member_" + self.name.replace(" ", "_"))
        run_loft(os.path.join(solve.HERE, "models", self.model), folder, *self.settings)
        nodes = solve.node_set(os.path.join(folder, self.deck), self.pulled)
        loads = "\n".join(f"{node}, {self.direction}, {FORCE / len(nodes)}" for node in sorted(nodes))
        text = HEAD.format(deck=self.deck, section=self.section, held=self.held, loads=loads, seen=self.seen)
        with open(os.path.join(folder, "job.inp"), "w", encoding="ascii") as file:
            file.write(text)
        moved = solve.calculix(folder).values()
        mean = sum(u[self.direction - 1] for u in moved) / len(moved)
        if not abs(mean - self.wanted) <= SHARE * self.wanted:
            raise AssertionError(f"moves by {mean:.6g}, theory says {self.wanted:.6g}")


def beams():
    bending = YOUNG * 0.1**4 / 12
    section = "*BEAM SECTION, ELSET={}, MATERIAL=steel, SECTION=RECT\n0.1, 0.1\n0., 1., 0."
    for element, order in [("B31", 1), ("B32", 2), ("B32R", 2)]:
        settings = ["--set", f"element={element}", "--set", f"degree={order}"]
        yield Member(f"beam of {element}", "beam.loft", settings, "beam.inp", section.format("member"), "root, 1, 6", "tip", 3, "tip", FORCE * 8 / (3 * bending))
        wanted = math.pi * FORCE / (4 * bending)
        yield Member(f"quarter of {element}", "beam.loft", settings, "quarter.inp", section.format("quarter"), "foot, 1, 6", "head", 3, "head", wanted)
    for element, order in [("T3D2", 1), ("T3D3", 2)]:
        settings = ["--set", f"element={element}", "--set", f"degree={order}"]
        truss = "*SOLID SECTION, ELSET=member, MATERIAL=steel\n1e-6"
        yield Member(f"truss of {element}", "beam.loft", settings, "beam.inp", truss, "root, 1, 3\nall, 2, 3", "tip", 1, "tip", FORCE * 2 / (YOUNG * 1e-6))


# CalculiX makes one layer of solids of S3 and S4R, of which the first is too stiff and the second has no stiffness against
# hourglasses when bent: these two are pulled only. Its M3D6 gives way about the
# hinges at its nodes six times too far, whoever numbers them, and is left out; S6 and CPS6 have the same order of nodes.
BENT = ["S4", "S6", "S8", "S8R"]
SHELLS = [("S3", "triangles", 1), ("S4", "quads", 1), ("S4R", "quads", 1), ("S6", "triangles", 2), ("S8", "quads", 2), ("S8R", "quads", 2)]
FLAT = [
    ("M3D3", "triangles", 1),
    ("M3D4", "quads", 1),
    ("M3D8", "quads", 2),
    ("CPS3", "triangles", 1),
    ("CPS4", "quads", 1),
    ("CPS6", "triangles", 2),
    ("CPS8", "quads", 2),
]


def strips():
    thick = 0.002
    for element, kind, order in SHELLS + FLAT:
        settings = ["--set", f"element={element}", "--set", f"kind={kind}", "--set", f"degree={order}"]
        word = "SHELL" if element.startswith("S") else "MEMBRANE" if element.startswith("M") else "SOLID"
        section = f"*{word} SECTION, ELSET=strip, MATERIAL=steel\n{thick}"
        held = "root, 1, 6" if element.startswith("S") else "root, 1, 2\nall, 3, 3"
        pulled = FORCE / (YOUNG * 0.2 * thick)
        yield Member(f"strip of {element} pulled", "strip.loft", settings, "strip.inp", section, held, "tip", 1, "middle", pulled)
        if element in BENT:
            bent = FORCE * 8 / (3 * YOUNG * 0.2 * thick**3 / 12)
            yield Member(f"strip of {element} bent", "strip.loft", settings, "strip.inp", section, held, "tip", 3, "tip", bent)


CASES = [*beams(), *strips()]
