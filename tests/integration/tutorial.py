"""Runs pages of docs/tutorial/: writes their files, runs their commands in a folder that has the examples. What they print must be what
stands there, but for the digits of numbers; --update writes it into the pages instead. They run examples/solid_disc and vented_disc.

Usage: tutorial.py PROGRAM_DIR [--update] [PAGE...]
"""

import difflib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = ("brake", "solid_disc", "vented_disc")
BLOCK = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```\n(?:\n```text\n.*?^```\n)?", re.M | re.S)
# Times and memory differ from run to run, and a slow machine tells its progress.
VOLATILE = re.compile(r"^(phase |\d+ s: +\d+ % |CPU of the factorisation|.* \d+\.\d{3} +\d+\.\d{3}$|peak memory)")


def shown(text):
    """What people are to see of an output: without times, and long tables cut."""
    lines = [line.rstrip() for line in text.splitlines() if not VOLATILE.match(line)]
    text = re.sub(r"\n{2,}", "\n\n", "\n".join(lines)).strip()
    lines = text.splitlines()
    return "\n".join(lines if len(lines) < 45 else lines[:30] + ["..."] + lines[-12:])


def perform(block, folder, programs):
    """Writes a file or runs commands; what they print."""
    kind, name, text = block
    if kind != "sh":
        (folder / name).write_text(text)
        return None
    environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    run = subprocess.run(["sh", "-ec", text], cwd=folder, env=environment, capture_output=True, text=True)
    if (run.returncode != 0) != (name == "fails"):
        sys.exit(f"FAILED with {run.returncode}:\n{text}\n{run.stdout}{run.stderr}")
    print(f"ok      {text.strip().splitlines()[-1]}", flush=True)
    return shown(run.stdout + run.stderr)


def without_numbers(text):
    """Words and the order of the lines: the last digits differ from machine to machine."""
    numberless = [re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", " ".join(line.split())) for line in text.splitlines()]
    return [re.sub("#+", "#", line) for line in numberless]  # the bars of a histogram too


def performed(text, programs):
    """The text of a page with what its commands print now."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "examples").symlink_to(ROOT / "examples")

        def replaced(match):
            printed = perform(match.groups(), Path(folder), programs)
            head = f"```{match[1]}{' ' + match[2] if match[2] else ''}\n{match[3]}```\n"
            return head if printed is None else f"{head}\n```text\n{printed}\n```\n"

        return BLOCK.sub(replaced, text)


def main(programs, *arguments):
    for name in [word for word in arguments if word != "--update"] or PAGES:
        page = ROOT / f"docs/tutorial/{name}.md"
        text = page.read_text()
        written = performed(text, programs)
        if "--update" in arguments:
            page.write_text(written)
            continue
        changes = list(difflib.unified_diff(without_numbers(text), without_numbers(written), f"{name}.md", "printed", n=0))
        if changes:
            sys.exit("FAILED: the programs print something else; ./dev pages writes it anew\n" + "\n".join(changes))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), *sys.argv[2:])
