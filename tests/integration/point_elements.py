"""A beam with a lumped mass, springs and a damper, on one and two ranks, against its own small model.

Usage: point_elements.py PROGRAM_DIR MPIRUN
"""

import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import run, summary

N = 30  # elements
MASS, INERTIA, ARM = 0.4, 0.02, 0.1  # at the tip; the arm along the beam
STIFFNESS, DAMPING = 50.0, 3.0  # in the middle, to the ground
BETWEEN = 7.0  # N/m along z between the middle and the tip

SCENE = f"""
name = "beam"
[mesh]
generator = "beam"
start = [0.0, 0.0, 0.0]
end = [1.0, 0.0, 0.0]
elements = {N}
points = [{{ name = "middle", distance = 0.5 }}]
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
material = "unit"
area = 1.0
I_y = 1.0
I_z = 1.0
J = 1.0
[[mass]]
at = "end"
mass = {MASS}
inertia = [0.0, {INERTIA}, {INERTIA}]
offset = [{ARM}, 0.0, 0.0]
[[spring]]
at = "middle"
stiffness = {{ z = {STIFFNESS} }}
damping = {{ z = {DAMPING} }}
[[spring]]
at = "middle"
to = "end"
stiffness = {{ z = {BETWEEN} }}
[interface]
nodes = ["start", "end"]
[reduce]
method = "craig-bampton"
modes = 20
[body]
fixed = ["start"]
keep = {{ modes = 5 }}
"""


def own_matrices():
    """Of the same model in (w, theta_y), held at its start."""
    h = 1 / N
    k = np.array([[12, -6 * h, -12, -6 * h], [-6 * h, 4 * h**2, 6 * h, 2 * h**2],
                  [-12, 6 * h, 12, 6 * h], [-6 * h, 2 * h**2, 6 * h, 4 * h**2]]) / h**3  # fmt: skip
    m = np.array([[156, -22 * h, 54, 13 * h], [-22 * h, 4 * h**2, -13 * h, -3 * h**2],
                  [54, -13 * h, 156, 22 * h], [13 * h, -3 * h**2, 22 * h, 4 * h**2]]) * h / 420  # fmt: skip
    K, M = np.zeros((2, 2 * N + 2, 2 * N + 2))
    for e in range(N):
        K[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += k
        M[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += m
    # The centre of the mass moves by w - arm theta_y.
    M[-2:, -2:] += [[MASS, -MASS * ARM], [-MASS * ARM, INERTIA + MASS * ARM**2]]
    K[N, N] += STIFFNESS
    # Relative motion half-way: w_2 + theta_2 / 4 - (w_1 - theta_1 / 4), nodes 0.5 apart.
    B = np.zeros(len(K))
    B[[N, N + 1, 2 * N, 2 * N + 1]] = -1, 0.25, 1, 0.25
    K += BETWEEN * np.outer(B, B)
    return K[2:, 2:], M[2:, 2:]


def own_frequencies():
    K, M = own_matrices()
    L = np.linalg.cholesky(K)
    A = np.linalg.solve(L, np.linalg.solve(L, M).T)
    return 1 / np.sqrt(np.linalg.eigvalsh((A + A.T) / 2)[::-1][:5])


def body(programs, mpirun, ranks, folder):
    """Frequencies, damping matrix and the modes' displacement of the middle."""
    (folder / "scene.toml").write_text(SCENE)
    run(programs / "chladni", "run", folder / "scene.toml", "--output", folder, mpirun=mpirun, ranks=ranks)
    with h5py.File(folder / "beam.body.h5") as f:
        x, u = f["picture/positions"][:, 0], f["picture/displacements"][2::3]
        return f["modes/frequencies"][:], f["modes/damping"][:], u[np.abs(x - 0.5).argmin()]


def direct(programs, mpirun, ranks, folder):
    """Frequencies of `modes`, and the deflection that `static` finds under a tip force of 1 N."""
    held = '[[support]]\ngroup = "start"\ntype = "clamped"\n[modes]\ncount = 5\n'
    load = '[[load]]\ntype = "force"\ngroup = "end"\nforce = [0.0, 0.0, 1.0]\n[static]\nreport = ["end"]\n'
    (folder / "scene.toml").write_text(SCENE[: SCENE.index("[interface]")] + held + load)
    found = {command: summary(programs / "chladni", command, "scene.toml", cwd=folder, mpirun=mpirun, ranks=ranks)
             for command in ("modes", "static")}  # fmt: skip
    omega = 2 * np.pi * np.array(found["modes"]["frequencies_Hz"])
    return omega, found["static"]["motions"]["end"][0]["motion"][2]


def complaints_of_direct(omega, deflection):
    K, _ = own_matrices()
    exact = np.linalg.solve(K, np.eye(len(K))[-2])[-2]
    for name, value, expected in (("frequencies", omega, own_frequencies()), ("deflection", deflection, exact)):
        error = np.max(np.abs(value / expected - 1))
        if not error < 1e-8:  # round-off times the condition of K
            yield f"{name} of the model itself differ by {error:.1e}"


def complaints(omega, C, middle):
    error = np.max(np.abs(omega / own_frequencies() - 1))
    # Twenty fixed-interface modes leave 1e-6 in the fifth frequency.
    if not error < 1e-5:
        yield f"frequencies differ by {error:.1e}"
    exact = DAMPING * np.outer(middle, middle)  # the damper is on a slave: all of Q_CB takes part
    error = np.max(np.abs(C - exact)) / np.max(np.abs(exact))
    if not error < 1e-9:  # round-off
        yield f"the damping matrix differs by {error:.1e}"


def main(programs, mpirun):
    bad = []
    for ranks in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            omega, C, middle = body(programs, mpirun, ranks, Path(folder))
            alone = direct(programs, mpirun, ranks, Path(folder))
        print(f"{ranks} ranks: omega = {omega}")
        bad += [f"{ranks} ranks: {text}" for text in complaints(omega, C, middle)]
        bad += [f"{ranks} ranks: {text}" for text in complaints_of_direct(*alone)]
    if bad:
        sys.exit("FAILED: " + "; ".join(bad))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
