"""A user's mistake ends with exit code 1 (2: wrong usage), one message that names it, and no file.

Usage: bad_input.py PROGRAM_DIR
"""

import subprocess
import sys
import tempfile
from pathlib import Path

GOOD = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()


def changed(old, new):
    """The good scene with one mistake in it."""
    assert GOOD.count(old) == 1, f"{old!r} must stand once in the good scene"
    return GOOD.replace(old, new)


ANNULUS = GOOD[GOOD.index('generator = "annulus"') : GOOD.index("[material.iron]")]
MESH_FILE = 'file = "no_such.msh"\nrings = [{ name = "track", radius = 0.13, nodes = 12 }]\n\n'

# program and what it gets: (mistake, scene text or None for no file, exit code, words of the message)
SCENES = [
    ("missing scene file", None, 1, ["scene.toml"]),
    ("not TOML", "title = = 1\n", 1, ["scene.toml"]),
    ("missing mesh file", changed(ANNULUS, MESH_FILE), 1, ["no_such.msh"]),
    ("missing mesh group", changed('group = "disc"', 'group = "disk"'), 1, ["disk", "disc"]),
    ("free disc", changed('fixed = ["hub"]', "fixed = []"), 0, []),  # the free body is legal
    ("loose inner edge", changed('nodes = ["track", "hub"]', "nodes = []"), 1, ["interface"]),
    ("mistyped key", changed("thickness = 0.02", "thicknes = 0.02"), 1, ["thicknes", "thickness"]),
    ("wrong type", changed("young = 9.15915e10", 'young = "soft"'), 1, ["young"]),
    ("value without sense", changed("poisson = 0.3", "poisson = 0.6"), 1, ["poisson", "0.6"]),
    ("negative thickness", changed("thickness = 0.02", "thickness = -0.02"), 1, ["thickness"]),
]
USAGES = [
    ("chladni", ["polish"], "polish"),
    ("chladni", ["run", "scene.toml", "--outptu", "out"], "--outptu"),
    ("chladni", ["run"], ""),
    ("squeal", ["run", "scene.toml", "--outptu", "out"], "--outptu"),
]


def complaints(run, output, code, words):
    """What is wrong with the way a program took a mistake."""
    if run.returncode != code:
        yield f"exit code {run.returncode}, expected {code}"
    if code == 0:
        return
    lines = [line for line in run.stderr.splitlines() if line.strip()]
    if not lines:
        yield "nothing on stderr"
    # mpi.h's abort and PETSc's stacks are many lines; a message is one sentence or two and a hint.
    if len(lines) > 4 or "PETSC ERROR" in run.stderr or "MPI_ABORT" in run.stderr:
        yield f"{len(lines)} lines on stderr instead of one message"
    yield from (f"the message does not say '{word}'" for word in words if word not in run.stderr)
    if output.exists() and any(output.iterdir()):
        yield f"left behind: {sorted(path.name for path in output.iterdir())}"


def check(name, command, folder, code, words):
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=100)
    bad = list(complaints(run, folder / "out", code, words))
    print(f"{'FAILED' if bad else 'ok':8}{name}: {'; '.join(bad) or run.stderr.strip()[:200]}")
    return not bad


def main(programs):
    good = True
    for name, scene, code, words in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            if scene is not None:
                (Path(folder) / "scene.toml").write_text(scene)
            command = [programs / "chladni", "run", "scene.toml", "--output", "out"]
            good &= check(name, command, Path(folder), code, words)
    for program, arguments, word in USAGES:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.toml").write_text(GOOD)
            command = [programs / program, *arguments]
            good &= check(f"usage {' '.join(arguments)}", command, Path(folder), 2, [word])
    return good


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1])))
