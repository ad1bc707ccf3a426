"""No mode is missing where nothing says so: tolerances with held masters, counts on several ranks, limits of rounding.

Usage: completeness.py PROGRAM_DIR MPIRUN
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import changed, run, start

SCENE = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
STRIP = (Path(__file__).parents[1] / "data/strip.toml").read_text()

MESH = SCENE[SCENE.index("[mesh]") : SCENE.index("[material.iron]")]
COUPLING = SCENE[SCENE.index("[[coupling]]") : SCENE.index("[interface]")]

BLADES = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.02, 0.13};
Rectangle(2) = {0.02, 0, 0, 0.01, 0.01};
Rectangle(3) = {0.03, 0, 0, 0.02, 0.13};
BooleanFragments{ Surface{1, 2, 3}; Delete; }{}
Physical Surface("disc") = Surface{:};
Physical Point("feet") = PointsOf{ Surface{2}; };
Mesh.MeshSizeMax = 0.01;
"""

SQUARE = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.2, 0.2};
Physical Surface("disc") = {1};
Physical Point("feet") = {1, 2, 3, 4};
Mesh.MeshSizeMax = 0.02;
"""


def from_geo(name):
    """A plate of a .geo, whose group `feet` is held and the only interface."""
    return changed(SCENE, (MESH, f'[mesh]\nfile = "{name}"\nelement_order = 2\n\n'), (COUPLING, ""),
                   ('["track", "hub"]', '["feet"]'), ('fixed = ["hub"]', 'fixed = ["feet"]'),
                   ("thickness = 0.02", "thickness = 0.002"))  # fmt: skip


HELD = {
    "a disc at its hub": (changed(SCENE, ('["track", "hub"]', '["hub"]')), 8000.0),
    "a square at its corners": (from_geo("square.geo"), 4000.0),
    "two blades at their roots": (from_geo("blades.geo"), 4000.0),
}


def in_folder(scene, command, *options, mpirun=None, ranks=1):
    """What `chladni COMMAND` printed and the folder's reduced file as dictionary, if there is one."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(scene)
        (folder / "blades.geo").write_text(BLADES)
        (folder / "square.geo").write_text(SQUARE)
        done = start(*command, folder / "scene.toml", "--output", folder, *options, mpirun=mpirun, ranks=ranks,
                     cwd=folder)  # fmt: skip
        if done.returncode != 0:
            sys.exit(f"FAILED: {done.stdout}{done.stderr}")
        file = next(folder.glob("*.reduced.h5"), None)
        found = {}
        if file:
            with h5py.File(file) as reduced:
                reduced["certificate"].visititems(
                    lambda key, item: found.update({key: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return done.stdout, found


def fe_frequencies(chladni, scene, up_to_Hz):
    """Those of the FE model under the scene's support, below a frequency."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "blades.geo").write_text(BLADES)
        (folder / "square.geo").write_text(SQUARE)
        support = "".join(f'[[support]]\ngroup = "{group}"\ntype = "clamped"\n'
                          for group in ("hub", "feet") if f'fixed = ["{group}"]' in scene)  # fmt: skip
        (folder / "scene.toml").write_text(scene + support + "[modes]\ncount = 60\n")
        run(chladni, "modes", folder / "scene.toml", "--output", folder, "--json", folder / "modes.json", cwd=folder)
        found = np.array(json.loads((folder / "modes.json").read_text())["frequencies_Hz"])
    assert found[-1] > up_to_Hz, "count too few modes"
    return found[found < up_to_Hz]


def held_masters(chladni):
    """A tolerance finds all modes of the range where the support holds every master."""
    for name, (scene, up_to_Hz) in HELD.items():
        exact = fe_frequencies(chladni, scene, up_to_Hz)
        by_tolerance = changed(scene, ("modes = 20", f"tolerance = 1e-3\nup_to_Hz = {up_to_Hz}"))
        _, certificate = in_folder(by_tolerance, [chladni, "reduce"])
        found = certificate["frequencies"] / (2 * np.pi)
        found = found[found < up_to_Hz * (1 + 1e-3)][: len(exact)]
        same = len(found) == len(exact) and np.max(np.abs(found / exact - 1)) < 1e-3
        yield f"{name}: {len(found)} modes of the range, the FE model has {len(exact)}", same


def counts(chladni, mpirun):
    """The free disc of the example: a count does not depend on the ranks."""
    fine = changed(SCENE, ("element_size = 0.03", "element_size = 0.008"), ("nodes = 12", "nodes = 60"),
                   ('fixed = ["hub"]', "fixed = []"), ("modes = 20", "modes = 5\nsylvester = true"))  # fmt: skip
    found = []
    for ranks in (1, 2):
        _, certificate = in_folder(fine, [chladni, "reduce"], mpirun=mpirun, ranks=ranks)
        expected, there = certificate["counts/expected"], certificate["counts/found"]
        yield f"{expected} expected, {there} found on {ranks} ranks", bool(np.all(expected >= there))
        found.append(list(expected))
    yield "the same on 1 and 2 ranks", found[0] == found[1]


def rounding(chladni):
    """A steel foil of 1 m x 10 mm x 0.1 mm held at one end: sixteen digits are not enough, and that is said."""
    foil = f"""
[mesh]
file = "foil.geo"
element_order = 2

[material.iron]
young = 2.1e11
poisson = 0.3
density = 7850.0

[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 1e-4

[interface]
nodes = ["end", "tip"]

[reduce]
method = "craig-bampton"
modes = 10
sylvester = true

[body]
fixed = ["end"]
"""
    geo = """
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 0.01, 0}; Point(4) = {0, 0.01, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 201; Transfinite Curve {2, 4} = 3; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("disc") = {1}; Physical Curve("end") = {4}; Physical Curve("tip") = {2};
"""
    frequencies = {}
    for solver in ("supernodal", "mumps"):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.toml").write_text(foil)
            (folder / "foil.geo").write_text(geo)
            run(chladni, "reduce", folder / "scene.toml", "--output", folder, "--",
                "-cms_pc_factor_mat_solver_type", solver, cwd=folder)  # fmt: skip
            printed = run(chladni, "info", next(folder.glob("*.reduced.h5")))
            with h5py.File(next(folder.glob("*.reduced.h5"))) as file:
                frequencies[solver] = file["certificate/frequencies"][0] / (2 * np.pi)
                rounding = file["certificate/rounding"][0] / 2
        print(printed)
    beam = 1.8751040687119611**2 * 1e-4 / (2 * np.pi) * np.sqrt(2.1e11 / 12 / 7850.0)
    difference = abs(frequencies["supernodal"] / frequencies["mumps"] - 1)
    print(frequencies, "beam", beam, "rounding", rounding)
    yield "the limit by rounding is said", "limited by rounding" in printed
    yield f"and two solvers differ by less, {difference:.1e} < {rounding:.1e}", difference < rounding


def main(chladni, mpirun):
    good = True
    for name, holds in (*held_masters(chladni), *counts(chladni, mpirun), *rounding(chladni)):
        good = good and holds
        print(f"{'ok' if holds else 'FAILED':8}{name}", flush=True)
    return good


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]) / "chladni", sys.argv[2]))
