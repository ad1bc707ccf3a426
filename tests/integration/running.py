"""How the tests run programs: on several ranks, with the exit code that is due, and for their summary."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path


def start(*command, mpirun=None, ranks=1, **options):
    """What a program leaves, however it ends; without `mpirun` or on one rank, it is not asked."""
    launcher = [mpirun, "--oversubscribe", "-n", ranks] if ranks > 1 else []
    words = [str(word) for word in (*launcher, *command)]
    return subprocess.run(words, capture_output=True, text=True, check=False, **{"timeout": 300, **options})


def run(*command, code=0, **options):
    """What it prints, errors last; ends the test where the program does not end with `code`."""
    done = start(*command, **options)
    if done.returncode != code:
        line = " ".join(map(str, command))
        sys.exit(f"FAILED: ends with {done.returncode} instead of {code}: {line}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def summary(*command, **options):
    """What `--json` writes of a run that succeeds."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "summary.json"
        run(*command, "--json", file, **options)
        return json.loads(file.read_text())


def changed(text, *changes):
    """A scene with (old, new) put in, each old text once there."""
    for old, new in changes:
        assert text.count(old) == 1, f"{old!r} must stand once in the scene"
        text = text.replace(old, new)
    return text


def told(problems):
    """Prints them; the exit code of the test."""
    for problem in problems:
        print("FAILED:", problem)
    return 1 if problems else 0
