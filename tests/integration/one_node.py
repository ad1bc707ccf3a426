"""Bodies with a single attachment node, and what is refused about the normal of a shell, on one and two ranks.

Usage: one_node.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from math import cos, sin
from pathlib import Path

import h5py

from checked import failed_checks
from running import run, start, summary

N_X, N_Y = 8, 5  # elements of order 1

PLATE = """
name = "plate"
[mesh]
file = "plate.msh"
[material.steel]
young = 2.1e11
poisson = 0.3
density = 7850.0
[[section]]
group = "plate"
type = "shell"
material = "steel"
thickness = {thickness}
"""
REDUCED = """
[interface]
nodes = [{nodes}]
[reduce]
method = "{method}"
modes = 20
[body]
keep = {keep}
"""
MODES = "[modes]\ncount = 12\n"


def mesh(tilt=0.0):
    """A plate of 1 m x 0.6 m, turned about y, its corners "foot" and "far", in Gmsh's format 2.2."""
    node = lambda i, j: 1 + i + (N_X + 1) * j  # noqa: E731
    nodes = [(node(i, j), cos(tilt) * i / N_X, 0.6 * j / N_Y, -sin(tilt) * i / N_X)
             for j in range(N_Y + 1) for i in range(N_X + 1)]  # fmt: skip
    corners = [[15, 2, 2, 1, node(0, 0)], [15, 2, 3, 2, node(N_X, N_Y)]]
    quads = [[3, 2, 1, 1, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]
             for j in range(N_Y) for i in range(N_X)]  # fmt: skip
    elements = [[k + 1, *element] for k, element in enumerate(corners + quads)]
    lines = lambda rows: "\n".join(" ".join(map(str, row)) for row in rows)  # noqa: E731
    return f"""$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "plate"
0 2 "foot"
0 3 "far"
$EndPhysicalNames
$Nodes
{len(nodes)}
{lines(nodes)}
$EndNodes
$Elements
{len(elements)}
{lines(elements)}
$EndElements
"""


class Case:
    def __init__(self, programs, mpirun, folder):
        self.chladni, self.programs, self.mpirun, self.folder = programs / "chladni", programs, mpirun, folder
        (folder / "plate.msh").write_text(mesh())

    def scene(self, text):
        (self.folder / "scene.toml").write_text(text)
        return self.folder / "scene.toml"

    def reduced(self, thickness, method, ranks, nodes='"foot"'):
        """Frequencies of the free body, rad/s."""
        text = PLATE.format(thickness=thickness) + REDUCED.format(nodes=nodes, method=method, keep="{ modes = 16 }")
        scene = self.scene(text)
        run(self.chladni, "run", scene, "--output", self.folder, mpirun=self.mpirun, ranks=ranks)
        with h5py.File(self.folder / "plate.body.h5") as file:
            return file["modes/frequencies"][:]

    def modes(self, thickness, ranks):
        found = summary(self.chladni, "modes", self.scene(PLATE.format(thickness=thickness) + MODES), cwd=self.folder,
                        mpirun=self.mpirun, ranks=ranks)  # fmt: skip
        return found["n_rigid"], found["frequencies_Hz"]

    def refusal(self, command, text):
        done = start(self.chladni, command, self.scene(text), "--output", self.folder)
        return "" if done.returncode == 0 else done.stdout + done.stderr


def wrong_bodies(case):
    """A body on one node has six rigid motions and the frequencies of the FE model, however thin it is."""
    for thickness in (1e-4, 1e-3, 1e-2):
        for ranks in (1, 2):
            n_rigid, exact = case.modes(thickness, ranks)
            if n_rigid != 6:
                yield f"modes: {n_rigid} rigid motions at {thickness} m"
            # Stretching is (length / thickness)^2 stiffer than bending, and rounded as much.
            rounding = max(1e-8, 1e-15 * thickness**-2)
            for method, tolerance in (("craig-bampton", 1e-3), ("rubin", rounding)):
                what = f"{method} at {thickness} m on {ranks} ranks"
                omega = case.reduced(thickness, method, ranks)
                if (omega == 0).sum() != 6:
                    yield f"{what}: {(omega == 0).sum()} rigid motions"
                error = max(abs(omega[i] / (6.283185307179586 * exact[i]) - 1) for i in range(6, 10))
                print(f"{what}: the first four frequencies are within {error:.1e} of the FE model's")
                if not error < tolerance:
                    yield f"{what}: error {error:.1e}"
                yield from failed_checks(case.programs, case.folder)


def wrong_refusals(case):
    plate = PLATE.format(thickness=1e-3)
    both = REDUCED.format(nodes='"foot", "far"', method="craig-bampton", keep="{ modes = 10 }")
    inertia = '[[mass]]\nat = "far"\nmass = 0.1\ninertia = [0.0, 1e-3, 1e-3]\n'
    clamped = '[[support]]\ngroup = "foot"\ntype = "clamped"\n'
    moment = '[[load]]\ntype = "force"\ngroup = "far"\nmoment = [0.0, 0.0, 1.0]\n'
    force = '[[load]]\ntype = "force"\ngroup = "far"\nforce = [0.0, 1.0, 0.0]\n'
    held = '[[support]]\ngroup = "plate"\ndofs = ["x", "y"]\n'
    cases = {
        "inertia in modes": ("modes", plate + inertia + MODES),
        "inertia in run": ("run", plate + inertia + both),
        "support in modes": ("modes", plate + clamped + MODES),
        "support in static": ("static", plate + clamped + force),
        "moment in static": ("static", plate + clamped + held + moment),
        "support of a body": ("run", plate + both + 'fixed = ["foot"]\n'),
        "interface mode": ("run", plate + both + 'interface_modes = [{ kind = "irm", at = "far", dofs = ["z", "rz"] }]\n'),
    }
    for what, (command, text) in cases.items():
        refusal = case.refusal(command, text)
        print(f"{what}: {refusal.strip()}")
        if "rz" not in refusal or "about its normal" not in refusal:
            yield f"{what}: {refusal or 'not refused'}"
    far = plate + both + 'fixed = ["foot", "far.y"]\n'
    if refusal := case.refusal("run", far):
        yield f"a plate that is held: {refusal}"
    (case.folder / "plate.msh").write_text(mesh(tilt=0.035))
    if refusal := case.refusal("run", far):
        yield f"a tilted plate that is held: {refusal}"
    if "about its normal" not in (refusal := case.refusal("run", plate + both + 'fixed = ["foot"]\n')):
        yield f"a tilted plate: {refusal or 'not refused'}"
    (case.folder / "plate.msh").write_text(mesh())
    chosen = REDUCED.format(nodes='"foot", "far"', method="craig-bampton",
                            keep="{ tolerance = 1e-2, up_to_Hz = 5.0 }")  # fmt: skip
    if refusal := case.refusal("run", plate + chosen + 'fixed = ["foot", "far.y"]\n'):
        yield f"default loads of a tolerance: {refusal}"
    with h5py.File(case.folder / "plate.body.h5") as file:
        loads = [name.decode() for name in file["selection/loads"][:]]
    print(f"default loads of a tolerance: {', '.join(loads)}")
    if loads != ["far.x", "far.z", "far.rx", "far.ry"]:
        yield f"default loads of a tolerance: {loads}"


def main(programs, mpirun):
    with tempfile.TemporaryDirectory() as name:
        case = Case(Path(programs), mpirun, Path(name))
        wrong = [*wrong_bodies(case), *wrong_refusals(case)]
    print("\n".join(f"FAILED: {line}" for line in wrong))
    sys.exit(bool(wrong))


main(*sys.argv[1:])
