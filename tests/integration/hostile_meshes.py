"""A mesh file that would act ends in one sentence of `chladni`, on any number of ranks, unless it is trusted.

Usage: hostile_meshes.py PROGRAM_DIR MPIEXEC
"""

import sys
import tempfile
from pathlib import Path

from running import start

SQUARE = """Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Physical Surface("disc") = {1};
"""
ACTION = 'SystemCall "touch trace";\n'
SCENE = """title = "A square"
[mesh]
file = "square.geo"
element_order = 1
[material.iron]
young = 2e11
poisson = 0.3
density = 7800.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "curve_1"
[interface]
nodes = ["hub"]
[reduce]
method = "craig-bampton"
modes = 2
"""


def only_message(done, *words):
    """What is wrong with a refusal."""
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    if done.returncode != 1 or len(lines) != 1 or any(word not in done.stderr for word in words):
        yield f"exit code {done.returncode}, {done.stderr!r} instead of one line with {words}"


def commands(chladni, folder, mpirun):
    (folder / "scene.toml").write_text(SCENE)
    (folder / "hidden.txt").write_text(ACTION)
    (folder / "square.geo").write_text(SQUARE + 'Include "hidden.txt";\n')
    for command, ranks in (("run", 1), ("reduce", 2), ("modes", 1)):
        done = start(chladni, command, "scene.toml", mpirun=mpirun, ranks=ranks, cwd=folder)
        if ranks == 1:
            yield from only_message(done, "square.geo", "start a program", "--trust-mesh")
        elif done.returncode == 0 or "start a program" not in done.stderr:
            yield f"on {ranks} ranks: {done.stderr}"
        if (folder / "trace").exists():
            yield f"`chladni {command}` ran what the mesh says"
    done = start(chladni, "reduce", "scene.toml", "--trust-mesh", cwd=folder)
    if done.returncode or not (folder / "trace").exists():
        yield f"--trust-mesh does not trust: {done.stderr}"


def main(programs, mpirun):
    chladni = Path(programs) / "chladni"
    with tempfile.TemporaryDirectory() as name:
        failures = list(commands(chladni, Path(name), mpirun))
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
