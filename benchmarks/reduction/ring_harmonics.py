#!/usr/bin/python3
"""What do a few harmonics of a ring cost in accuracy, and what do they save?

usage: ring_harmonics.py [OUTPUT] [--size 0.009] [--harmonics 3 6 10 20 30] [--larger 0.0045] [--programs DIR]

The disc of examples/thesis_disc, from the mesh to the squeal, with all 360 DOFs of its ring as masters and
with harmonics instead. Errors are those of the frequencies of the clamped disc, of the critical speed and of
the largest growth rate against the disc with all DOFs. Beside it what a ring would give that may not move
but by these harmonics: the same matrices, projected. Then the cost of 10 harmonics on larger meshes. Writes OUTPUT/ring_harmonics.json, .md and .png.
"""
import argparse
import pathlib
import tempfile

import numpy as np

import run

SQUEAL = """
[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 6.28318531, to_rad_s = 31.4159265, count = 5 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues", "critical-speed"]
"""
NODES = 'nodes = ["track", "hub"]\n'
PHASES = ("assembly", "factorization", "fixed-interface modes", "constraint modes", "projection",
          "error estimates")


def program(arguments, name, command, folder):
    return run.summary(arguments.programs / name, command, folder / "scene.toml", folder)


def read(folder):
    import h5py
    with h5py.File(next(folder.glob("*.reduced.h5"))) as file:
        names = {"K": "matrices/stiffness", "M": "matrices/mass", "component": "masters/component",
                 "node": "masters/node", "shapes": "masters/shapes"}
        return {key: file[name][()] for key, name in names.items() if name in file}


def measure_case(arguments, harmonics):
    """From the mesh to the squeal, all in one folder; harmonics None: all DOFs of the ring."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        path = run.scene(folder, arguments.size, modes=arguments.modes)
        text = path.read_text() + SQUEAL
        assert text.count(NODES) == 1
        if harmonics is not None:
            text = text.replace(NODES, NODES + f'rings = [{{ name = "track", harmonics = {harmonics} }}]\n')
        (folder / "scene.toml").write_text(text)
        reduced = program(arguments, "chladni", "reduce", folder)
        body = program(arguments, "chladni", "body", folder)
        squeal = program(arguments, "squeal", "run", folder)
        system = read(folder)
        MiB = next(folder.glob("*.reduced.h5")).stat().st_size / 2**20
    growth = [max(re for re, _ in speed["lambda"]) for speed in squeal["eigenvalues"]]
    return {"harmonics": harmonics, "dofs": reduced["n_dofs"], "masters": reduced["n_masters"],
            "factor_entries": reduced["factor_entries"],
            "cpu_s": {phase: reduced["phases_cpu_s"][phase] for phase in PHASES},
            "reduce_cpu_s": reduced["cpu_s"], "body_cpu_s": body["cpu_s"], "file_MiB": MiB,
            "frequencies_Hz": reduced["certified_frequencies_Hz"], "eta2": reduced["eta2"],
            "critical_speed_rad_s": squeal["critical_speed_rad_s"], "growth_1_s": growth}, system


def reduction_alone(arguments, size, harmonics):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text = run.scene(folder, size, modes=arguments.modes).read_text()
        if harmonics:
            text = text.replace(NODES, NODES + f'rings = [{{ name = "track", harmonics = {harmonics} }}]\n')
        (folder / "scene.toml").write_text(text)
        reduced = program(arguments, "chladni", "reduce", folder)
    return {"harmonics": harmonics, "dofs": reduced["n_dofs"], "factor_entries": reduced["factor_entries"],
            "cpu_s": {phase: reduced["phases_cpu_s"][phase] for phase in PHASES},
            "reduce_cpu_s": reduced["cpu_s"], "peak_MiB": reduced["peak_MiB"]}


def clamped_frequencies(K, M):
    from scipy.linalg import eigh
    # The drilling rotation has no mass: the inverse problem, largest values first.
    mu = eigh(M, K, eigvals_only=True)[::-1]
    return 1 / np.sqrt(mu[mu > 1e-14 * mu[0]]) / (2 * np.pi)


def restricted_ring(full, shapes, harmonics, hub):
    """Frequencies in Hz of the disc, hub clamped, whose ring moves by harmonics alone."""
    n_m = len(full["node"])
    ring = np.flatnonzero(full["node"] != hub)
    rows = 6 * full["node"][ring] + full["component"][ring]
    F = shapes[rows][:, 6 + np.arange(6 * (2 * harmonics + 1))]  # behind the hub
    T = np.zeros((len(full["K"]), F.shape[1] + len(full["K"]) - n_m))
    T[ring, :F.shape[1]] = F
    T[n_m:, F.shape[1]:] = np.eye(len(full["K"]) - n_m)
    return clamped_frequencies(T.T @ full["K"] @ T, T.T @ full["M"] @ T)


def measure(arguments):
    full, system = measure_case(arguments, None)
    hub = int(system["node"].max())  # the last set
    cases, shapes = [full], None
    for harmonics in sorted(arguments.harmonics, reverse=True):
        case, ring = measure_case(arguments, harmonics)
        shapes = ring["shapes"] if shapes is None else shapes  # of most harmonics
        f, reference = np.array(case["frequencies_Hz"]), np.array(full["frequencies_Hz"])
        n = min(len(f), len(reference))
        case["frequency_error"] = list(f[:n] / reference[:n] - 1)
        held = restricted_ring(system, shapes, min(harmonics, 29), hub)
        case["restricted_error"] = list(held[:n] / reference[:n] - 1)
        case["restricted_missing"] = int(np.sum(reference < 0.999 * reference[-1])
                                         - np.sum(held < 0.999 * reference[-1]))
        case["speed_error"] = case["critical_speed_rad_s"] / full["critical_speed_rad_s"] - 1
        scale = max(abs(g) for g in full["growth_1_s"])
        case["growth_error"] = max(abs(a - b) for a, b in
                                   zip(case["growth_1_s"], full["growth_1_s"], strict=True)) / scale
        cases.append(case)
    larger = [reduction_alone(arguments, size, n) for size in arguments.larger for n in (None, 10)]
    return {"machine": run.machine(), "modes": arguments.modes, "cases": [full] + cases[:0:-1],
            "larger": larger}


def table(result):
    full, *cases = result["cases"]
    f = np.array(full["frequencies_Hz"])
    lines = ["# What do a few harmonics of a ring cost, and what do they save?", "",
             f"The thesis disc, {full['dofs']} DOFs, {result['modes']} fixed-interface modes, a ring of 60 nodes "
             f"with all {full['masters']} masters (first row) and with harmonics instead. Errors are against that first row: of the "
             f"{len(f)} frequencies of the clamped disc up to {f[-1] / 1000:.1f} kHz, of the critical speed of the pair "
             "with three diameters, and of the largest growth rate (of the largest one). Written by "
             f"`benchmarks/reduction/ring_harmonics.py` on {result['machine']['processor']}, commit {result['machine']['commit']}; "
             "[the figures of all modes](ring_harmonics.json).", "",
             "| harmonics | masters | frequency error upwards, up to 10 kHz | up to the end | downwards | largest eta^2 / 2 | "
             "critical speed | growth | restricted ring: largest error | modes missing |",
             "|---|---|---|---|---|---|---|---|---|---|",
             f"| all DOFs | {full['masters']} | - | - | - | {0.5 * max(full['eta2']):.1e} | - | - | - | - |"]
    for case in cases:
        error, held = np.array(case["frequency_error"]), np.array(case["restricted_error"])
        low = error[f[:len(error)] < 1e4].max()
        lines.append(f"| {case['harmonics']} | {case['masters']} | {max(0.0, low):.1e} | {max(0.0, error.max()):.1e} | "
                     f"{max(0.0, -error.min()):.1e} | {0.5 * max(case['eta2']):.1e} | {abs(case['speed_error']):.1e} | {case['growth_error']:.1e} | "
                     f"{held.max():.1e} | {case['restricted_missing']} |")
    lines += ["", "Harmonics that are no masters are slaves like any other DOF: the modes then bend the ring in them, and no mode is lost. Frequencies fall if "
              "a mode of many diameters is found with its ring free, and are then more accurate than with all DOFs as masters. They rise if the same number"
              " of modes has to represent more with fewer masters, and if a mode that falls has changed places with another one, because errors are by plac"
              "e in the order. A restricted ring moves by its harmonics alone and holds the modes of more diameters: it has the largest errors, and modes are missing below the end.", "",
              "![Errors over the frequency](ring_harmonics.png)", "", "## What it saves", "",
              "CPU seconds of one run, one thread; entries of the factor of K_ss in millions.", "",
              "| harmonics | " + " | ".join(PHASES) + " | reduce | body | entries | file, MiB |",
              "|---|" + "---|" * (len(PHASES) + 4)]
    for case in result["cases"]:
        phases = " | ".join(f"{case['cpu_s'][phase]:.2f}" for phase in PHASES)
        lines.append(f"| {case['harmonics'] or 'all DOFs'} | {phases} | {case['reduce_cpu_s']:.1f} | "
                     f"{case['body_cpu_s']:.1f} | {case['factor_entries'] / 1e6:.1f} | {case['file_MiB']:.1f} |")
    if result["larger"]:
        lines += ["", "On larger meshes:", "",
                  "| DOFs | harmonics | " + " | ".join(PHASES) + " | reduce | entries | peak, MiB |",
                  "|---|---|" + "---|" * (len(PHASES) + 3)]
    for case in result["larger"]:
        phases = " | ".join(f"{case['cpu_s'][phase]:.2f}" for phase in PHASES)
        lines.append(f"| {case['dofs']} | {case['harmonics'] or 'all DOFs'} | {phases} | {case['reduce_cpu_s']:.1f} | "
                     f"{case['factor_entries'] / 1e6:.1f} | {case['peak_MiB']:.0f} |")
    lines += ["", "Harmonics couple all nodes of the ring, which fills the factor. On a small mesh this costs more than the fewer right-han"
              "d sides save. The body is always cheaper, each time that it is made."]
    return "\n".join(lines) + "\n"


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    full, *cases = result["cases"]
    f = np.array(full["frequencies_Hz"]) / 1000
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained", sharey=True)
    shown = [case for case in cases if case["harmonics"] in (3, 6, 10, 20)]
    for i, case in enumerate(shown):
        for axis, key in zip(axes, ("frequency_error", "restricted_error")):
            error = np.abs(case[key])
            axis.semilogy(f[:len(error)], np.maximum(error, 1e-12), ".", ms=5, color=f"C{i}",
                          label=f"{case['harmonics']} harmonics")
    axes[0].semilogy(f, 0.5 * np.array(full["eta2"]), "-", lw=0.8, color="0.5",
                     label="error of all DOFs, estimated")
    for axis, title in zip(axes, ("other harmonics are slaves (as built)", "other harmonics are held")):
        axis.set_title(title, fontsize=10)
        axis.set_xlabel("frequency, kHz")
        axis.grid(True, alpha=0.3)
        axis.legend(fontsize=8)
    axes[0].set_ylabel("frequency against all DOFs, relative")
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=float, default=0.009)
    parser.add_argument("--modes", type=int, default=100)
    parser.add_argument("--harmonics", type=int, nargs="+", default=[3, 6, 10, 20, 30])
    parser.add_argument("--larger", type=float, nargs="*", default=[0.0045])
    parser.add_argument("--programs", type=pathlib.Path, default=run.CHLADNI.parent)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    result = measure(arguments)
    text = table(result)
    print(text)
    if arguments.output:
        run.publish(arguments.output, "ring_harmonics", result, text)
        draw(result, arguments.output / "ring_harmonics.png")


if __name__ == "__main__":
    main()
