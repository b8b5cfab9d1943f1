"""CalculiX solves decks that loft wrote, under small decks of ours that include them and use their sets.

Plate: square, side a, simply supported, uniform pressure q: the middle sinks by 0.00406235 q a^4 / D (Navier).
Roof: radius 25, length 50, half angle 40 degrees, thickness 0.25, E 4.32e8, weight 90 per area, on diaphragms: the
middle of the eaves sinks by 0.3024 ([Scordelis & Lo 1964]; the value shells converge to, [MacNeal & Harder 1985]).
"""
import os
import shutil
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SHARE = 0.02

PLATE = """*INCLUDE, INPUT={deck}
*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*SHELL SECTION, ELSET=plate, MATERIAL=steel
0.01
*BOUNDARY
rim, 3, 3
pins, 1, 2
*STEP
*STATIC
*DLOAD
plate, P, -1000.
*NODE PRINT, NSET=plate
U
*END STEP
"""

ROOF = """*INCLUDE, INPUT={deck}
*NSET, NSET=anchor
{anchor}
*MATERIAL, NAME=concrete
*ELASTIC
4.32e8, 0.
*DENSITY
360.
{sections}
*BOUNDARY
diaphragms, 1, 1
diaphragms, 3, 3
anchor, 2, 2
*STEP
*STATIC
*DLOAD
{weights}
*NODE PRINT, NSET=eaves
U
*END STEP
"""


SHEET = """*INCLUDE, INPUT={deck}
*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*SHELL SECTION, ELSET=left, MATERIAL=steel
0.1
*SHELL SECTION, ELSET=right_1, MATERIAL=steel
0.1
*BEAM SECTION, ELSET=rim, MATERIAL=steel, SECTION=RECT
0.1, 0.1
0., 0., 1.
*BOUNDARY
rim_lines, 1, 6
*STEP
*STATIC
*DLOAD
left, P, 1000.
jibung_all, P, 10.
*NODE PRINT, NSET=corners
U
*END STEP
"""


def calculix(folder):
    """Solves job.inp of a folder; displacements by node."""
    if shutil.which("ccx") is None:
        raise RuntimeError("CalculiX (ccx) is not installed")
    done = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode != 0 or "*ERROR" in done.stdout:
        raise AssertionError(f"CalculiX ends with {done.returncode}: {done.stdout[-600:]}")
    return displacements(os.path.join(folder, "job.dat"))


def takes_every_set(deck, work):
    """The sheet of `cargo test decks_for_other_programs`, with shells, beams and all its sets in use: two corners held, two moved."""
    folder = os.path.join(work, "solve_" + os.path.basename(deck).replace(".", "_"))
    os.makedirs(folder, exist_ok=True)
    shutil.copy(deck, os.path.join(folder, "sheet.inp"))
    with open(os.path.join(folder, "job.inp"), "w", encoding="ascii") as file:
        file.write(SHEET.replace("{deck}", "sheet.inp"))
    moved = [max(map(abs, u)) > 1e-9 for _, u in sorted(calculix(folder).items())]
    if moved != [False, False, True, True]:
        raise AssertionError(f"corners that move: {moved}")


def node_set(deck, name):
    """Nodes of a set of a deck."""
    nodes, inside = set(), False
    with open(deck, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                inside = line.strip().upper() == f"*NSET, NSET={name}".upper()
            elif inside:
                nodes.update(int(word) for word in line.split(","))
    return nodes


def element_sets(deck):
    """Sets that the element cards of a deck fill, one per surface."""
    with open(deck, encoding="utf-8") as file:
        cards = [line.strip() for line in file if line.startswith("*ELEMENT")]
    return sorted({card.rsplit("ELSET=", 1)[1] for card in cards if "ELSET=" in card})


def displacements(path):
    """Displacement (x, y, z) by node, from what CalculiX prints."""
    found = {}
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if len(words) == 4 and words[0].isdigit():
                found[int(words[0])] = tuple(float(word) for word in words[1:])
    return found


class Case:
    def __init__(self, name, model, settings, deck, wrapper, wanted):
        self.name, self.model, self.settings = name, os.path.join(ROOT, model), settings
        self.deck, self.wrapper, self.wanted = deck, wrapper, wanted

    def run(self, run_loft, work):
        folder = os.path.join(work, "solve_" + self.name.replace(" ", "_"))
        run_loft(self.model, folder, *self.settings)
        deck = os.path.join(folder, self.deck)
        text = self.wrapper
        if "{anchor}" in text:
            # One node that keeps the roof from sliding along its axis, where nothing pulls.
            text = text.replace("{anchor}", str(min(node_set(deck, "crown") & node_set(deck, "diaphragms"))))
            surfaces = element_sets(deck)
            text = text.replace("{sections}", "\n".join(f"*SHELL SECTION, ELSET={name}, MATERIAL=concrete\n0.25" for name in surfaces))
            text = text.replace("{weights}", "\n".join(f"{name}, GRAV, 1., 0., 0., -1." for name in surfaces))
        with open(os.path.join(folder, "job.inp"), "w", encoding="ascii") as file:
            file.write(text.replace("{deck}", self.deck))
        sunk = max(-z for _, _, z in calculix(folder).values())
        if not abs(sunk - self.wanted) <= SHARE * self.wanted:
            raise AssertionError(f"sinks by {sunk:.6g}, expected {self.wanted:.6g}")


STIFFNESS = 2.1e11 * 0.01**3 / (12 * (1 - 0.3**2))
NAVIER = 0.00406235 * 1000.0 / STIFFNESS

PLATES = "tests/interop/models/plate.loft"
CASES = [
    Case("plate of 8-node quads", PLATES, ["--set", "kind=quads"], "plate_quads.inp", PLATE, NAVIER),
    Case("plate of 6-node triangles", PLATES, ["--set", "kind=triangles"], "plate_triangles.inp", PLATE, NAVIER),
    Case("roof under its own weight", "examples/barrel_vault.loft", [], "barrel_vault.inp", ROOF, 0.3024),
]
