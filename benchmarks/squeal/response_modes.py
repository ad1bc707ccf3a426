#!/usr/bin/python3
"""Do frequency response modes pay? Squeal with few modes, with and without them, against the unreduced FE model.

usage: response_modes.py [--quick] [--programs DIR] [--work DIR] OUTPUT

The disc of examples/thesis_disc between one pad pair. Bodies with all modes up to a frequency, by `chladni` and `squeal`,
against eigenvalues of the FE model itself (unreduced_disc.py): growth and frequency at 6 pi rad/s of the modes below 4 kHz that
are unstable there, and the critical speed of the lowest of them. Beside them, to say where an error is from: the same modes with the
exact static compliance of the FE model in place of response modes, and all coordinates of the reduced system. Writes
OUTPUT/response_modes.json, .md and OUTPUT/figures/response_modes.png. With --work the reduction is kept in DIR and, where it is
there already, not made again.
"""
import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import tomllib

import h5py
import numpy as np
import scipy.linalg

import response_modes_report as report
import unreduced_disc as unreduced

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
SPEED = 6.0 * math.pi  # at which growth is compared, rad/s
HIGHEST_HZ = 4e3  # of the modes that are compared
SHIFT = 2 * math.pi * 2200.0  # of the projection of the FE model, rad/s
CHECKED = (-3, -1, 0, 1, 3)  # harmonics at which it is compared with a factorization
RANGES_HZ = (4e3, 8e3, 16e3, 22e3)
RESPONSES = {
    "none": "[]",
    "axial": '[{ kind = "frm", at = "track", dofs = ["z"], omega0 = "auto" }]',
    "axial and slopes": '[{ kind = "frm", at = "track", dofs = ["z", "rx", "ry"], omega0 = "auto" }]',
}
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


def reduce(programs, folder, quick):
    """Files of the reduction and of the FE model; the scene."""
    text = scene(300 if quick else 900, RANGES_HZ[-1], "[]")
    (folder / "scene.toml").write_text(text)
    if not (folder / "masters").exists():
        run([programs / "chladni", "reduce", "scene.toml", "--overwrite", "--", "-cms_view_stiffness", "binary:K",
             "-cms_view_mass", "binary:M", "-cms_view_masters", "binary:masters"], folder)
    return tomllib.loads(text)


def crossing(speeds, growth):
    """The first speed at which growth becomes positive: the cubic speed(growth) through the four points around."""
    up = np.flatnonzero((growth[:-1] < 0) & (growth[1:] >= 0))
    if not len(up) or not 1 <= up[0] < len(speeds) - 2:
        return None
    a, g = speeds[up[0] - 1:up[0] + 3], growth[up[0] - 1:up[0] + 3]
    weights = [np.prod([g[m] / (g[m] - g[j]) for m in range(4) if m != j]) for j in range(4)]
    return float(np.dot(weights, a))


def squeal_of(programs, folder, up_to_Hz, responses, fixed_modes):
    """Eigenvalues over the speed and numbers of coordinates of one body."""
    (folder / "scene.toml").write_text(scene(fixed_modes, up_to_Hz, RESPONSES[responses]))
    run([programs / "chladni", "body", "scene.toml", "--overwrite"], folder)
    run([programs / "squeal", "run", "scene.toml", "--overwrite", "--json", "squeal.json"], folder)
    with h5py.File(folder / "disc.squeal.h5") as file:
        speeds, growth, omega = (file["eigenvalues/" + name][:] for name in ("speeds", "lambda_re", "lambda_im"))
    with h5py.File(folder / "disc.body.h5") as file:
        n_body = len(file["modes/frequencies"])
    own = json.loads((folder / "squeal.json").read_text())
    lowest = np.where(omega < 2 * math.pi * 700.0, growth, -np.inf).max(1)  # the pair with one nodal diameter
    return {"up_to_Hz": up_to_Hz, "responses": responses, "n_body": n_body, "n_squeal": growth.shape[1],
            "first_rad_s": own.get("critical_speed_rad_s"), "first_Hz": own.get("critical_frequency_Hz"),
            "critical_rad_s": crossing(speeds, lowest), "last": growth[-1] + 1j * omega[-1]}


def reduced_poles(folder, fe):
    """(omega^2, {d: c}) of all coordinates of the reduced system with the hub held."""
    with h5py.File(folder / "disc.reduced.h5") as file:
        K, M = file["matrices/stiffness"][:], file["matrices/mass"][:]
        ring, hub = (file["attachment/sets"][name][:] for name in ("track", "hub"))
    kept = np.setdiff1d(np.arange(len(K)), 6 * hub[0] + np.arange(6))
    number = np.full(len(K), -1)
    number[kept] = np.arange(len(kept))
    part = np.ix_(kept, kept)
    omega_2, Phi = scipy.linalg.eigh((K[part] + K[part].T) / 2, (M[part] + M[part].T) / 2)
    load = unreduced.ring_loads(number[6 * ring[:, None] + np.arange(6)], fe.theta, len(kept))
    c = {d: Phi.T @ np.column_stack([b @ np.exp(1j * d * fe.theta) for b in load]) / fe.n for d in fe.harmonics()}
    return omega_2, c


def solution(determinant, guesses, critical):
    """Eigenvalues at SPEED and the critical speed."""
    found = [unreduced.eigenvalue(determinant, x, SPEED) for x in guesses]
    speed, lam = unreduced.critical_speed(determinant, critical, guesses[0].imag)
    return {"critical_rad_s": speed, "critical_Hz": lam.imag / (2 * math.pi), "eigenvalues": found}


def errors(found, reference):
    """Of each quantity; of the critical speed and growth relative, of frequencies relative."""
    own, true = found["eigenvalues"], reference["eigenvalues"]
    critical = found["critical_rad_s"]
    return {"critical": abs(critical / reference["critical_rad_s"] - 1) if critical else None,
            "growth": [abs(x.real / y.real - 1) for x, y in zip(own, true)],
            "frequency": [abs(x.imag / y.imag - 1) for x, y in zip(own, true)]}


def measure(programs, folder, quick):
    fixed_modes, ranges = (300, RANGES_HZ[:2]) if quick else (900, RANGES_HZ)
    pads = unreduced.Pads(reduce(programs, folder, quick))
    fe = unreduced.FeModel(folder)
    rows = [squeal_of(programs, folder, up_to, responses, fixed_modes) for up_to in ranges for responses in RESPONSES]
    last = rows[-1]["last"]
    guesses = sorted((x for x in last if x.real > 1e-3 and x.imag < 2 * math.pi * HIGHEST_HZ), key=lambda x: x.imag)
    critical = rows[-1]["critical_rad_s"]
    receptances = unreduced.projected(fe, SHIFT)
    solve = lambda H: solution(unreduced.closing(pads, fe.n, H), guesses, critical)
    reference = solve(receptances)
    lam = reference["eigenvalues"][0]
    checks = {d: unreduced.factored(fe, d, lam + 1j * d * SPEED) for d in CHECKED}
    reference["receptance_error"] = max(abs(H / abs(H).max() - receptances(d, lam + 1j * d * SPEED) / abs(H).max()).max()
                                        for d, H in checks.items())
    reference["pad_error"] = max(abs(a - b).max() / abs(b).max()
                                 for a, b in zip(pads.derivatives(SPEED), pads.closed_form(SPEED)))
    for row in rows:
        eigenvalues = row.pop("last")
        row["eigenvalues"] = [min(eigenvalues, key=lambda x: abs(x - y)) for y in reference["eigenvalues"]]
        row["errors"] = errors(row, reference)
    omega_2, c = reduced_poles(folder, fe)
    poles = lambda part: unreduced.Poles({d: (omega_2[part], c[d][part]) for d in c})
    whole, static, beside = solve(poles(omega_2 > 0)), unreduced.static_receptances(fe), []
    for up_to in ranges:
        modes = poles(omega_2 < (2 * math.pi * up_to)**2)
        modes.static = {d: static[d] - modes(d, 0j) for d in static}
        beside.append({"up_to_Hz": up_to, "errors": errors(solve(modes), reference)})
    return {"quick": quick, "n_fe_dofs": fe.K.shape[0], "fixed_interface_modes": fixed_modes, "speed_rad_s": SPEED,
            "reference": reference, "reduction": errors(whole, reference), "bodies": rows, "static": beside}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        result = measure(wanted.programs.resolve(), wanted.work or pathlib.Path(name), wanted.quick)
    text = json.dumps(result, indent=1, default=lambda x: [x.real, x.imag])
    (wanted.output / "figures").mkdir(parents=True, exist_ok=True)
    (wanted.output / "response_modes.json").write_text(text + "\n")
    report.write(json.loads(text), wanted.output)


if __name__ == "__main__":
    main()
