#!/usr/bin/python3
"""Do frequency response modes pay? Squeal with few modes, with and without them, against the unreduced FE model.

usage: response_modes.py [--quick] [--programs DIR] RESULT.json

The disc of examples/thesis_disc, one pad pair. The FE model itself is the yardstick: in the inertial frame a disc that is
the same in every position answers a force f exp(lambda t) at a pad harmonic by harmonic,
  u = sum_d H_d(lambda + i d Omega) f,   H_d(s) = B_d^H (K + s^2 M)^-1 B_d / n^2,
with B_d the load exp(i d theta) on the n nodes of the ring, axial forces and moments about both slopes, and the material
rates sum_d s_d H_d(s_d) f; f = D_a u + D_p p closes it: a determinant of order 3 in lambda. H_d is projected on the
moments of (K - omega_0^2 M)^-1 about a frequency beside the eigenvalue, and the result is checked with (K + s^2 M)
factored at each s_d. Reduced models: `chladni run` and `squeal run` with all modes up to a frequency.
"""
import argparse
import cmath
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
RADIUS, THICKNESS, FRICTION, STIFFNESS, PRELOAD = 0.13, 0.02, 0.6, 6e6, 2000.0
SPEED = 6.0 * math.pi  # at which growth is compared, rad/s
RANGES_HZ = (4e3, 8e3, 16e3, 22e3)
RESPONSES = {
    "none": "[]",
    "axial": '[{ kind = "frm", at = "track", dofs = ["z"], omega0 = "auto" }]',
    "axial and slopes": '[{ kind = "frm", at = "track", dofs = ["z", "rx", "ry"], omega0 = "auto" }]',
}
N_MOMENTS = 8


def replaced(text, pattern, by):
    """The text with its only match of the pattern exchanged."""
    new, n = re.subn(pattern, by, text)
    if n != 1:
        raise SystemExit(f"response_modes.py: examples/thesis_disc/scene.toml has {n} times: {pattern}")
    return new


def scene(fixed_modes, up_to_Hz, responses):
    """The scene of the example for this body; all modes squeal."""
    text = (ROOT / "examples/thesis_disc/scene.toml").read_text()
    text = text[:text.index("[sound]")]
    text = replaced(text, r"modes = 100", f"modes = {fixed_modes}\nmass_integrals = false")
    text = replaced(text, r"sylvester = true.*", "sylvester = false")
    text = replaced(text, r"keep = .*", f"keep = {{ up_to_Hz = {up_to_Hz!r} }}")
    text = replaced(text, r"interface_modes = .*", f"interface_modes = {responses}")
    text = replaced(text, r"use_modes = .*", 'use_modes = "all"')
    text = re.sub(r"\n(growth|transient|map) = .*", "", text)
    text = replaced(text, r"speeds = \{.*", f"speeds = {{ from_rad_s = 1.0, to_rad_s = {SPEED!r}, count = 121 }}")
    return replaced(text, r"analyses = .*", 'analyses = ["eigenvalues", "critical-speed"]')


def run(words, folder):
    words = list(map(str, words))
    done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")


def petsc_matrix(file):
    """A sparse matrix of PETSc's binary viewer."""
    head = np.fromfile(file, ">i4", 4)
    _, m, n, nnz = map(int, head)
    lengths = np.fromfile(file, ">i4", m, offset=16)
    columns = np.fromfile(file, ">i4", nnz, offset=16 + 4 * m)
    values = np.fromfile(file, ">f8", nnz, offset=16 + 4 * m + 4 * nnz)
    A = scipy.sparse.csr_matrix((values.astype(float), columns.astype(int), np.r_[0, np.cumsum(lengths)]), (m, n))
    missing = abs(A - A.T).max() > 1e-9 * abs(A).max()
    return A + scipy.sparse.tril(A.T, -1) if missing else A


class FeModel:
    """K and M with the hub held, and the loads of the ring."""

    def __init__(self, folder):
        import h5py
        K, M = petsc_matrix(folder / "K"), petsc_matrix(folder / "M")
        masters = np.fromfile(folder / "masters", ">i4")[2:].astype(int)
        with h5py.File(folder / "disc.reduced.h5") as file:
            sets = file["attachment/sets"]
            ring, hub = sets["track"][:], sets["hub"][:]
            positions = file["attachment/node_positions"][:]
        if positions.shape[0] == 3:
            positions = positions.T
        dofs = masters.reshape(-1, 6)  # x, y, z, rx, ry, rz of each attachment node
        free = np.setdiff1d(np.arange(K.shape[0]), dofs[hub].ravel())
        number = np.full(K.shape[0], -1)
        number[free] = np.arange(len(free))
        self.K, self.M = K[free][:, free].tocsc(), M[free][:, free].tocsc()
        self.theta = np.arctan2(positions[ring, 1], positions[ring, 0])
        self.n = len(ring)
        # Columns b of a node: u_z; W_r = -theta_t; W_t = theta_r.
        c, s = np.cos(self.theta), np.sin(self.theta)
        at = number[dofs[ring]]
        rows = np.concatenate([at[:, 2], at[:, 3], at[:, 4], at[:, 3], at[:, 4]])
        nodes = np.tile(np.arange(self.n), 5)
        kinds = np.repeat([0, 1, 1, 2, 2], self.n)
        values = np.concatenate([np.ones(self.n), s, -c, c, s])
        self.load = [scipy.sparse.csc_matrix((values[kinds == k], (rows[kinds == k], nodes[kinds == k])),
                                             (len(free), self.n)) for k in range(3)]

    def harmonic(self, d):
        """B_d [n x 3]."""
        wave = np.exp(1j * d * self.theta)
        return np.column_stack([b @ wave for b in self.load])


class Receptances:
    """H_d(s) about a frequency, from moments; exact(d, s) factors."""

    def __init__(self, fe, omega_0):
        self.fe = fe
        factor = scipy.sparse.linalg.splu(fe.K - omega_0**2 * fe.M, permc_spec="MMD_AT_PLUS_A",
                                          options={"SymmetricMode": True}, diag_pivot_thresh=0.01)
        self.models = []
        for d in range((fe.n - 1) // 2 + 1):
            B = fe.harmonic(d)
            block = np.column_stack([B.real, B.imag]) if d else B.real
            basis = np.zeros((len(block), 0))
            X = factor.solve(block)
            for _ in range(N_MOMENTS):
                for _ in range(2):
                    X -= basis @ (basis.T @ X)
                    q, r = np.linalg.qr(X)
                keep = abs(np.diag(r)) > 1e-10 * abs(np.diag(r)).max()
                basis = np.column_stack([basis, q[:, keep]])
                X = factor.solve(fe.M @ q[:, keep])
            self.models.append((basis.T @ (fe.K @ basis), basis.T @ (fe.M @ basis), basis.T @ B))

    def __call__(self, d, s):
        K, M, B = self.models[abs(d)]
        B = B.conj() if d < 0 else B
        return B.conj().T @ np.linalg.solve(K + s * s * M, B) / self.fe.n**2

    def exact(self, d, s):
        factor = scipy.sparse.linalg.splu((self.fe.K + s * s * self.fe.M).tocsc(), permc_spec="MMD_AT_PLUS_A",
                                          options={"SymmetricMode": True}, diag_pivot_thresh=0.01)
        B = self.fe.harmonic(d)
        return B.conj().T @ factor.solve(B) / self.fe.n**2


def pad_forces(motion, rates, speed):
    """(F_w, F_r, F_t) of a pad pair on the disc at (w, g_r, g_t) and their material rates; bilateral law."""
    w, g_r, g_t = motion
    s = cmath.sqrt(1 + g_r * g_r + g_t * g_t)
    S, f_r, f_t = [0, 0], [0, 0], [0, 0]
    for i, sigma in enumerate((1.0, -1.0)):
        lever = sigma * 0.5 * THICKNESS / s
        v_x, v_y = -lever * rates[1], speed * RADIUS - lever * rates[2]
        v_z = g_r * v_x + g_t * v_y
        v = cmath.sqrt(v_x * v_x + v_y * v_y + v_z * v_z)
        lift = w + sigma * 0.5 * THICKNESS * (s - 1)
        S[i] = PRELOAD + sigma * STIFFNESS * lift
        N = S[i] / (1 / s + sigma * FRICTION * v_z / v)
        f_r[i] = sigma * N * g_r / s - FRICTION * N * v_x / v
        f_t[i] = sigma * N * g_t / s - FRICTION * N * v_y / v
    half = 0.5 * THICKNESS / s
    return np.array([S[1] - S[0], half * (f_r[1] - f_r[0]), half * (f_t[1] - f_t[0])])


def derivatives(speed):
    """D_a and D_p at rest by complex steps."""
    D = np.zeros((3, 6))
    for j in range(6):
        x = np.zeros(6, complex)
        x[j] = 1e-30j
        D[:, j] = pad_forces(x[:3], x[3:], speed).imag / 1e-30
    return D[:, :3], D[:, 3:]


def closing(receptance, lam, speed, n):
    """det(I - D_a H_0 - D_p H_1), whose zeros are the eigenvalues."""
    D_a, D_p = derivatives(speed)
    H_0 = np.zeros((3, 3), complex)
    H_1 = np.zeros((3, 3), complex)
    for d in range(-((n - 1) // 2), (n - 1) // 2 + 1):
        s = lam + 1j * d * speed
        H = receptance(d, s)
        H_0 += H
        H_1 += s * H
    return np.linalg.det(np.eye(3) - D_a @ H_0 - D_p @ H_1)


def zero(function, x, dx):
    """By the secant method in the complex plane."""
    y = function(x)
    for _ in range(60):
        x_2 = x + dx
        y_2 = function(x_2)
        dx = -y_2 * dx / (y_2 - y)
        x, y = x_2, y_2
        if abs(dx) < 1e-11 * abs(x):
            return x + dx
    raise SystemExit("response_modes.py: the secant method did not converge")


def eigenvalue(fe, guess, speed):
    """That of the FE model beside a guess, and what a factorization at each s leaves of it."""
    receptances = Receptances(fe, 1.003 * guess.imag)
    lam = zero(lambda x: closing(receptances, x, speed, fe.n), guess, 1e-6 * abs(guess))
    slope = (closing(receptances, lam * (1 + 1e-8), speed, fe.n) - closing(receptances, lam, speed, fe.n)) / (1e-8 * lam)
    return lam, abs(closing(receptances.exact, lam, speed, fe.n) / slope)


def critical_speed(fe, guess_speed, guess_omega):
    """Speed and frequency at which an eigenvalue is imaginary: Newton's method on both."""
    receptances = Receptances(fe, 1.003 * guess_omega)
    speed, lam = guess_speed, 1j * guess_omega
    for _ in range(30):
        lam = zero(lambda x: closing(receptances, x, speed, fe.n), lam, 1e-6 * abs(lam))
        step = 1e-4 * speed
        above = zero(lambda x: closing(receptances, x, speed + step, fe.n), lam, 1e-7 * abs(lam))
        change = -lam.real * step / (above.real - lam.real)
        speed += change
        if abs(change) < 1e-10 * speed:
            return speed, lam.imag
    raise SystemExit("response_modes.py: the critical speed did not converge")


def reduced(programs, folder, up_to_Hz, responses, fixed_modes):
    """Unstable eigenvalues at SPEED, critical speed and numbers of coordinates of one body."""
    import h5py
    (folder / "scene.toml").write_text(scene(fixed_modes, up_to_Hz, RESPONSES[responses]))
    run([programs / "chladni", "body", "scene.toml", "--overwrite"], folder)
    run([programs / "squeal", "run", "scene.toml", "--overwrite", "--json", "squeal.json"], folder)
    with h5py.File(folder / "disc.squeal.h5") as file:
        group = file["eigenvalues"]
        growth, omega = (np.array(group[name]) for name in ("lambda_re", "lambda_im"))
        critical = json.loads((folder / "squeal.json").read_text())
    with h5py.File(folder / "disc.body.h5") as file:
        f_Hz = np.array(file["modes/frequencies"])
    last = growth[-1] + 1j * omega[-1]
    return {"up_to_Hz": up_to_Hz, "responses": responses, "n_body": len(f_Hz), "n_squeal": len(last),
            "critical_speed_rad_s": critical["critical_speed_rad_s"],
            "critical_frequency_Hz": critical["critical_frequency_Hz"],
            "unstable": [[x.real, x.imag] for x in sorted(last[(last.real > 1e-3)], key=lambda x: x.imag)]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("result", type=pathlib.Path)
    wanted = parser.parse_args()
    programs = wanted.programs.resolve()
    fixed_modes = 300 if wanted.quick else 900
    ranges = RANGES_HZ[:2] if wanted.quick else RANGES_HZ
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(scene(fixed_modes, ranges[-1], "[]"))
        run([programs / "chladni", "reduce", "scene.toml", "--", "-cms_view_stiffness", "binary:K", "-cms_view_mass",
             "binary:M", "-cms_view_masters", "binary:masters"], folder)
        fe = FeModel(folder)
        rows = [reduced(programs, folder, up_to, responses, fixed_modes) for up_to in ranges for responses in RESPONSES]
        best = rows[-1]
        reference = [eigenvalue(fe, complex(*x), SPEED) for x in best["unstable"] if x[1] < 2 * math.pi * ranges[0]]
        speed, omega = critical_speed(fe, best["critical_speed_rad_s"], 2 * math.pi * best["critical_frequency_Hz"])
    result = {"n_fe_dofs": fe.K.shape[0], "fixed_interface_modes": fixed_modes, "speed_rad_s": SPEED,
              "reference": {"critical_speed_rad_s": speed, "critical_frequency_Hz": omega / (2 * math.pi),
                            "unstable": [[x.real, x.imag] for x, _ in reference],
                            "residuals": [r for _, r in reference]},
              "bodies": rows}
    wanted.result.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
