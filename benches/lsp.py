#!/usr/bin/env python3
"""python3 benches/lsp.py LOFT: how long an editor waits for `loft lsp`.

A script of 1000 lines: from the start of the program to its first diagnostics, with a mistake and without; then completions
while typing at random places, each after the edit that makes it necessary. Fails when a figure is over its limit.
"""
import json
import os
import random
import statistics
import subprocess
import sys
import time

LINES = 1000
STARTS = 20
COMPLETIONS = 1000
LIMITS = {"first diagnostics": 0.100, "completion": 0.010}


class Server:
    def __init__(self, loft):
        self.child = subprocess.Popen([loft, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.next = 0
        self.ask("initialize", {"capabilities": {}, "processId": None, "rootUri": None})
        self.tell("initialized", {})

    def send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.child.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        self.child.stdin.flush()

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def receive(self):
        length = 0
        while line := self.child.stdout.readline().strip():
            length = int(line.split(b":")[1])
        return json.loads(self.child.stdout.read(length))

    def wait(self, fits):
        while not fits(message := self.receive()):
            pass
        return message

    def ask(self, method, params):
        self.next += 1
        self.send({"id": self.next, "method": method, "params": params})
        return self.wait(lambda message: message.get("id") == self.next)["result"]

    def stop(self):
        self.ask("shutdown", None)
        self.tell("exit", None)
        self.child.wait()


def script(lines):
    """Points, curves, bays with surfaces: what a frame of a hall has."""
    text = ["units m", "param height = 3m in 1m to 9m"]
    bay = 0
    while len(text) < lines - 12:
        text += [f"point a{bay} = ({bay}m, 0, 0)", f"point b{bay} = ({bay}m, 0, height)", f"curve post{bay} = line(a{bay}, b{bay})"]
        if bay > 0:
            text += [
                f"/// Between bay {bay - 1} and {bay}.",
                f"curve sill{bay} = line(a{bay - 1}, a{bay})",
                f"curve eave{bay} = spline([b{bay - 1}, ({bay - 0.5}m, 0, height + 0.2m), b{bay}])",
                f"surface wall{bay} = coons(sill{bay}, post{bay}, eave{bay}, post{bay - 1})",
            ]
        bay += 1
    text += [f'check "bay {k}": area(wall{k}) > 1m2' for k in range(1, 10)]
    text += ["mesh m of wall1, wall2 { size: 250mm }"]
    return "\n".join(text) + "\n"


def first_diagnostics(loft, text):
    start = time.perf_counter()
    server = Server(loft)
    server.tell("textDocument/didOpen", {"textDocument": {"uri": "untitled:bench", "languageId": "loft", "version": 1, "text": text}})
    message = server.wait(lambda message: message.get("method") == "textDocument/publishDiagnostics")
    seconds = time.perf_counter() - start
    with open(f"/proc/{server.child.pid}/stat", encoding="utf-8") as file:
        ticks = file.read().rsplit(")", 1)[1].split()
    work = (int(ticks[11]) + int(ticks[12])) / os.sysconf("SC_CLK_TCK")
    return seconds, work, server, message["params"]["diagnostics"]


def completions(server, text):
    lines, found = text.count("\n"), []
    dice = random.Random(7)
    for k in range(COMPLETIONS):
        line, typed = dice.randrange(2, lines), dice.choice(["wal", "po", "surf", "c", "line(a", "height + p"])
        document = {"uri": "untitled:bench", "version": k + 2}
        place = {"line": line, "character": 0}
        end = {"line": line, "character": len(typed)}
        server.tell("textDocument/didChange", {"textDocument": document, "contentChanges": [{"range": {"start": place, "end": place}, "text": typed}]})
        start = time.perf_counter()
        items = server.ask("textDocument/completion", {"textDocument": {"uri": "untitled:bench"}, "position": end})
        found.append(time.perf_counter() - start)
        assert items, f"nothing completes {typed!r}"
        server.tell("textDocument/didChange", {"textDocument": document, "contentChanges": [{"range": {"start": place, "end": end}, "text": ""}]})
        # A pause now and then lets evaluations begin, which must not be in the way.
        if k % 50 == 0:
            time.sleep(0.3)
    return found


def main():
    loft, text, wrong = sys.argv[1], script(LINES), 0
    broken = text.replace("coons(sill9,", "coons(sil9,")
    figures = {}
    for name, of in [("first diagnostics, sound", text), ("first diagnostics, broken", broken)]:
        seconds, works = [], []
        for _ in range(STARTS):
            one, work, server, said = first_diagnostics(loft, of)
            assert [d["code"] for d in said] == ([] if of is text else ["E201"]), said
            seconds.append(one)
            works.append(work)
            server.stop()
        figures[name] = (statistics.median(seconds), max(seconds))
        print(f"{name}: {statistics.mean(works) * 1000:.0f} ms of work in the mean")
    _, _, server, _ = first_diagnostics(loft, text)
    found = sorted(completions(server, text))
    server.stop()
    figures["completion"] = (statistics.median(found), found[len(found) * 95 // 100])
    print(f"{text.count(chr(10))} lines, {len(text)} bytes")
    for name, (middle, high) in figures.items():
        limit = next(limit for start, limit in LIMITS.items() if name.startswith(start))
        what = "95 %" if name == "completion" else "slowest"
        print(f"{name}: median {middle * 1000:.1f} ms, {what} {high * 1000:.1f} ms, limit {limit * 1000:.0f} ms")
        wrong += high > limit
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
