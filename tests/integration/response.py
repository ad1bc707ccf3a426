"""`chladni response`: closed forms, the FE model beside the reduced system and the body, ranks, files, mistakes.

Usage: response.py PROGRAM_DIR MPIRUN [CHROMIUM]
"""

import csv
import json
import re
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from report import browse
from running import changed, run, start

TWO_PI = 2 * np.pi

# Length, bending stiffness and mass per length are 1.
BEAM = """
name = "beam"
[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [1.0, 0.0, 0.0]
elements = 40
points = [{ name = "A", distance = 0.0 }, { name = "B", distance = 0.4 }, { name = "C", distance = 1.0 }]
[model]
dofs = ["z", "ry"]
[material.unit]
young = 1.0
poisson = 0.0
density = 1.0
[[section]]
group = "beam"
type = "beam"
theory = "bernoulli-euler"
rotary_inertia = "none"
orientation = [0.0, 0.0, 1.0]
material = "unit"
area = 1.0
I_y = 1.0
I_z = 1.0
J = 1.0
[interface]
nodes = ["A", "B", "C"]
[reduce]
method = "craig-bampton"
modes = 70
resultants = ["beam"]
[body]
fixed = ["A"]
"""
SOLID_BEAM = """
name = "solid"
[mesh]
generator = "rectangle"
length = 1.0
width = 0.1
element_order = 2
element_size = 0.05
extrude = { from = -0.05, to = 0.05, layers = 2 }
[material.unit]
young = 1e6
poisson = 0.3
density = 1.0
[[section]]
group = "plate"
type = "solid"
material = "unit"
[[coupling]]
name = "A"
group = "left"
type = "rigid"
[[coupling]]
name = "C"
group = "right"
type = "averaging"
[interface]
nodes = ["A", "C"]
[reduce]
method = "craig-bampton"
modes = 6
resultants = ["plate"]
[body]
fixed = ["A"]
[response]
of = "reduced"
loads = [{ at = "C", dofs = ["x", "z"] }]
outputs = [{ at = "C", dofs = ["z"] }]
from_Hz = 0.0
to_Hz = 0.1
count = 2
section_forces = ["plate"]
"""
RESPONSE = """
[response]
of = "body"
loads = [{ at = "C", dofs = ["z"] }, { at = "B", dofs = ["ry"] }]
outputs = [{ at = "C", dofs = ["z", "ry"] }, { at = "B", dofs = ["z", "ry"] }]
from_Hz = 0.0
to_Hz = 12.0
count = 61
loss_factor = 0.02
"""
DISC = """
name = "disc"
[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = 2
element_size = 0.03
rings = [{ name = "track", radius = 0.13, nodes = 12 }]
[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[[spring]]
at = "track"
damping = { z = 30.0 }
[interface]
nodes = ["track", "hub"]
[reduce]
method = "craig-bampton"
modes = 60
[body]
fixed = ["hub"]
[response]
of = "body"
quantity = "accelerance"
loads = [{ at = "track", dofs = ["z"], near = [0.13, 0.0, 0.0] }, { at = "track", dofs = ["z"] }]
outputs = [{ at = "track", dofs = ["z", "rx"] }]
from_Hz = 100.0
to_Hz = 2500.0
count = 12
spacing = "logarithmic"
"""


class Checks:
    def __init__(self):
        self.good = True

    def below(self, name, value, limit):
        self.holds(f"{name}: {value:.1e}, allowed {limit:.0e}", value < limit)

    def holds(self, name, holds):
        print(f"{'ok' if holds else 'FAILED':8}{name}")
        self.good &= bool(holds)


def difference(a, b):
    """Of the columns, each over its largest value."""
    return float((np.abs(a - b).max(axis=0) / np.abs(b).max(axis=0)).max())


def responses(file):
    """Frequencies, names of loads and outputs, H of each load."""
    with h5py.File(file) as f:
        loads, outputs = (list(f[f"{kind}/names"].asstr()[:]) for kind in ("loads", "outputs"))
        H = [f[f"responses/{load}/H_re"][:] + 1j * f[f"responses/{load}/H_im"][:] for load in loads]
        return f["frequencies"][:], loads, outputs, H


class Case:
    """A scene in a folder of its own."""

    def __init__(self, program, mpirun, folder, scene, name):
        self.program, self.mpirun, self.name = program / "chladni", mpirun, name
        self.folder = Path(folder) / name
        self.folder.mkdir()
        self.scene = scene

    def write(self, *changes):
        (self.folder / "scene.toml").write_text(changed(self.scene, *changes))

    def call(self, command, ranks=1, output="out"):
        words = (self.program, command, "scene.toml", "--output", output)
        return run(*words, mpirun=self.mpirun, ranks=ranks, cwd=self.folder)

    def made(self, *changes):
        self.write(*changes)
        self.call("run")
        return self

    def responses(self, *changes, ranks=1, output="out", outputs=None):
        self.write(*changes)
        if outputs:
            file = self.folder / "scene.toml"
            file.write_text(re.sub(r"outputs = .*", f"outputs = {outputs}", file.read_text()))
        self.call("response", ranks, output)
        return responses(self.folder / output / f"{self.name}.response.h5")


def of(model):
    return ('of = "body"', f'of = "{model}"')


def exact_tip(Omega, eta):
    """Tip displacement for a tip force of a cantilever of stiffness 1 + i eta."""
    EI = 1 + 1j * eta
    b = (np.maximum(Omega, 1e-3) ** 2 / EI) ** 0.25  # 0 rad/s by its limit
    return (np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)) / (EI * b**3 * (1 + np.cos(b) * np.cosh(b)))


def check_beam(program, mpirun, folder, checks):
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    Omega, loads, outputs, body = beam.responses()
    checks.holds(f"loads {loads}, outputs {outputs}",
                 loads == ["C.z", "B.ry"] and outputs == ["C.z", "C.ry", "B.z", "B.ry"])  # fmt: skip
    exact = exact_tip(Omega, 0.02)
    # Cubic elements: the third frequency, 61.7, is off by its fourth power of the element over 720 and more.
    checks.below("body beside the exact cantilever", difference(body[0][:, :1], exact[:, None]), 1e-4)
    reduced = beam.responses(of("reduced"))[3]
    fe = beam.responses(of("fe"))[3]
    two = beam.responses(of("fe"), ranks=2)[3]
    for load, *H in zip(loads, body, reduced, fe, two):
        checks.below(f"{load}: body beside the reduced system", difference(H[0], H[1]), 1e-9)
        checks.below(f"{load}: reduced system beside the FE model", difference(H[1], H[2]), 1e-5)
        checks.below(f"{load}: the FE model on two ranks", difference(H[3], H[2]), 1e-9)
    checks.below("reciprocity in the FE model", difference(fe[0][:, 3:], fe[1][:, :1]), 1e-9)


def check_damping(program, mpirun, folder, checks):
    """Each way to damp, in the body and in the FE model; without any the response is real."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam")
    for name, damping in {
        "no damping": "",
        "Rayleigh's damping": 'damping = { type = "rayleigh", alpha = 0.3, beta = 1e-4 }\n',
        "a damper": "",
    }.items():
        damper = '[[spring]]\nat = "B"\ndamping = { z = 0.5 }\n[interface]' if name == "a damper" else "[interface]"
        changes = (('fixed = ["A"]\n', 'fixed = ["A"]\n' + damping), ("[interface]", damper), ("loss_factor = 0.02\n", ""))
        beam.made(*changes)
        body = beam.responses(*changes)[3][0]
        for ranks in (1, 2):
            fe = beam.responses(*changes, of("fe"), ranks=ranks)[3][0]
            checks.below(f"{name}: body beside the FE model on {ranks} rank(s)", difference(body, fe), 2e-5)
        checks.holds(f"{name}: is the response real?", (np.abs(fe.imag).max() == 0) == (name == "no damping"))


def check_loss_factors(program, mpirun, folder, checks):
    """A loss factor of the material is one of the response: K (1 + i eta), not the viscous equivalent that squeal takes."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    of_response = {model: beam.responses(of(model))[3][0] for model in ("body", "reduced", "fe")}
    changes = (("density = 1.0", "density = 1.0\nloss_factor = 0.02"), ("count = 61\nloss_factor = 0.02", "count = 61"))
    beam.made(*changes)
    for model, expected in of_response.items():
        for ranks in (1, 2) if model == "fe" else (1,):
            found = beam.responses(*changes, of(model), ranks=ranks)[3][0]
            checks.below(f"loss factor of the material in {model} on {ranks} rank(s)", difference(found, expected), 1e-9)


def check_quantities(program, mpirun, folder, checks):
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    for model in ("body", "fe"):
        Omega, _, _, u = beam.responses(of(model))
        for quantity, rate in {"mobility": 1j * Omega, "accelerance": -(Omega**2)}.items():
            found = beam.responses(of(model), ("count = 61", f'count = 61\nquantity = "{quantity}"'))[3]
            checks.below(f"{quantity} of {model}", difference(found[0], rate[:, None] * u[0]), 1e-14)


def check_section_forces(program, mpirun, folder, checks):
    """At rest a tip force L = 1 away bends the clamped end with moment 1, and shears each section with force 1."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    for model in ("body", "reduced"):
        beam.responses(of(model), ("loss_factor = 0.02", 'loss_factor = 0.02\nsection_forces = ["beam"]'))
        with h5py.File(beam.folder / "out/beam.response.h5") as f:
            group = f["section_forces/beam"]
            kinds, x = list(group["kinds"].asstr()[:]), group["positions"][:, 0]
            r = group["responses/C.z/r_re"][0].reshape(len(x), len(kinds))
        moment, shear = (np.abs(r[:, kinds.index(kind)]) for kind in ("M_y", "Q_z"))
        checks.below(f"{model}: static moments", np.abs(moment - (1 - x)).max(), 1e-6)
        checks.below(f"{model}: static shear forces", np.abs(shear - 1).max(), 1e-6)


def check_stresses(program, mpirun, folder, checks):
    """A force of 1 N at the end of a bar of solids: sigma_x = F / A, or M z / I beside the shear force, far from the ends."""
    bar = Case(program, mpirun, folder, SOLID_BEAM, "solid").made()
    bar.responses()
    with h5py.File(bar.folder / "out/solid.response.h5") as f:
        group = f["section_forces/plate"]
        x, _, z = group["positions"][:].T
        kinds = list(group["kinds"].asstr()[:])
        stresses = {load: group[f"responses/C.{load}/r_re"][0].reshape(len(x), len(kinds)).T for load in "xz"}
    middle = (x > 0.3) & (x < 0.7)
    pulled, bent = (dict(zip(kinds, stresses[load][:, middle])) for load in "xz")
    checks.below("stress of a bar that is pulled", np.abs(pulled["sigma_x"] * 0.01 - 1.0).max(), 1e-4)
    others = [np.abs(pulled[kind]).max() for kind in kinds if kind != "sigma_x"]
    checks.below("other stresses of a bar that is pulled", max(others) * 0.01, 1e-4)
    exact = (1.0 - x[middle]) * z[middle] / (0.1**4 / 12.0)
    checks.below("stress of a bar that is bent", np.abs(bent["sigma_x"] + exact).max() / np.abs(exact).max(), 1e-3)
    checks.below("shear force of its mean", abs(bent["sigma_xz"].mean() * 0.01 - 1.0), 1e-3)


def check_disc(program, mpirun, folder, checks):
    disc = Case(program, mpirun, folder, DISC, "disc").made()
    Omega, loads, outputs, body = disc.responses()
    checks.holds(f"{len(outputs)} outputs, loads {loads}", len(outputs) == 24 and loads[1] == "track.z"
                 and re.fullmatch(r"track\.z \(node \d+\)", loads[0]))  # fmt: skip
    checks.below("frequencies multiply", np.ptp(np.diff(np.log(Omega))), 1e-12)
    fe = disc.responses(of("fe"))[3]
    two = disc.responses(of("fe"), ranks=2)[3]
    for k, load in enumerate(loads):
        names = [i for i, name in enumerate(outputs) if name.startswith("track.z")]
        checks.below(f"{load}: body beside the FE model", difference(body[k][:, names], fe[k][:, names]), 2e-3)
        # K of a plate has a condition of 1e7 and more, and two ranks eliminate in another order.
        checks.below(f"{load}: the FE model on two ranks", difference(two[k], fe[k]), 1e-8)
    z = [i for i, name in enumerate(outputs) if name.startswith("track.z")]
    checks.below("all nodes loaded alike move alike", difference(fe[1][:, z[:1]], fe[1][:, z[6:7]]), 2e-2)
    place = outputs.index(loads[0])
    checks.below("reciprocity of the shared load", difference(fe[0][:, z].mean(axis=1)[:, None], fe[1][:, place, None]), 1e-9)


def check_fe_places(program, mpirun, folder, checks):
    """The FE model answers at any group: under [[support]] without an interface, and at nodes that follow a coupling."""
    scene = BEAM[: BEAM.index("[interface]")] + '[[support]]\ngroup = "start"\ntype = "clamped"\n'
    scene += RESPONSE.replace('"body"', '"fe"').replace('at = "C"', 'at = "end"')
    Omega, _, outputs, H = Case(program, mpirun, folder, scene, "beam").responses()
    checks.below(f"{outputs[0]} beside the exact cantilever", difference(H[0][:, :1], exact_tip(Omega, 0.02)[:, None]), 1e-4)
    disc = Case(program, mpirun, folder, DISC, "disc")
    places = '[{ at = "inner_edge", dofs = ["x", "y", "z"] }, { at = "hub", dofs = ["x", "y", "z", "rx", "ry", "rz"] }]'
    for ranks in (1, 2):
        _, _, outputs, H = disc.responses(of("fe"), ('fixed = ["hub"]\n', ""), ranks=ranks, outputs=places)
        edge, hub = H[0][:, :-6].reshape(len(H[0]), -1, 3), H[0][:, -6:]
        with h5py.File(disc.folder / "out/disc.response.h5") as f:
            arm = f["outputs/positions"][:][: edge.shape[1] * 3 : 3]  # the hub is at the origin
        rigid = hub[:, None, :3] + np.cross(hub[:, None, 3:], arm)
        checks.below(f"{ranks} rank(s): {edge.shape[1]} nodes follow the hub", np.abs(edge - rigid).max() / np.abs(edge).max(), 1e-10)
        checks.below("  a unit at the edge moves the track as the reverse", reciprocity_of_a_follower(disc, ranks), 1e-9)


def reciprocity_of_a_follower(disc, ranks):
    """Between a node that follows the hub and one of the track."""
    one, other = ('{ at = "inner_edge", dofs = ["x", "z"], near = [0.025, 0.001, 0.0] }', '{ at = "track", dofs = ["y", "z"], near = [0.0, 0.13, 0.0] }')
    H = []
    for load, output in ((one, other), (other, one)):
        disc.write(of("fe"), ('fixed = ["hub"]\n', ""))
        text = (disc.folder / "scene.toml").read_text()
        text = re.sub(r"loads = .*", f"loads = [{load}]", text)
        (disc.folder / "scene.toml").write_text(re.sub(r"outputs = .*", f"outputs = [{output}]", text))
        disc.call("response", ranks)
        H.append(np.stack(responses(disc.folder / "out/disc.response.h5")[3], axis=1))  # [frequency, load, output]
    return float(np.abs(H[0] - H[1].transpose(0, 2, 1)).max() / np.abs(H[0]).max())


def check_files(program, mpirun, folder, checks):
    """Table, page and what `info` says are those of the file of values."""
    disc = Case(program, mpirun, folder, DISC, "disc").made()
    Omega, loads, outputs, H = disc.responses()
    with open(disc.folder / "out/disc.response.csv", newline="") as file:
        header, *rows = csv.reader(file)
    values = np.array(rows, dtype=float)
    checks.below("frequencies of the table", np.abs(values[:, 0] / (Omega / TWO_PI) - 1).max(), 1e-15)
    table = values[:, 1::2] + 1j * values[:, 2::2]
    checks.holds("the table has all digits", (table == np.hstack(H)).all())
    name = f"{outputs[3]} / {loads[1]} im, (rad/s^2)/N"
    checks.holds(f"the table names {name}", header[1 + 2 * (len(outputs) + 3) + 1] == name)
    page = (disc.folder / "out/disc.response.html").read_text()
    checks.holds("the page draws them", '"responses":' in page and "drawResponses" in page)
    told = run(disc.program, "info", "out/disc.response.h5", cwd=disc.folder)
    checks.holds("info tells model and peaks", "accelerance" in told and "(m/s^2)/N" in told and "and 8 more" in told)


def datasets(file):
    """Number and lines of each dataset of a universal file."""
    blocks = re.findall(r"^    -1\n(.*?)^    -1\n", file.read_text(), re.M | re.S)
    return [(int(number), lines) for number, *lines in (block.splitlines() for block in blocks)]


def function_58(lines):
    """Output and load as (node, direction), frequencies and values of a dataset 58, by its columns."""
    dofs = lines[5]
    n, even, low, step = int(lines[6][10:20]), int(lines[6][20:30]), float(lines[6][30:43]), float(lines[6][43:56])
    assert int(dofs[0:5]) == 4 and int(lines[6][0:10]) == 6, "a complex frequency response in double precision"
    if even:
        numbers = np.array([float(line[20 * k : 20 * k + 20]) for line in lines[11:] for k in range(len(line) // 20)])
        f, H = low + step * np.arange(n), numbers[::2] + 1j * numbers[1::2]
    else:
        rows = np.array([[float(line[0:13]), float(line[13:33]), float(line[33:53])] for line in lines[11:]])
        f, H = rows[:, 0], rows[:, 1] + 1j * rows[:, 2]
    return (int(dofs[41:51]), int(dofs[51:55])), (int(dofs[66:76]), int(dofs[76:80])), f, H


def check_universal_file(program, mpirun, folder, checks):
    """It says what the file of values says, for frequencies that add and that multiply."""
    one_node = (', { at = "track", dofs = ["z"] }]', "]")
    disc = Case(program, mpirun, folder, DISC, "disc").made()
    command = (disc.program, "response", "scene.toml", "--output", "out", "--uff", "out/disc.unv")
    done = start(*command, cwd=disc.folder)
    checks.holds(f"a shared load: {done.stderr.rstrip()}", done.returncode == 1 and "track.z" in done.stderr
                 and not list(disc.folder.glob("out/*.response.*")))  # fmt: skip
    for spacing in ("logarithmic", "linear"):
        disc.write(one_node, ("logarithmic", spacing))
        run(*command, cwd=disc.folder)
        Omega, _, outputs, H = responses(disc.folder / "out/disc.response.h5")
        with h5py.File(disc.folder / "out/disc.response.h5") as f:
            nodes, components = f["outputs/node_numbers"][:], f["outputs/components"][:]
            load = (f["loads/node_numbers"][0], f["loads/components"][0] + 1)
        sets = datasets(disc.folder / "out/disc.unv")
        functions = [function_58(lines) for number, lines in sets if number == 58]
        checks.holds(f"{spacing}: datasets", [number for number, _ in sets[:2]] == [164, 2411] and len(functions) == len(outputs))
        checks.holds("  DOFs", [(output, at) for output, at, _, _ in functions]
                     == [((node, component + 1), load) for node, component in zip(nodes, components)])  # fmt: skip
        checks.below("  frequencies, six digits", max(np.abs(f / (Omega / TWO_PI) - 1).max() for *_, f, _ in functions), 1e-5)
        checks.below("  values, twelve digits", difference(np.stack([h for *_, h in functions], axis=1), H[0]), 1e-11)


def measured_file(nodes, positions, modes, f_Hz):
    """A universal file in mm with modes [3 n x k] at nodes."""
    factors = "".join(f"{x:25.16E}" for x in (1e3, 1.0, 1.0)).replace("E", "D")
    text = f"    -1\n   164\n{1:10d}{'SI: mm':20}{2:10d}\n{factors}\n{273.15:25.16E}\n    -1\n    -1\n    15\n"
    for number, x in zip(nodes, 1e3 * positions):
        text += f"{number:10d}{0:10d}{0:10d}{1:10d}" + "".join(f"{value:13.5E}" for value in x) + "\n"
    text += "    -1\n"
    for k, shape in enumerate(modes.T):
        text += "    -1\n    55\n" + "NONE\n" * 5 + "".join(f"{i:10d}" for i in (1, 2, 2, 8, 2, 3)) + "\n"
        text += "".join(f"{i:10d}" for i in (2, 4, 1, k + 1)) + f"\n{f_Hz[k]:13.5E}{1:13.5E}{0:13.5E}{0:13.5E}\n"
        for number, u in zip(nodes, shape.reshape(-1, 3)):
            text += f"{number:10d}\n" + "".join(f"{value:13.5E}" for value in u) + "\n"
        text += "    -1\n"
    return text


def check_mac(program, mpirun, folder, checks):
    """Modes of the body itself, turned among each other and with noise, as a measurement beside it."""
    disc = Case(program, mpirun, folder, DISC, "disc").made()
    with h5py.File(disc.folder / "out/disc.body.h5") as f:
        f_Hz = f["modes/frequencies"][:] / TWO_PI
        positions = f["attachment/node_positions"][:12]
        u = f["modes/attachment_displacements"][:].reshape(-1, 6, len(f_Hz))[:12]
    moves = np.abs(u[:, 2]).max(axis=0) > 0.0
    order = [int(k) for k in np.flatnonzero(moves)[[4, 2, 3]]]
    w = np.zeros((12, 3, 3))
    w[:, 2, :] = u[:, 2, order] * [1.0, -3.0, 0.2]  # out of the plane alone, as one accelerometer finds it
    nodes = np.arange(101, 113)
    measured = disc.folder / "measured.unv"
    measured.write_text(measured_file(nodes, positions + [0.0, 0.0, 0.004], w.reshape(36, 3), f_Hz[order]))
    summary = disc.folder / "mac.json"
    mac = (disc.program, "mac", "out/disc.body.h5", "measured.unv", "--distance", "0.005", "--json", "mac.json")
    told = run(*mac, cwd=disc.folder)
    found = json.loads(summary.read_text())
    phi, psi = u[:, 2, :], w[:, 2, :]
    # Modes in the plane resemble nothing that was measured.
    exact = np.where(moves, (psi.T @ phi) ** 2 / np.outer((psi**2).sum(axis=0), np.where(moves, (phi**2).sum(axis=0), 1.0)), 0.0)
    checks.holds("there are modes in the plane", not moves.all())
    checks.below("MAC by numpy, six digits in the file", np.abs(np.array(found["mac"]) - exact).max(), 1e-4)
    checks.holds("each mode finds itself", [int(np.argmax(row)) for row in found["mac"]] == order)
    checks.holds("12 components", found["n_components"] == 12 and "12" in told)
    checks.below("distance of the nodes", abs(max(node["distance_m"] for node in found["nodes"]) - 0.004), 1e-6)
    for name, change, code, words in (
        ("too far", (), 1, ["101", "0.004", "--distance"]),
        ("damaged", ("0.00000E+00", "0.00000E+x0"), 1, ["measured.unv:", "dataset"]),
        ("another dataset", ("    55\n", "    58\n"), 0, ["measured.unv:", "left out: 1 dataset 58"]),
    ):
        text = measured.read_text()
        (disc.folder / "other.unv").write_text(text.replace(*change, 1) if change else text)
        distance = "0.003" if not change else "0.005"
        done = start(disc.program, "mac", "out/disc.body.h5", "other.unv", "--distance", distance, cwd=disc.folder)
        checks.holds(f"{name}: {done.stderr.rstrip()}", done.returncode == code
                     and all(word.replace("measured", "other") in done.stderr for word in words))  # fmt: skip


def check_example(program, mpirun, folder, checks):
    """The driving point of examples/response: poles and zeros take turns, and its phase is that of something passive."""
    scene = (Path(__file__).parents[2] / "examples/response/scene.toml").read_text()
    tap = Case(program, mpirun, folder, scene, "tap").made()
    Omega, loads, outputs, H = tap.responses()
    checks.holds(f"driven at {loads}", outputs[0] == loads[0] and len(outputs) == 4)
    mobility = H[0][:, 0] / (1j * Omega)
    checks.holds("its mobility takes power at each frequency", (mobility.real > 0).all())


# What is changed in BEAM + RESPONSE, and words of the message.
MISTAKES = [
    ("no [response]", [(RESPONSE, "")], ["response is missing", "scene.toml"]),
    ("unknown node", [('{ at = "C", dofs = ["z"] }', '{ at = "D", dofs = ["z"] }')], ["response.loads[1].at", '"D"', "C"]),
    ("group that is no interface node", [('{ at = "C", dofs = ["z"] }', '{ at = "end", dofs = ["z"] }')], ["end", "interface node"]),
    ("unknown group of the FE model", [of("fe"), ('{ at = "C", dofs = ["z"] }', '{ at = "D", dofs = ["z"] }')], ['"D"', "end"]),
    ("held load", [('{ at = "C", dofs = ["z"] }', '{ at = "A", dofs = ["z"] }')], ["A.z", "held"]),
    ("held load in the FE model", [of("fe"), ('{ at = "C", dofs = ["z"] }', '{ at = "A", dofs = ["z"] }')], ["A.z", "held"]),
    ("component that is none", [of("fe"), ('"z", "ry"] }, {', '"x"] }, {')], ["C.x", "no part"]),
    ("unknown component", [('{ at = "B", dofs = ["ry"] }]', '{ at = "B", dofs = ["yaw"] }]')], ["loads[2].dofs", "yaw"]),
    ("range reversed", [("from_Hz = 0.0", "from_Hz = 20.0")], ["to_Hz = 12", "above from_Hz"]),
    ("one frequency", [("count = 61", "count = 1")], ["count = 1", ">= 2"]),
    ("logarithm of zero", [("count = 61", 'count = 61\nspacing = "logarithmic"')], ["from_Hz", "above 0"]),
    ("loss factor below zero", [("0.02", "-0.02")], ["loss_factor"]),
    ("no loads", [('loads = [{ at = "C", dofs = ["z"] }, { at = "B", dofs = ["ry"] }]', "")], ["response.loads", "missing"]),
    ("resonance", [("loss_factor = 0.02\n", ""), ("from_Hz = 0.0", "from_Hz = FIRST")], ["from_Hz", "natural frequency", "mode 1", "damping"]),
    ("resonance of the FE model", [of("fe"), ("loss_factor = 0.02\n", ""), ("from_Hz = 0.0", "from_Hz = FIRST")],
     ["from_Hz", "natural frequency", "damping"]),
    ("free body at rest", [of("fe"), ('fixed = ["A"]\n', "")], ["from_Hz", "moves freely"]),
    ("modal damping of the FE model", [of("fe"), ('fixed = ["A"]\n', 'fixed = ["A"]\ndamping = { type = "modal", ratio = 0.01 }\n')],
     ["body.damping.type", "modes"]),
    ("dampers where there are none", [of("fe"), ('fixed = ["A"]\n', 'fixed = ["A"]\ndamping = { type = "matrix" }\n')],
     ["body.damping.type", "dampers"]),
    ("section forces of the FE model", [of("fe"), ("count = 61", 'count = 61\nsection_forces = ["beam"]')], ["section_forces"]),
    ("section forces that nobody kept", [("count = 61", 'count = 61\nsection_forces = ["disc"]')], ["section_forces[1]", "disc", "beam"]),
    ("mistyped key", [("count = 61", "count = 61\nspaceing = 3")], ["spaceing", "spacing"]),
]  # fmt: skip


def first_frequency(case):
    """Of the beam's body, Hz, with all digits."""
    with h5py.File(case.folder / "out/beam.body.h5") as f:
        return float(f["modes/frequencies"][0] / TWO_PI)


def check_mistakes(program, mpirun, folder, checks):
    """One message each, on any number of ranks, and nothing written."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    first = f"{first_frequency(beam):.17g}"
    for name, changes, words in MISTAKES:
        beam.write(*((old, new.replace("FIRST", first)) for old, new in changes))
        for ranks in (1, 2) if "FE" in name else (1,):
            command = (beam.program, "response", "scene.toml", "--output", "out")
            done = start(*command, mpirun=mpirun, ranks=ranks, cwd=beam.folder)
            lines = [line for line in done.stderr.splitlines() if "scene.toml" in line]
            good = done.returncode == 1 and len(lines) == 1 and all(word in done.stderr for word in words)
            checks.holds(f"{name}: {done.stderr.splitlines()[:1]}", good)
            checks.holds("  nothing is written", not list(beam.folder.glob("out/*.response.*")))
    beam.write()
    (beam.folder / "out/beam.body.h5").unlink()
    done = start(beam.program, "response", "scene.toml", "--output", "out", cwd=beam.folder)
    checks.holds(f"no body: {done.stderr.rstrip()}", done.returncode == 1 and "chladni run" in done.stderr)


def check_stale(program, mpirun, folder, checks):
    """A new [response] needs no new body; a new thickness does."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    beam.responses(("to_Hz = 12.0", "to_Hz = 9.0"))
    beam.write(("area = 1.0", "area = 1.1"))
    done = start(beam.program, "response", "scene.toml", "--output", "out", cwd=beam.folder)
    checks.holds(f"stale body: {done.stderr.rstrip()}", done.returncode == 1 and "area" in done.stderr)
    run(beam.program, "response", "scene.toml", "--output", "out", "--stale", cwd=beam.folder)


def check_page(program, mpirun, folder, checks, chromium):
    """A browser draws amplitude and phase of the 24 outputs of each load, six of one unit in a figure."""
    disc = Case(program, mpirun, folder, DISC, "disc").made()
    disc.responses(("dofs = [\"z\", \"rx\"]", "dofs = [\"x\", \"y\", \"z\", \"rx\"]"))
    browsed = browse(chromium, disc.folder / "out/disc.response.html", "--dump-dom")
    shown = re.sub(r"<script.*?</script>", "", browsed.stdout, flags=re.DOTALL)
    checks.holds("the console is silent, and no number failed", "CONSOLE" not in browsed.stderr
                 and not re.search("NaN|undefined|Infinity", shown))  # fmt: skip
    checks.holds("the page is drawn", 'data-state="drawn"' in shown)
    checks.holds("two loads", all(f'id="responses-{k}"' in shown for k in (1, 2)) and 'id="responses-3"' not in shown)
    checks.holds("amplitudes and phases", shown.count("Amplitude of the accelerance") >= 8 and shown.count("phase, degrees") >= 8)
    checks.holds("it says what it leaves out", shown.count("24 smaller outputs are not drawn") == 2)


def main(program, mpirun, chromium=None):
    checks = Checks()
    if chromium:
        print("\ncheck_page")
        with tempfile.TemporaryDirectory() as folder:
            check_page(program, mpirun, folder, checks, chromium)
    for check in (check_beam, check_damping, check_loss_factors, check_quantities, check_section_forces, check_stresses, check_disc, check_fe_places, check_files,
                  check_universal_file, check_mac, check_example, check_mistakes, check_stale):  # fmt: skip
        print(f"\n{check.__name__}")
        with tempfile.TemporaryDirectory() as folder:
            check(program, mpirun, folder, checks)
    return 0 if checks.good else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), *sys.argv[2:]))
