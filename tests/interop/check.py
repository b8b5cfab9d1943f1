"""python check.py LOFT WORK DECKS: runs everything, two parts at a time, and prints "N passed, N failed".

LOFT is the program, WORK a scratch folder, DECKS a folder of files from `cargo test decks_for_other_programs`, each family with its
facts in a JSON file.
"""
import concurrent.futures
import contextlib
import glob
import json
import math
import multiprocessing
import os
import shutil
import subprocess
import sys
import time
import traceback

import jsonschema
from OCP.Message import Message

import assembly_out
import cad_again
import cad_in
import cad_mesh
import members
import orders
import profiles
import read_back
import rounded
import solve
import step_out
import surfaces

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


class Tally:
    """Counts what holds and says what does not."""

    def __init__(self):
        self.passed = 0
        self.wrong = []

    def check(self, label, work):
        try:
            work()
            self.passed += 1
        except Exception as error:  # noqa: BLE001 - anything a foreign reader throws is a failed check
            self.wrong.append(label)
            where = traceback.extract_tb(error.__traceback__)[-1]
            print(f"FAILED {label}: {type(error).__name__} {error} ({os.path.basename(where.filename)}:{where.lineno})")

    def table(self, wrong, n):
        """Counts the rows of a table."""
        self.passed += n - len(wrong)
        self.wrong += wrong


def run_loft(loft, model, folder, *settings):
    """Runs a model into a folder of its own; the JSON report."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    done = subprocess.run([loft, "run", model, "-o", folder, "--json", *settings], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"loft run {model} ended with {done.returncode}: {done.stdout[-2000:]} {done.stderr[-2000:]}")
    return json.loads(done.stdout)


def facts_of(report):
    """What the report says of its only mesh, in the words of read_back."""
    mesh = report["meshes"][0]
    return {
        "nodes": mesh["nodes"],
        "triangles": mesh["triangles"],
        "quads": mesh["quads"],
        "lines": None,
        "order": mesh["order"],
        "area": mesh["area"],
        "groups": {group["name"]: {"nodes": group["nodes"], "elements": group["elements"]} for group in mesh["groups"]},
        "surfaces": [surface["name"] for surface in report["surfaces"]],
        "metre": {"mm": 1000.0, "cm": 100.0, "m": 1.0}[report["units"]],
    }


def check_model(tally, loft, work, elements, order):
    """The model that writes every format, with these elements."""
    label = f"every_format {elements} {order}"
    folder = os.path.join(work, label.replace(" ", "_"))
    report = {}
    settings = ["--set", f"kind={elements}", "--set", f"degree={order}"]
    tally.check(f"{label}: run", lambda: report.update(run_loft(loft, os.path.join(HERE, "models", "every_format.loft"), folder, *settings)))
    if not report:
        return
    facts = facts_of(report)
    written = sorted(os.listdir(folder))
    tally.check(f"{label}: files", lambda: read_back.expect("files", len(written), 12))
    for name in written:
        for reader_label, reader in read_back.readers(os.path.join(folder, name), facts):
            tally.check(f"{label} {name} by {reader_label}", reader)


# The box of `bodies.loft`, and the volumes of its shells, cubic centimetres.
BODIES = {
    "box": [[-2.0, -3.0, -3.0], [13.0, 3.0, 6.0]],
    "bodies": {"can": 20.0 * math.pi, "globe": 4.0 / 3.0 * math.pi * (27.0 - 1.0)},
}


def check_bodies(tally, loft, work, elements, order):
    """The model of closed bodies in the formats of pictures and printers."""
    label = f"bodies {elements} {order}"
    folder = os.path.join(work, label.replace(" ", "_"))
    report = {}
    settings = ["--set", f"kind={elements}", "--set", f"degree={order}"]
    tally.check(f"{label}: run", lambda: report.update(run_loft(loft, os.path.join(HERE, "models", "bodies.loft"), folder, *settings)))
    if not report:
        return
    for name in ["bodies_binary.3mf", "bodies_binary.glb"]:
        for reader_label, reader in read_back.readers(os.path.join(folder, name), {**facts_of(report), **BODIES}):
            tally.check(f"{label} {name} by {reader_label}", reader)


def check_orders(tally, loft, work, elements, order):
    """The model whose elements bend: lengths and areas by the shape functions of other programs."""
    label = f"curved {elements} {order}"
    folder = os.path.join(work, label.replace(" ", "_"))
    settings = ["--set", f"kind={elements}", "--set", f"degree={order}"]
    report = {}
    tally.check(f"{label}: run", lambda: report.update(run_loft(loft, os.path.join(HERE, "models", "curved.loft"), folder, *settings)))
    if not report:
        return
    # The foot is meshed with as many steps as the wall has columns.
    rows = next(group for group in report["meshes"][0]["groups"] if group["name"] == "wall")
    cells = rows["elements"] if elements == "quads" else rows["elements"] // 2
    steps = round(cells / round(1 / 0.2))
    for name, check in orders.checks(folder, int(order), steps):
        tally.check(f"{label} {name}", check)


def check_reports(tally, loft, root):
    """The report of every example against the schema, by a program that knows all of JSON Schema."""
    with open(os.path.join(root, "docs", "report.schema.json"), encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    models = sorted(glob.glob(os.path.join(root, "examples", "*.loft")))
    for model in models:
        done = subprocess.run([loft, "check", model, "--json"], capture_output=True, text=True)
        tally.check(f"report of {os.path.basename(model)}", lambda: jsonschema.validate(json.loads(done.stdout), schema))
    done = subprocess.run([loft, "check", *models[:2], "--json"], capture_output=True, text=True)
    tally.check("report of two models", lambda: jsonschema.validate(json.loads(done.stdout), schema))


def check_decks(tally, work, decks):
    """The files of `cargo test decks_for_other_programs` by every program that reads them."""
    for path in sorted(glob.glob(os.path.join(decks, "*.json"))):
        with open(path, encoding="utf-8") as file:
            facts = json.load(file)
        for deck in sorted(glob.glob(path[: -len(".json")] + "_*.*")):
            for label, reader in read_back.readers(deck, facts):
                tally.check(f"{os.path.basename(deck)} by {label}", reader)
            if deck.endswith(".inp"):
                tally.check(f"{os.path.basename(deck)} by CalculiX", lambda deck=deck: solve.takes_every_set(deck, work))


def files_and_solvers(tally, loft, work, decks):
    """Decks and formats by their readers, CalculiX against theory, reports against their schema."""
    check_decks(tally, work, decks)
    for elements in ["triangles", "quads"]:
        for order in ["1", "2"]:
            check_model(tally, loft, work, elements, order)
            check_orders(tally, loft, work, elements, order)
            check_bodies(tally, loft, work, elements, order)
    for case in solve.CASES + members.CASES:
        tally.check(f"CalculiX: {case.name}", lambda: case.run(lambda *a: run_loft(loft, *a), work))
    check_reports(tally, loft, ROOT)


def measured_surfaces(tally, loft, work, _decks):
    """Surfaces, roundings and walls by OpenCASCADE."""
    for model in sorted(glob.glob(os.path.join(HERE, "models", "surfaces", "*.loft"))):
        label = f"{os.path.basename(model)} by OpenCASCADE"
        tally.check(label, lambda model=model: surfaces.check(lambda *a: run_loft(loft, *a), model, work))
    for seed in profiles.SEEDS:
        tally.check(f"profile {seed} by OpenCASCADE", lambda seed=seed: profiles.check(loft, work, seed))
    tally.check("roundings and walls by OpenCASCADE", lambda: rounded.check(lambda *a: run_loft(loft, *a), work))


# Parts of the whole that run beside each other, the longest first: a table of rows or a function of a tally.
PARTS = [cad_mesh, cad_in, step_out, cad_again, files_and_solvers, measured_surfaces, assembly_out]


def run_part(k, loft, work, decks):
    """One of `PARTS` in a process of its own: labels of what is wrong, how much holds, and the file with all that was printed."""
    part, tally = PARTS[k], Tally()
    name = part.__name__
    log = os.path.join(work, f"{name}.log")
    began = time.monotonic()
    Message.DefaultMessenger_s().ChangePrinters().Clear()
    with open(log, "w", encoding="utf-8") as file, contextlib.redirect_stdout(file):
        if callable(part):
            part(tally, loft, work, decks)
        else:
            tally.table(*part.table(loft, os.path.join(work, name)))
        print(f"{name}: {time.monotonic() - began:.0f} s")
    return tally.wrong, tally.passed, log


def main():
    loft, work, decks = (os.path.abspath(path) for path in sys.argv[1:4])
    wrong, passed = [], 0
    # A new process for every part: kernels keep settings of their own.
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context, max_tasks_per_child=1) as pool:
        for found in [pool.submit(run_part, k, loft, work, decks) for k in range(len(PARTS))]:
            labels, holds, log = found.result()
            wrong += labels
            passed += holds
            with open(log, encoding="utf-8") as file:
                print(file.read(), end="", flush=True)
    print("".join(f"FAILED {label}\n" for label in wrong), end="")
    print(f"{passed} passed, {len(wrong)} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
