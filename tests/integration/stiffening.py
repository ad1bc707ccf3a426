"""Geometric stiffening: rotating beams and discs whose frequencies are known, and where it stands in files.

A spin about z gives the stiffness K + Omega^2 (K_sigma - Z) in the frame that turns: K_sigma by the stress of the
centrifugal forces, Z by their change with the deformation. Coriolis forces are left out where the theory has none.

Usage: stiffening.py PROGRAM_DIR MPIEXEC
"""

import shutil
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from running import changed, run
from scipy.linalg import eigh

failures = []


def expect(claim, value, limit):
    """Prints and remembers whether |value| <= limit."""
    good = abs(value) <= limit
    print(f"{'ok    ' if good else 'FAILED'} {claim}: {value:.3g} (limit {limit:g})")
    if not good:
        failures.append(claim)


BEAM = """name = "beam"
title = "Rotating beam"

[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [1.0, 0.0, 0.0]
elements = 160
points = [{ name = "root", distance = 0.0 }, { name = "tip", distance = 1.0 }]

[material.any]
young = 1e7
poisson = 0.0
density = 1.0

[[section]]
group = "beam"
type = "beam"
theory = "bernoulli-euler"
rotary_inertia = "none"
orientation = [0.0, 0.0, 1.0]
material = "any"
area = 1.0
I_y = 1e-7
I_z = 4e-7
J = 1e-7

[interface]
nodes = ["root", "tip"]

[reduce]
method = "craig-bampton"
modes = 60
stiffening = ["spin", "angular-acceleration", "acceleration"]

[body]
fixed = ["root"]
"""

# Flap frequencies of a uniform cantilever from its axis on, in units of sqrt(EI / m L^4), at the speed Omega in these units:
# A. D. Wright, C. E. Smith, R. W. Thresher, J. L. C. Wang, J. Appl. Mech. 49 (1982) 197.
FLAP = {0: (3.5160, 22.0345), 2: (4.1373, 22.6149), 5: (6.4495, 25.4461), 10: (11.2023, 33.6404)}


class Spinning:
    """A body or reduced system that has spin stiffening about z."""

    def __init__(self, file, load="omega_zz"):
        self.K_sigma = file[f"stiffening/{load}"][:]
        self.Z = file["mass_integrals/displacement_xx"][:] + file["mass_integrals/displacement_yy"][:]
        if "matrices" in file:
            self.K, self.M = file["matrices/stiffness"][:], file["matrices/mass"][:]
        else:
            self.K, self.M = np.diag(file["modes/frequencies"][:] ** 2), np.eye(len(self.Z))

    def frequencies(self, Omega, stress=1.0, held=()):
        """omega, ascending, of some motion without the held coordinates."""
        free = np.setdiff1d(np.arange(len(self.K)), held)
        part = np.ix_(free, free)
        A = self.K + Omega**2 * (stress * self.K_sigma - self.Z)
        return np.sqrt(np.maximum(eigh(A[part], self.M[part], eigvals_only=True), 0.0))


def files(programs, folder, text, *options, ranks=1, mpirun=None):
    folder.mkdir()
    (folder / "scene.toml").write_text(text)
    run(programs / "chladni", "run", folder / "scene.toml", "--output", folder, *options, ranks=ranks, mpirun=mpirun)
    return next(folder.glob("*.reduced.h5")), next(folder.glob("*.body.h5"))


def nearest(values, wanted):
    return values[np.argmin(np.abs(values - wanted))]


def rotating_beam(programs, folder):
    """Flap along z, lag along y: lag^2 = flap^2 - Omega^2 for equal bending stiffness."""
    reduced, body = files(programs, folder / "beam", BEAM)
    with h5py.File(reduced) as system, h5py.File(body) as modes:
        for name, beam, held in (("reduced", Spinning(system), range(6)), ("body", Spinning(modes), ())):
            for Omega, flaps in FLAP.items():
                found = beam.frequencies(Omega, held=held)
                for flap in flaps:  # the table has five digits, and N is constant in each of 160 elements
                    expect(f"{name}: flap {flap} at {Omega}", nearest(found, flap) / flap - 1, 2e-5)
        beam = Spinning(modes)
        # I_z is four times I_y: the lag frequencies at rest are twice those of flap.
        lag = nearest(beam.frequencies(0.0), 2 * 3.516015)
        slope = (nearest(beam.frequencies(0.1), lag) ** 2 - lag**2) / 0.01
        expect("lag: Southwell's coefficient 1.193 - 1", slope - 0.1933, 1e-3)
        twist = modes["stiffening/omega_xx"][:]  # no mass stands beside the axis
        expect("spin about the beam stretches nothing", np.abs(twist).max() / np.abs(beam.K_sigma).max(), 1e-12)
        # An acceleration -g along x hangs the beam: K_sigma = int m g (L - x) w'^2, of the first mode by quadrature.
        sagging = modes["stiffening/acceleration_x"][:]
        x = (np.arange(20000) + 0.5) / 20000
        k, s = 1.875104068711961, 0.734095513758853
        shape = np.cosh(k * x) - np.cos(k * x) - s * (np.sinh(k * x) - np.sin(k * x))
        slopes = k * (np.sinh(k * x) + np.sin(k * x) - s * (np.cosh(k * x) - np.cos(k * x)))
        expected = ((1 - x) * slopes**2).sum() / (shape**2).sum()
        first = np.argmin(np.abs(modes["modes/frequencies"][:] - 3.5160))
        expect("a beam that hangs", -sagging[first, first] / expected - 1, 1e-4)
    return body


def the_known_numbers(programs, folder):
    """A beam of 16.76 Hz in its plane at 40 rad/s: 17.0 Hz with the stiffening, 15.5 Hz without."""
    EI = (2 * np.pi * 16.76 / 3.516015) ** 2
    text = changed(BEAM, ("I_z = 4e-7", f"I_z = {EI * 1e-7:.12g}"), ("I_y = 1e-7", f"I_y = {9 * EI * 1e-7:.12g}"), ("J = 1e-7", "J = 1.0"))  # fmt: skip
    _, body = files(programs, folder / "known", text)
    with h5py.File(body) as modes:
        beam = Spinning(modes)
        at_rest, with_stress, without = (
            nearest(beam.frequencies(Omega, stress) / (2 * np.pi), 16.76) for Omega, stress in ((0.0, 1.0), (40.0, 1.0), (40.0, 0.0)))  # fmt: skip
    expect("in-plane at rest, 16.76 Hz", at_rest - 16.76, 1e-3)
    expect("in-plane at 40 rad/s, 17.0 Hz", with_stress - 17.0, 0.05)
    expect("in-plane at 40 rad/s without stiffening, 15.5 Hz", without - 15.5, 0.05)


def free_beams(programs, folder):
    """A free body accelerates with its centre: it is stretched about that, wherever the axis is."""
    free = changed(BEAM, ('fixed = ["root"]', "fixed = []"))
    found = []
    for name, start in (("far", 3.0), ("centred", -0.5)):
        moved = changed(free, ("start = [0.0", f"start = [{start}"), ("end = [1.0", f"end = [{start + 1.0}"))
        reduced, body = files(programs, folder / name, moved)
        with h5py.File(reduced) as system, h5py.File(body) as modes:
            expect(f"{name}: a free body has it too", int("stiffening" not in modes), 0)
            masters = slice(12)  # whose coordinates do not depend on the signs of modes
            found.append({load: system[f"stiffening/{load}"][masters, masters] for load in ("omega_zz", "acceleration_x")})
    size = np.abs(found[1]["omega_zz"]).max()
    expect("a free beam far from the axis is one about its centre", np.abs(found[0]["omega_zz"] - found[1]["omega_zz"]).max() / size, 1e-7)
    expect("a fall stretches nothing", max(np.abs(one["acceleration_x"]).max() for one in found) / size, 1e-7)


def free_bodies_with_arms(programs, folder):
    """What acts at an arm is the balanced load: a free body follows an acceleration of its frame without stress."""
    mass = '[[mass]]\nat = "tip"\nmass = 1.0\noffset = [0.3, 0.1, 0.05]\n\n[interface]'
    beam = changed(BEAM, ('fixed = ["root"]', "fixed = []"), ("[interface]", mass), ("elements = 160", "elements = 20"), ("modes = 60", "modes = 10"))  # fmt: skip
    far = changed(beam, ("start = [0.0", "start = [3.0"), ("end = [1.0", "end = [4.0"))
    disc = changed(DISC, ("thickness = 2e-5", "thickness = 0.01\noffset = 0.02"), ("modes = 60", "modes = 10"),
                   ('["spin-z"]', '["spin-z", "angular-acceleration", "acceleration"]'))  # fmt: skip
    for name, text, n_nodes in (("mass", beam, 2), ("far mass", far, 2), ("offset", disc, 24)):
        reduced, _ = files(programs, folder / name.replace(" ", "_"), text)
        masters = slice(6 * n_nodes)  # whose coordinates do not depend on the signs of modes
        with h5py.File(reduced) as system:
            loads = list(system["stiffening/loads"].asstr()[:])
            K_sigma = {load: system[f"stiffening/{load}"][masters, masters] for load in loads}
        size = np.abs(K_sigma["omega_zz"]).max()
        expect(f"{name}: the spin stretches it", float(size == 0.0), 0)
        for load in (one for one in loads if not one.startswith("omega")):
            expect(f"{name}: {load} stretches nothing", np.abs(K_sigma[load]).max() / size, 1e-7)
        if name == "mass":
            about_the_root = K_sigma["omega_zz"]
        elif name == "far mass":
            expect("a free beam with a mass far from the axis", np.abs(K_sigma["omega_zz"] - about_the_root).max() / size, 1e-7)


DISC = """title = "Free spinning disc"

[mesh]
generator = "annulus"
inner_radius = 0.005
outer_radius = 0.2
element_order = 3
element_size = 0.03
rings = [{ name = "track", radius = 0.15, nodes = 24 }]

[material.steel]
young = 2.1e11
poisson = 0.3
density = 7800.0

[[section]]
group = "disc"
type = "shell"
material = "steel"
thickness = 2e-5

[interface]
nodes = ["track"]

[reduce]
method = "craig-bampton"
modes = 60
stiffening = ["spin-z"]
"""


def spinning_disc(programs, folder, mpirun):
    """A free disc without bending stiffness: Lamb and Southwell, Proc. R. Soc. Lond. A 99 (1921) 272."""
    reduced, _ = files(programs, folder / "disc", DISC)
    nu, Omega = 0.3, 1000.0
    with h5py.File(reduced) as system:
        disc = Spinning(system)
        found = disc.frequencies(Omega)
        for n, s in ((2, 0), (3, 0), (1, 1), (4, 0)):
            square = ((n + 2 * s) * (n + 2 * s + 2) * (3 + nu) - n**2 * (1 + 3 * nu)) / 8
            # The hole of a fortieth of the radius, and what is left of the bending stiffness.
            expect(f"{n} diameters, {s} circles", nearest(found, Omega * square**0.5) / (Omega * square**0.5) - 1, 3e-3)
        # What a rigid tilt meets: omega^2 = Omega^2 (a disc without thickness; its Coriolis forces are none); a turn in
        # the plane, and a translation along z meet nothing.
        x = system["attachment/node_positions"][:]
        def rigid(u, theta):
            R = np.zeros(len(disc.K))
            R[: 6 * len(x)] = np.hstack([u + np.cross(theta, x), np.tile(theta, (len(x), 1))]).ravel()
            return R
        J = rigid(0, (0, 0, 1)) @ disc.M @ rigid(0, (0, 0, 1))
        tilt, turn = rigid(0, (1, 0, 0)), rigid(0, (0, 0, 1))
        expect("a tilt meets the load", tilt @ disc.K_sigma @ tilt / (J / 2) - 1, 1e-4)
        expect("a turn about the axis balances", turn @ (disc.K_sigma - disc.Z) @ turn / J, 1e-4)
        along = rigid(np.array([0, 0, 1.0]), (0, 0, 0))
        expect("a translation meets nothing", np.abs(disc.K_sigma @ along).max() / np.abs(disc.K_sigma).max(), 1e-9)
        masters = slice(6 * len(x))  # whose coordinates do not depend on the signs and turns of pairs of modes
        one = disc.K_sigma[masters, masters]
    again, _ = files(programs, folder / "ranks", DISC, ranks=2, mpirun=mpirun)
    with h5py.File(again) as system:
        expect("on two ranks", np.abs(system["stiffening/omega_zz"][masters, masters] - one).max() / np.abs(one).max(), 1e-8)


def in_files(programs, folder, body):
    """The body's matrices in the formats that have a place for them; none for another support."""
    scene = folder / "beam/scene.toml"
    with h5py.File(body) as file:
        loads = list(file["stiffening/loads"].asstr()[:])
        matrices = {load: file[f"stiffening/{load}"][:] for load in loads}
        expect("loads", len(loads) - 12, 0)
        expect("of the support of the body", int(list(file["stiffening/fixed"].asstr()[:]) != ["root"]), 0)
    run(programs / "chladni", "export", scene, "--from", folder / "beam", "--format", "mbdyn-develop",
        "--output", folder / "beam.fem")  # fmt: skip
    group = (folder / "beam.fem").read_text().split("** RECORD GROUP 19")[1].split("\n", 1)[1]
    numbers = [float(word) for line in group.splitlines() if not line.startswith("**") for word in line.split()]
    n = len(matrices["omega_zz"])
    expect("MBDyn: matrices", numbers[0] - 12, 0)
    third = np.array(numbers[1 + 2 * (1 + n * n) :][: 1 + n * n])
    expect("MBDyn: the third is that of omega_z^2", third[0] - 3, 0)
    expect("MBDyn: its values", np.abs(third[1:].reshape(n, n) - matrices["omega_zz"]).max(), 1e-12 * abs(third).max())
    run(programs / "chladni", "check", body)
    for form in ("fmu", "exudyn", "matrix-market"):
        said = run(programs / "chladni", "export", scene, "--from", folder / "beam", "--format", form, "--output", folder / "out")  # fmt: skip
        expect(f"{form} has no place for it, and says so", int(f"{form} has no place for it" not in said), 0)
    # The same reduced system, held elsewhere.
    other = folder / "other"
    other.mkdir()
    shutil.copy(folder / "beam/beam.reduced.h5", other)
    (other / "scene.toml").write_text(scene.read_text().replace('fixed = ["root"]', 'fixed = ["tip"]'))
    said = run(programs / "chladni", "body", other / "scene.toml", "--output", other, "--overwrite")
    with h5py.File(other / "beam.body.h5") as file:
        expect("another support has no stiffening", int("stiffening" in file), 0)
    expect("and the program says so", int("stiffening" not in said), 0)


def refusals(programs, folder):
    for name, text, part in (
        ("word", changed(BEAM, ('"spin", ', '"spins", ')), 'must be one of "spin-x"'),
        ("planar", BEAM.replace("[material.any]", '[model]\ndofs = ["z", "ry"]\n\n[material.any]'), "model.dofs"),
    ):
        (folder / name).mkdir()
        (folder / name / "scene.toml").write_text(text)
        said = run(programs / "chladni", "reduce", folder / name / "scene.toml", "--output", folder / name, code=1)
        line = 1 + text[: text.index("stiffening =")].count("\n")
        expect(f"{name}: refused", int(part not in said), 0)
        expect(f"{name}: by its line", int(f"scene.toml:{line}: reduce.stiffening" not in said), 0)
        expect(f"{name}: once", said.count("reduce.stiffening") - 1, 0)
    (folder / "support").mkdir()
    text = changed(BEAM, ('fixed = ["root"]', 'fixed = ["root.rx"]'),
                   ("[material.any]", '[model]\ndofs = ["x", "y", "z", "ry", "rz"]\n\n[material.any]'))  # fmt: skip
    (folder / "support/scene.toml").write_text(text)
    said = run(programs / "chladni", "reduce", folder / "support/scene.toml", "--output", folder / "support", code=1)
    line = 1 + text[: text.index("fixed =")].count("\n")
    expect("a support that is none: by its line", int(f"scene.toml:{line}: body.fixed" not in said), 0)


def main(programs, mpirun):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        body = rotating_beam(programs, folder)
        the_known_numbers(programs, folder)
        free_beams(programs, folder)
        free_bodies_with_arms(programs, folder)
        spinning_disc(programs, folder, mpirun)
        in_files(programs, folder, body)
        refusals(programs, folder)
    if failures:
        sys.exit(f"FAILED: {', '.join(failures)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
