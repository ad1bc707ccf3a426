#!/usr/bin/python3
"""Which method is right with so many modes: Craig-Bampton or Rubin?

usage: methods.py [OUTPUT] [--quick] [--programs DIR]

The thesis disc and its beam, each with its attachment nodes held and free: frequencies of the reduced model
against those of the FE model (`chladni modes`, the same matrices), over the number of the mode, for the same
number of modes in the basis. The modes of Craig and Bampton are those of the held masters, the modes of Rubin
those of the free body. Writes OUTPUT/reduction_methods.json, .md and .png, and fails where
- a frequency of Craig-Bampton or Rubin is below that of the FE model: both are Ritz values;
- a free frequency that went into Rubin's basis does not come out.
"""
import argparse
import pathlib
import sys
import tempfile

import numpy as np

import run

METHODS = {"craig-bampton": "Craig-Bampton", "rubin": "Rubin"}
LEVELS = (1e-2, 1e-4, 1e-6)


def models(quick):
    """Scene, set that is held, its group, and numbers of modes."""
    with tempfile.TemporaryDirectory() as name:
        disc = run.scene(pathlib.Path(name), 0.03 if quick else 0.009, modes=20).read_text()
    beam = (run.ROOT / "examples/beam/cantilever.toml").read_text()
    # With 300 elements the reference itself has lost five digits of the first frequency.
    beam = beam.replace("elements = 300", "elements = 90").replace("modes = 100\n", "modes = 20\n")
    beam = beam[:beam.index("[body]")].replace('resultants = ["beam"]', "")
    disc = disc[:disc.index("[body]")].replace("nodes = 60", "nodes = 12" if quick else "nodes = 60")
    return {"disc": (disc, "hub", [20] if quick else [20, 50, 100]), "beam": (beam, "A", [10] if quick else [10, 20, 40])}


def system(folder, scene, programs):
    """K_r, M_r and the sets of the master DOFs."""
    import h5py
    (folder / "scene.toml").write_text(scene)
    run.summary(programs / "chladni", "reduce", folder / "scene.toml", folder)
    with h5py.File(next(folder.glob("*.reduced.h5"))) as file:
        sets = {name: file["attachment/sets/" + name][()] for name in file["attachment/set_names"].asstr()}
        return file["matrices/stiffness"][()], file["matrices/mass"][()], file["masters/node"][()], sets


def frequencies(K, M, n_rigid):
    """Elastic ones in Hz, of the inverse problem with a shift of the size of the first ones, or rigid motions
    would cost the digits of all others."""
    from scipy.linalg import eigh
    shift = 0.0
    if n_rigid:
        positive = M.diagonal() > 0
        shift = np.min(K.diagonal()[positive] / M.diagonal()[positive])
    mu = eigh(M, K + shift * M, eigvals_only=True)[::-1]
    squares = 1 / mu[mu > 1e-13 * mu[0]] - shift
    return np.sqrt(np.maximum(squares[n_rigid:], 0)) / (2 * np.pi)


def fe_frequencies(scene, held, count, programs):
    support = f'[[support]]\ngroup = "{held}"\ntype = "clamped"\n' if held else ""
    with tempfile.TemporaryDirectory() as name:
        path = pathlib.Path(name) / "scene.toml"
        path.write_text(scene + support + f"[modes]\ncount = {count}\n")
        return np.array(run.summary(programs / "chladni", "modes", path, pathlib.Path(name))["frequencies_Hz"])


def compare(name, model, programs):
    scene, held, numbers = model
    most = max(numbers)
    free = fe_frequencies(scene, None, most + 16, programs)
    n_rigid = 6 if name == "disc" else 2
    full = {"held": fe_frequencies(scene, held, most + 16, programs), "free": free[n_rigid:]}
    for n in numbers:
        for method in METHODS:
            text = scene.replace('"craig-bampton"', f'"{method}"').replace("modes = 20\n", f"modes = {n}\n")
            with tempfile.TemporaryDirectory() as folder:
                K, M, nodes, sets = system(pathlib.Path(folder), text, programs)
            kept = np.concatenate([~np.isin(nodes, sets[held]), np.ones(len(K) - len(nodes), bool)])
            found = {"held": frequencies(K[np.ix_(kept, kept)], M[np.ix_(kept, kept)], 0),
                     "free": frequencies(K, M, n_rigid)}
            for support, f in found.items():
                m = min(n, len(f), len(full[support]))
                error = f[:m] / full[support][:m] - 1
                yield {"model": name, "support": support, "method": method, "modes": n, "size": len(K),
                       "error": list(error)}


def faults(cases, noise):
    for case in cases:
        error = np.array(case["error"])
        where = f"{case['model']}, {case['support']}, {case['method']}, {case['modes']} modes"
        if error.min() < -noise:
            yield f"{where}: {error.min():.1e} below the FE model"
        if case["method"] == "rubin" and case["support"] == "free" and np.abs(error).max() > noise:
            yield f"{where}: a mode that went in is wrong by {np.abs(error).max():.1e}"


def good(error, level):
    """Modes from the first one on."""
    bad = np.flatnonzero(np.abs(error) > level)
    return int(bad[0]) if len(bad) else len(error)


def table(cases):
    lines = ["# Craig-Bampton or Rubin?", "",
             "Frequencies of the reduced model against those of the FE model, the thesis disc (hub held, or free) and its beam of 90 "
             "elements (cantilever, or free), for the same number of modes in the basis: fixed-interface ones, or those of the free "
             "body beside its rigid motions. How many frequencies, counted from the first, are right to 1 %, 1e-4 and 1e-6. "
             "Written by `benchmarks/reduction/methods.py`; [all errors](reduction_methods.json).", "",
             "| model | support | modes | method | size | to 1e-2 | to 1e-4 | to 1e-6 | most negative error |",
             "|---|---|---|---|---|---|---|---|---|"]
    for case in sorted(cases, key=lambda c: (c["model"], c["support"], c["modes"])):
        error = np.array(case["error"])
        counts = " | ".join(str(good(error, level)) for level in LEVELS)
        lines.append(f"| {case['model']} | {case['support']} | {case['modes']} | {METHODS[case['method']]} | {case['size']} | "
                     f"{counts} | {min(0.0, error.min()):.1e} |")
    lines += ["", "![Errors over the number of the mode](reduction_methods.png)"]
    return "\n".join(lines) + "\n"


def draw(cases, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, 2, figsize=(9, 6.5), layout="constrained", sharey=True)
    for row, name in zip(axes, ("disc", "beam")):
        for axis, support in zip(row, ("held", "free")):
            group = [c for c in cases if c["model"] == name and c["support"] == support]
            middle = sorted({c["modes"] for c in group})[len({c["modes"] for c in group}) // 2]
            for case in (c for c in group if c["modes"] == middle):
                error = np.maximum(np.abs(case["error"]), 1e-13)
                axis.semilogy(1 + np.arange(len(error)), error, ".-", lw=0.7, ms=4, label=METHODS[case["method"]])
            axis.set_title(f"{name}, {support}, {middle} modes", fontsize=10)
            axis.grid(True, alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("number of the mode")
    for axis in axes[:, 0]:
        axis.set_ylabel("relative error of the frequency")
    axes[0, 0].legend(fontsize=8)
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=pathlib.Path, default=run.CHLADNI.parent)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    cases = [case for name, model in models(arguments.quick).items()
             for case in compare(name, model, arguments.programs)]
    text = table(cases)
    print(text)
    if arguments.output:
        run.publish(arguments.output, "reduction_methods", {"cases": cases}, text)
        draw(cases, arguments.output / "reduction_methods.png")
    # The eigen-solvers of the mesh and of the small matrices leave this much of a frequency.
    sys.exit("\n".join(faults(cases, noise=1e-7)) or 0)


if __name__ == "__main__":
    main()
