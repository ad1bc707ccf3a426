"""An accuracy on a geometry with a corner that points inward: elements are smaller where the error is.

A clamped L of a .geo. The reference has elements that shrink towards the corner by the .geo's own
sizes. Meshes of one element size that keep the same error have more DOFs.

Usage: local_sizes.py PROGRAM_DIR
"""

import json
import re
import sys
import tempfile
from pathlib import Path

from running import run

UP_TO_HZ = 2500.0
COUNT = 12
ERROR = 5e-4
GEO = """
DefineConstant[ size = 0.05, corner = 0.05 ];
Point(1) = {0, 0, 0, size}; Point(2) = {0.3, 0, 0, size}; Point(3) = {0.3, 0.12, 0, size};
Point(4) = {0.12, 0.12, 0, corner}; Point(5) = {0.12, 0.3, 0, size}; Point(6) = {0, 0.3, 0, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
Physical Surface("plate") = {1};
Physical Curve("edge") = {2};
"""
SCENE = """
{accuracy}
[mesh]
file = "l.geo"
{mesh}
[material.iron]
young = 1.1e11
poisson = 0.3
density = 7100.0
[[section]]
group = "plate"
type = "shell"
material = "iron"
thickness = 0.012
[[support]]
group = "edge"
type = "clamped"
[modes]
count = {count}
"""


def modes(programs, folder, mesh="", accuracy=""):
    """The summary, and what is printed."""
    (folder / "scene.toml").write_text(SCENE.format(accuracy=accuracy, mesh=mesh, count=COUNT))
    said = run(programs / "chladni", "modes", folder / "scene.toml", "--output", folder, "--json", folder / "found.json")
    return json.loads((folder / "found.json").read_text()), said


def error_of(found, exact):
    return max(abs(f / e - 1) for f, e in zip(found["frequencies_Hz"], exact) if e < UP_TO_HZ)


def uniform(programs, folder, exact, order):
    """DOFs of the first mesh of one size that keeps the error."""
    size = 0.05
    while True:
        found, _ = modes(programs, folder, f"element_order = {order}\nparameters = {{ size = {size}, corner = {size} }}")
        error = error_of(found, exact)
        print(f"order {order}, elements of {size:.4f} m: error {error:.1e}, {found['n_dofs']} DOFs", flush=True)
        if error <= ERROR:
            return found["n_dofs"]
        size *= 0.75


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "l.geo").write_text(GEO)
        exact = modes(programs, folder, "element_order = 3\nparameters = { size = 0.02, corner = 2e-4 }")[0]["frequencies_Hz"]
        print(f"{sum(e < UP_TO_HZ for e in exact)} modes in the range")
        found, said = modes(programs, folder, accuracy=f"accuracy = {{ error = {ERROR}, up_to_Hz = {UP_TO_HZ} }}")
        error = error_of(found, exact)
        note = re.search(r"accuracy .*", said)
        print(f"chosen: error {error:.1e}, {found['n_dofs']} DOFs: {note and note[0]}")
        least = min(uniform(programs, folder, exact, order) for order in (2, 3))
        print(f"{found['n_dofs'] / least:.2f} of the DOFs that elements of one size need")
        good = error <= ERROR and note and "where the error is" in note[0] and found["n_dofs"] < 0.7 * least
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
