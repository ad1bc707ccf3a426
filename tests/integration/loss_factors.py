"""Structural damping from the scene to the body: closed forms, sectors against the whole disc, bad input.

Usage: loss_factors.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import changed, run

from sectors import ANNULUS, DISC

ETA_BEAM, ETA_SUPPORT, KAPPA = 0.01, 0.4, 20.0

BEAM = f"""
name = "beam"
[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [1.0, 0.0, 0.0]
elements = 60
[model]
dofs = ["z", "ry"]
[material.unit]
young = 1.0
poisson = 0.0
density = 1.0
loss_factor = {ETA_BEAM}
[[section]]
group = "beam"
type = "beam"
theory = "bernoulli-euler"
rotary_inertia = "none"
material = "unit"
area = 1.0
I_y = 1.0
I_z = 1.0
J = 1.0
[[spring]]
at = "end"
stiffness = {{ z = {KAPPA} }}
loss_factor = {ETA_SUPPORT}
[interface]
nodes = ["start", "end"]
[reduce]
method = "craig-bampton"
modes = 20
[body]
fixed = ["start"]
"""

failures = []


def expect(claim, value, limit):
    good = abs(value) <= limit
    print(f"{'ok    ' if good else 'FAILED'} {claim}: {value:.3g} (limit {limit:g})")
    if not good:
        failures.append(claim)


def lambda_of_beam(b):
    """omega^2 of a clamped beam of EI (1 + i eta) whose tip stands on kappa (1 + i eta_support), near b^4."""
    kappa = KAPPA * (1 + 1j * ETA_SUPPORT) / (1 + 1j * ETA_BEAM)

    def determinant(b):
        p, m = np.cosh(b) + np.cos(b), np.cosh(b) - np.cos(b)
        q, n = np.sinh(b) + np.sin(b), np.sinh(b) - np.sin(b)
        # w = A m + B n: no moment, and the shear force is that of the support.
        return p * (b**3 * p - kappa * n) - q * (b**3 * n - kappa * m)

    for _ in range(50):
        h = 1e-6
        b = b - determinant(b) * 2 * h / (determinant(b + h) - determinant(b - h))
    return b**4 * (1 + 1j * ETA_BEAM)


def check_beam(programs, mpirun, ranks):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(BEAM)
        said = run(programs / "chladni", "run", folder / "scene.toml", "--output", folder, mpirun=mpirun, ranks=ranks)
        with h5py.File(folder / "beam.reduced.h5") as file:
            K, M, H = (file[f"matrices/{name}"][:] for name in ("stiffness", "mass", "structural_damping"))
            held = np.concatenate([file["masters/node"][:] == 0, np.zeros(len(K) - file["masters/node"].shape[0], bool)])
        with h5py.File(folder / "beam.body.h5") as file:
            omega, eta = file["modes/frequencies"][:], file["modes/loss_factors"][:]
            C, H_body = file["modes/damping"][:], file["modes/structural_damping"][:]
    free = ~held
    values = np.linalg.eigvals(np.linalg.solve(M[np.ix_(free, free)], (K + 1j * H)[np.ix_(free, free)]))
    for i in range(3):
        exact = lambda_of_beam(omega[i] ** 0.5)
        found = values[np.abs(values - exact).argmin()]
        # Twenty fixed-interface modes and sixty elements leave 1e-6 in the third.
        expect(f"lambda of mode {i + 1} on {ranks} ranks", abs(found / exact - 1), 1e-5)
        # phi^T H phi / phi^T K phi is of first order in eta; the support moves the first mode by itself.
        expect(f"loss factor {i + 1}", eta[i] / (exact.imag / exact.real) - 1, 0.1)
    expect("loss factors are those of the matrix", np.abs(np.diag(H_body) / omega**2 - eta).max(), 1e-12)
    expect("C is its viscous equivalent", np.abs(C - H_body / np.sqrt(np.outer(omega, omega))).max(), 1e-9)
    if f"{eta[0]:.3g}" not in said or "loss factor" not in said:
        failures.append("the loss factors are not told")


def disc(sectors):
    lossy = DISC.format(method="craig-bampton", sectors=sectors, **ANNULUS)
    return changed(lossy[: lossy.index("[squeal]")], ("density = 6300.0\n", "density = 6300.0\nloss_factor = 0.004\n"),
                   ('fixed = ["hub"]\n', ""),
                   ("[interface]\n", '[[spring]]\nat = "hub"\nstiffness = { x = 1e8, y = 1e8, z = 1e8, rx = 1e5, ry = 1e5, '
                    'rz = 1e5 }\nloss_factor = 0.5\n[interface]\n'))  # fmt: skip


def check_sectors(programs, mpirun):
    found = []
    for sectors, ranks in (("", 1), ("sectors = 12", 1), ("sectors = 12", 2)):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "scene.toml").write_text(disc(sectors))
            run(programs / "chladni", "run", folder / "scene.toml", "--output", folder, mpirun=mpirun, ranks=ranks)
            with h5py.File(folder / "disc.body.h5") as file:
                found.append((file["modes/frequencies"][:], file["modes/loss_factors"][:]))
    (omega, eta), *others = found
    expect("modes between both materials", 0.0 if eta.max() > 3 * eta.min() else 1.0, 0.0)
    for i, (omega_s, eta_s) in enumerate(others):
        # As the frequencies of the two ways differ.
        expect(f"frequencies by sectors, run {i}", np.abs(omega_s / omega - 1).max(), 1e-6)
        expect(f"loss factors by sectors, run {i}", np.abs(eta_s / eta - 1).max(), 1e-5)


def check_bad_input(programs):
    bad = [
        ("loss_factor = 0.01", "loss_factor = -0.1", "material.unit.loss_factor = -0.1: must be >= 0"),
        ("stiffness = { z = 20.0 }", "damping = { z = 20.0 }", "is that of the stiffness"),
        ('fixed = ["start"]', 'fixed = ["start"]\ndamping = { type = "modal", ratio = { at_Hz = [0.0, 1.0], '
         'values = [0.1, 0.1] } }', "the ratios are given from 0 to 1 Hz"),
        ('fixed = ["start"]', 'fixed = ["start"]\ndamping = { type = "modal", ratio = { at_Hz = [2.0, 1.0], '
         'values = [0.1, 0.1] } }', "must be larger than the one before"),
    ]  # fmt: skip
    for old, new, said in bad:
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "scene.toml").write_text(changed(BEAM, (old, new)))
            text = run(programs / "chladni", "run", folder / "scene.toml", "--output", folder, code=1)
            if said not in text or "scene.toml:" not in text:
                failures.append(f"{new!r} is answered with {text!r}")
            if list(folder.glob("*.body.h5")):
                failures.append(f"{new!r} leaves a body")


def main(programs, mpirun):
    for ranks in (1, 2):
        check_beam(programs, mpirun, ranks)
    check_sectors(programs, mpirun)
    check_bad_input(programs)
    if failures:
        sys.exit("FAILED: " + "; ".join(failures))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
