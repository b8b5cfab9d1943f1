"""A session of `loft repl` as a person has it: driven key by key in a real terminal (tmux), and in one that shows sixels.

    python3 terminal.py LOFT FOLDER

Prints each step that fails with what the screen showed, and "N passed, N failed" at the end; status 1 when one failed.
"""

import os
import pty
import re
import select
import shutil
import subprocess
import sys
import time

# Keys to press, and what the screen must show behind them (a regular expression), or must not (begins with `!`).
# A step that ends in `Enter` is one entry; what it answers stands between it and the next prompt.
STEPS = [
    (["curve south = line((0, 0, 0), (4m, 0, 0))", "Enter"], [r"curve south: line, 4000 mm, 1 link"]),
    # A mistake is shown under the entry, and changes nothing: there is nothing of it to undo.
    (["curve north = lin((0, 3m, 0), (4m, 3m, 0))", "Enter"], [r"E201 × there is no function `lin`", r"did you mean `line`\?"]),
    ([":undo", "Enter"], [r"undid: south added"]),
    ([":redo", "Enter"], [r"redid: south added"]),
    # Tab completes a keyword, a function and a name; the signature stands behind the cursor.
    (["curve north = polyl", "Tab"], [r"curve north = polyline\(", r"polyline\(points"]),
    (["[(0, 3m, 0), (4m, 3m, 0)])", "Enter"], [r"curve north: \w+, 4000 mm, 1 link"]),
    (["surface roof = ruled(sou", "Tab", ", north)", "Enter"], [r"ruled\(south, north\)", r"surface roof: ruled, .*12000000 mm2"]),
    # An open bracket goes on in the next line.
    (["mesh fine of roof {", "Enter", "size: 500mm", "Enter", "}", "Enter"], [r"mesh fine"]),
    ([":mesh fine", "Enter"], [r"mesh fine: 63 nodes, 96 triangles"]),
    # A redefinition takes the old one's place, and what stands on it follows.
    (["curve south = line((0, 0, 0), (4m, 0, 1m))", "Enter"], [r"curve south: line, 4123.11 mm"]),
    (["roof.area > 12m2", "Enter"], [r"^true$"]),
    ([":why roof", "Enter"], [r"roof depends on\n  south\n  north", r"what depends on roof:\n  fine"]),
    ([":remove south", "Enter"], [r"E510 × `south` is used by `roof`", r"help: remove fine, roof first, or `:remove! south` to remove all 3"]),
    ([":remove! south", "Enter"], [r"removed south, roof, fine"]),
    (["roof.area", "Enter"], [r"E201 × `roof` is not defined"]),
    ([":undo", "Enter"], [r"surface roof: ruled"]),
    ([":mesh fine", "Enter"], [r"mesh fine: \d+ nodes"]),
    ([":view", "Enter"], [r"http://127\.0\.0\.1:\d+/[0-9a-f]{32}/"]),
    # The arrow key brings entries of before back.
    (["Up", "Up", "Enter"], [r"mesh fine: \d+ nodes"]),
    ([":save kept.loft", "Enter"], [r"wrote kept\.loft"]),
    ([":reset", "Enter"], [r"no longer there|loft> "]),
    ([":load kept.loft", "Enter"], [r"kept\.loft: 4 names"]),
    ([":mesh fine", "Enter"], [r"mesh fine: \d+ nodes"]),
    # Ctrl-C leaves a line, Ctrl-D the session.
    # An editor that changes the script, one that fails, one that changes nothing, one that empties it, and one that is not there.
    ([("editor", "sed -i s/500mm/250mm/ $1"), ":edit", "Enter"], [r"edited: fine redefined", r"mesh fine"]),
    ([":mesh fine", "Enter"], [r"mesh fine: 252 nodes"]),
    ([("editor", "exit 3"), ":edit", "Enter"], [r"sh failed; nothing was changed"]),
    ([("editor", "true"), ":edit", "Enter"], [r"edited: nothing changed"]),
    ([("editor", ": > $1"), ":edit", "Enter"], [r"edited: .*fine removed", r"roof removed"]),
    ([":undo", "Enter"], [r"undid: .*fine removed"]),
    ([":mesh fine", "Enter"], [r"mesh fine: 252 nodes"]),
    # A terminal without sixels is asked once, and gets no picture.
    ([":render roof", "Enter"], [r"^roof\.png: \d+ × \d+ pixels, \d+ bytes$", "!P0;1;0q"]),
    (["20 + 22", "Enter"], [r"^42$"]),
    (["curve lost = (", "C-c"], [r"^loft>$"]),
    (["1 + 1", "Enter"], [r"^2$"]),
    (["C-d"], [r"session over"]),
]

PROMPT = "loft> "


class Terminal:
    def __init__(self, loft, folder):
        self.socket = ["tmux", "-L", f"loft-{os.getpid()}", "-f", "/dev/null"]
        home = os.path.join(folder, "home")
        os.makedirs(home)
        self.folder = folder
        variables = f"HOME={home} XDG_DATA_HOME={home} TERM=screen VISUAL= EDITOR='sh editor'"
        command = f"cd {folder} && env {variables} {loft} repl; echo session over; sleep 60"
        size = ["-x", "110", "-y", "2000"]
        subprocess.run([*self.socket, "new-session", "-d", *size, "-s", "s", "sh", "-c", command], check=True)

    def screen(self):
        shown = subprocess.run([*self.socket, "capture-pane", "-p", "-t", "s"], check=True, capture_output=True, text=True)
        return "\n".join(line.rstrip() for line in shown.stdout.rstrip().split("\n"))

    def press(self, key):
        if isinstance(key, tuple):
            name, text = key
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                file.write(text + "\n")
            return
        # What is no name of a key is typed as it is.
        literal = [] if re.fullmatch(r"Enter|Tab|Up|C-\w", key) else ["-l"]
        subprocess.run([*self.socket, "send-keys", "-t", "s", *literal, "--", key], check=True)

    def settled(self, wanted, seconds=20):
        """The screen when all that is wanted is on it, or when time is over."""
        end = time.monotonic() + seconds
        while True:
            text = self.screen()
            if all(is_met(w, text) for w in wanted) or time.monotonic() > end:
                return text
            time.sleep(0.05)

    def close(self):
        subprocess.run([*self.socket, "kill-server"], check=False)


def is_met(wanted, text):
    if wanted.startswith("!"):
        return re.search(wanted[1:], text, re.M) is None
    return re.search(wanted, text, re.M) is not None


def decoded(text):
    """Width and height of sixels, and how many of the pixels are set."""
    body = text[text.index('"') + 1 :]
    width, height = (int(n) for n in re.match(r"1;1;(\d+);(\d+)", body).groups())
    body = body[body.index("#") :]
    columns = count = row = 0
    for token in re.finditer(r"#[\d;]+|!(\d+)([?-~])|([?-~])|\$|-", body):
        if token[0] == "-":
            row += 6
        if token[0] in "$-":
            columns = 0
        if token[0][0] in "#$-":
            continue
        times, sign = (int(token[1]), token[2]) if token[1] else (1, token[3])
        columns += times
        count += times * bin(ord(sign) - 63).count("1")
        if columns > width or row >= height:
            raise ValueError("a pixel beside the picture")
    return width, height, count


def sixel(loft, folder):
    """A terminal with sixels: it is asked, answers behind keys that are typed meanwhile, and gets a picture and the keys' answer."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        for name in ("KITTY_WINDOW_ID", "TERM_PROGRAM", "LOFT_PICTURES", "NO_COLOR"):
            os.environ.pop(name, None)
        os.environ.update(TERM="xterm", HOME=folder, XDG_DATA_HOME=folder)
        os.execv(loft, [loft, "repl"])
    seen = b""

    def until(wanted, seconds=30):
        nonlocal seen
        end = time.monotonic() + seconds
        while wanted not in seen and time.monotonic() < end:
            if select.select([terminal], [], [], 0.1)[0]:
                try:
                    seen += os.read(terminal, 65536)
                except OSError:
                    break
        return wanted in seen

    found = []
    try:
        found.append(until(b"loft> "))
        os.write(terminal, b"curve a = line((0, 0, 0), (4m, 0, 1m))\r")
        found.append(until(b"1 link"))
        os.write(terminal, b":render a\r")
        found.append(until(b"\x1b[c"))
        os.write(terminal, b"123 + 456\r7 *\x1b[?62;4;22c")
        found.append(until(b"\x1b\\"))
        found.append(until(b"579"))
        # What was typed without its end is there to go on with.
        os.write(terminal, b" 111\r")
        found.append(until(b"777"))
        picture = re.search(rb"\x1bP0;1;0q(.*?)\x1b\\", seen, re.S)
        width, height, count = decoded(picture[1].decode()) if picture else (0, 0, 1)
        found.append(width > 100 and width * height == count)
        os.write(terminal, b":render a\r")
        asked = seen.count(b"\x1b[c")
        seen = b""
        found.append(until(b"\x1b\\") and asked == 1 and b"\x1b[c" not in seen)
    finally:
        os.close(terminal)
        os.waitpid(pid, 0)
    if not all(found):
        print(f"terminal: sixels {found}\n{seen[-2000:]!r}", file=sys.stderr)
    return found


def main():
    loft, folder = os.path.abspath(sys.argv[1]), os.path.abspath(os.path.join(sys.argv[2], "terminal"))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    terminal = Terminal(loft, folder)
    passed = failed = 0
    try:
        before = terminal.settled([f"^{PROMPT.strip()}$"])
        for keys, wanted in STEPS:
            for key in keys:
                terminal.press(key)
            seen = ""
            end = time.monotonic() + 20
            while time.monotonic() < end:
                text = terminal.screen()
                # Only what this step put on the screen counts.
                seen = text[len(os.path.commonprefix([before, text])) :]
                line = before.rsplit("\n", 1)[-1]
                done = keys[-1] != "Enter" or text.rsplit("\n", 1)[-1] == PROMPT.strip()
                if done and all(is_met(w, line + seen) for w in wanted):
                    break
                time.sleep(0.05)
            else:
                failed += 1
                print(f"terminal: {' '.join(map(str, keys))}\n  wanted {wanted}\n  the screen shows\n{seen}", file=sys.stderr)
                before = terminal.screen()
                continue
            passed += 1
            before = text
    finally:
        terminal.close()
    found = sixel(loft, folder)
    passed, failed = passed + found.count(True), failed + found.count(False)
    print(f"terminal: {passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
