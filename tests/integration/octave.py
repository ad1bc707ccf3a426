"""examples/matlab/receptance.m in Octave: what it makes of the arrays of a body file are its frequencies and the receptance of
`chladni response`. Without Octave the test is skipped.

Usage: octave.py PROGRAM_DIR [OCTAVE]
"""

import csv
import re
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from running import run

ROOT = Path(__file__).resolve().parents[2]
SKIPPED = 77


def problems(programs, octave, folder):
    chladni = programs / "chladni"
    scene = (ROOT / "examples/response/scene.toml").read_text()
    scene = scene.replace('quantity = "accelerance"', 'quantity = "receptance"')
    (folder / "scene.toml").write_text(scene)
    run(chladni, "run", "scene.toml", "--output", "out", cwd=folder)
    with h5py.File(folder / "out/tap.body.h5") as body:
        f_body = body["modes/frequencies"][:] / (2 * np.pi)
        first = body["attachment/node_positions"][0]  # which the script loads and observes
    place = f"near = [{', '.join(map(repr, map(float, first)))}]"
    scene, n = re.subn(r"near = \[0\.13, 0\.0, 0\.0\]", place, scene)
    if n != 2:
        yield "examples/response has other loads and outputs than this test expects"
    (folder / "scene.toml").write_text(scene)
    run(chladni, "response", "scene.toml", "--output", "out", cwd=folder)
    lines = (ROOT / "examples/matlab/receptance.m").read_text().split("python3 -c '")[1].split("'")[0]
    run(sys.executable, "-c", lines.replace("\n%   ", "\n"), cwd=folder)
    told = run(octave, "--norc", "--quiet", ROOT / "examples/matlab/receptance.m", cwd=folder)
    f_told = np.array([float(f) for f in re.findall(r"^mode \d+: *(\S+) Hz", told, re.M)])
    if f_told.size != f_body.size or np.abs(f_told - f_body).max() > 5.1e-4:  # three decimals
        yield f"Octave tells other frequencies: {told}"
    found = np.loadtxt(folder / "receptance.csv", delimiter=",")
    with open(folder / "out/tap.response.csv", newline="") as table:
        expected = np.array(list(csv.reader(table))[1:], dtype=float)[:, :3]
    difference = np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)
    print(f"largest difference of Hz, real and imaginary part, relative: {difference}")
    # Without damping in the body the matrix is diagonal: the same sums, in another order.
    if not (difference < 1e-12).all():
        yield f"receptances differ by {difference}"


def main(programs, octave=None):
    if not octave:
        print("skipped: there is no octave; `apt-get install --no-install-recommends octave` takes 101 MB on Debian 12")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        found = list(problems(Path(programs), octave, Path(folder)))
    print("\n".join(found) or "Octave reads the body, and computes its receptance")
    return len(found) > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
