#!/usr/bin/python3
"""Compares the runs of element_convergence with the exact frequencies and draws them.

usage: report.py EXACT.json RUNS.jsonl ASSEMBLY.jsonl OUTPUT_FOLDER
Writes elements.json, elements.md and figures/element_convergence.png.
"""
import json
import os
import sys
from collections import defaultdict

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ELEMENTS = ["order 1", "order 2", "order 3", "S8R"]
RATIOS = ["8.1", "100", "1000", "10000"]


def read_lines(path):
    with open(path) as file:
        return [json.loads(line) for line in file if line.startswith("{")]


def errors_of(run, exact):
    """Relative errors of n = 0 ... 8 without nodal circle, and the rms over the first 31 modes."""
    computed = defaultdict(list)
    for n, f in zip(run["n"], run["f_Hz"]):
        computed[n].append(f)
    lookup = lambda n, k: computed[n][k] if k < len(computed[n]) else np.inf
    by_n = [lookup(n, 0) / exact[n][0] - 1 for n in range(9)]
    modes = sorted((f, n, m * (2 if n else 1) + twin) for n, row in enumerate(exact)
                   for m, f in enumerate(row) for twin in range(2 if n else 1))[:31]
    all_31 = [lookup(n, k) / f - 1 for f, n, k in modes]
    return by_n, float(np.sqrt(np.mean(np.square(all_31))))


def add_errors(runs, exact):
    for run in runs:
        by_n, rms = errors_of(run, exact[f"{run['ratio']:g}"])
        run["error"] = by_n
        run["rms_0_to_8"] = float(np.sqrt(np.mean(np.square(by_n))))
        run["rms_31"] = rms


def series(runs, ratio, mesh, element):
    own = [r for r in runs if f"{r['ratio']:g}" == ratio and (r["mesh"], r["element"]) == (mesh, element)]
    return sorted(own, key=lambda r: r["n_dofs"])


def fewest_dofs(own, value, limit):
    """The fewest DOFs from which on every finer mesh keeps within the limit, too."""
    fewest = None
    for run in reversed(own):
        if not abs(value(run)) <= limit:
            break
        fewest = run["n_dofs"]
    return fewest


def loss(runs, ratio, element):
    """Error on Gmsh's meshes over that on polar grids of the same DOFs, geometric mean."""
    structured, unstructured = ([r for r in series(runs, ratio, m, element) if np.isfinite(r["rms_0_to_8"])]
                                for m in ("structured", "unstructured"))
    x = [np.log(r["n_dofs"]) for r in structured]
    y = [np.log(r["rms_0_to_8"]) for r in structured]
    inside = [r for r in unstructured if x[0] <= np.log(r["n_dofs"]) <= x[-1]]
    quotients = [np.log(r["rms_0_to_8"]) - np.interp(np.log(r["n_dofs"]), x, y) for r in inside]
    return float(np.exp(np.mean(quotients)))


def draw(runs, path):
    figure, axes = plt.subplots(2, 4, figsize=(15, 7), sharey=True)
    for column, ratio in enumerate(RATIOS):
        for element, colour in zip(ELEMENTS, ["tab:green", "tab:blue", "tab:red", "black"]):
            for mesh, line in (("structured", "--"), ("unstructured", "-")):
                own = series(runs, ratio, mesh, element)
                error = [r["rms_0_to_8"] for r in own]
                style = {"color": colour, "linestyle": line, "marker": ".", "markersize": 4}
                label = f"{element}, {'Gmsh' if mesh == 'unstructured' else 'polar grid'}"
                axes[0, column].loglog([r["n_dofs"] for r in own], error, label=label, **style)
                axes[1, column].loglog([r["assembly_s"] + r["modes_s"] for r in own], error, **style)
        axes[0, column].set_title(f"$r_a/h$ = {ratio}")
        axes[0, column].set_xlabel("DOFs, three each node")
        axes[1, column].set_xlabel("CPU time, s")
    for row in axes:
        row[0].set_ylabel("rms error of f, n = 0 ... 8")
        for axis in row:
            axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def table(head, rows):
    return "\n".join(["| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows]])


def number(x):
    return "not reached" if x is None else f"{x:,}"


def at_5000(runs, ratio, element):
    """n = 3 error of the unstructured mesh with the most DOFs up to 5,500."""
    own = [r for r in series(runs, ratio, "unstructured", element) if r["n_dofs"] <= 5500]
    return f"{own[-1]['error'][3]:.1e} @{own[-1]['n_dofs']:,}"


def write_text(runs, assembly, path):
    n_3 = lambda run: run["error"][3]
    rms = lambda run: run["rms_31"]
    limits = [[e, m, number(fewest_dofs(series(runs, "8.1", m, e), n_3, 2.4e-5)),
               number(fewest_dofs(series(runs, "8.1", m, e), rms, 1e-4))]
              for e in ELEMENTS for m in ("structured", "unstructured")]
    text = f"""# Elements: accuracy and cost

Written by `benchmarks/elements/report.py`. The annular plate of the example (clamped inside, free outside, flexure alone) against
its exact Reissner-Mindlin frequencies (`benchmarks/elements/exact_annulus.py`); D and the mass per area stay the same for every
thickness. DOFs are those of flexure, three at each free node; a shell has six. S8R is the 8-node serendipity element with 2 x 2
points, written for the comparison (`benchmarks/elements/serendipity.cpp`). Structured: polar grids; unstructured: Gmsh's meshes.

![Error over DOFs and over CPU time](figures/element_convergence.png)

## DOFs for a given accuracy, r_a/h = 8.1

The fewest DOFs from which on all finer meshes of the sweep keep the limit.

{table(["element", "mesh", "n = 3 within 2.4e-5", "first 31 modes, rms below 1e-4"], limits)}

## Error of n = 3 near 5,000 DOFs on unstructured meshes

{table(["element", *[f"r_a/h = {r}" for r in RATIOS]], [[e, *[at_5000(runs, r, e) for r in RATIOS]] for e in ELEMENTS])}

## Unstructured over structured

Factor of the rms error of n = 0 ... 8 at the same DOFs, mean over the sweep.

{table(["element", *[f"r_a/h = {r}" for r in RATIOS]], [[e, *[f"{loss(runs, r, e):.1f}" for r in RATIOS]] for e in ELEMENTS])}

## Assembly

CPU time of the slowest rank for K and M, against one factorisation of K by MUMPS and one of our own; memory that the program grew by in the assembly,
for each nonzero of K and M: its peak, since the allocator keeps what is freed for later.

{table(["order", "ranks", "DOFs", "assembly, s", "MUMPS, s", "share", "own, s", "share", "DOFs/s", "bytes per nonzero"],
       [[str(a["order"]), str(a["ranks"]), f"{a['n_dofs']:,}", f"{a['assembly_s']:.2f}",
         *(cell for name in ("mumps_s", "supernodal_s") for cell in (f"{a[name]:.2f}", f"{100 * a['assembly_s'] / a[name]:.0f} %")),
         f"{a['dofs_per_s']:,.0f}", f"{a['bytes_per_nonzero']:.1f}"] for a in assembly])}
"""
    with open(path, "w") as file:
        file.write(text)


def main():
    exact_path, runs_path, assembly_path, folder = sys.argv[1:5]
    with open(exact_path) as file:
        exact = json.load(file)["f_Hz[r_a/h][n][m]"]
    runs, assembly = read_lines(runs_path), read_lines(assembly_path)
    add_errors(runs, exact)
    os.makedirs(os.path.join(folder, "figures"), exist_ok=True)
    draw(runs, os.path.join(folder, "figures", "element_convergence.png"))
    write_text(runs, assembly, os.path.join(folder, "elements.md"))
    # JSON has no infinity: a number of diameters that a run does not show has no error.
    finite = lambda v: [finite(x) for x in v] if isinstance(v, list) else None if v == np.inf else v
    kept = [{k: finite(v) for k, v in r.items() if k not in ("n", "f_Hz")} for r in runs]
    with open(os.path.join(folder, "elements.json"), "w") as file:
        json.dump({"convergence": kept, "assembly": assembly}, file, indent=0, allow_nan=False)


main()
