#!/usr/bin/python3
"""Time and memory of the reduction over DOFs and ranks: 366 masters, 100 modes, with certificate.

usage: scale.py [--quick] OUTPUT      (--quick leaves the disc of a million DOFs out)

Writes OUTPUT/reduction_scale.json, .md and .png. The bounds are one core's measured rates: dgemm
for the operations of the factor, reading memory for the passes over the factor of block solves.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

import run

SIZES = {"73k": 0.009, "300k": 0.0041, "1M": 0.00225}
PHASES = ["mesh", "assembly", "partition", "factorization", "fixed-interface modes",
          "constraint modes", "projection", "error estimates", "residuals", "condition", "pictures", "write"]


def rates():
    """dgemm GFLOP/s and memory GB/s of one core, in a process that has one thread and the kernels
    that the program takes."""
    code = """
import numpy as np, time
a = np.random.rand(2000, 2000)
b = np.zeros(40_000_000)
def best(work):
    times = []
    for _ in range(5):
        start = time.perf_counter(); work(); times.append(time.perf_counter() - start)
    return min(times)
print(2e-9 * 2000**3 / best(lambda: a @ a), 8e-9 * b.size / best(lambda: b.sum()))
"""
    environment = dict(run.ENVIRONMENT)
    environment.setdefault("OPENBLAS_CORETYPE", "SkylakeX" if "avx512f" in open(
        "/proc/cpuinfo", encoding="ascii").read() else "Haswell")
    out = subprocess.run(["/usr/bin/python3", "-c", code], env=environment, capture_output=True,
                         text=True, check=True).stdout.split()
    return {"dgemm_GFLOP_per_s": float(out[0]), "memory_GB_per_s": float(out[1])}


def measure(folder, name, ranks):
    path = run.scene(folder / name, SIZES[name])
    summary = run.reduce(folder / name, path, ranks)
    phases = summary["phases"]
    mumps = ("-cms_pc_factor_mat_solver_type", "mumps-metis")
    by_mumps = None  # one process, one mode: for the time of its factorisation alone
    if ranks == 1:
        other = folder / f"{name}-mumps"
        by_mumps = run.reduce(other, run.scene(other, SIZES[name], modes=1), 1, mumps)
    return {"mumps_factorization_s": by_mumps and by_mumps["phases"]["factorization"],
            "disc": name, "ranks": ranks, "dofs": summary["n_dofs"], "phases_s": phases,
            "factor_operations": summary["factor_operations"],
            "factor_entries": summary["factor_entries"],
            "wall_s": summary["wall_s"], "cpu_s": summary["cpu_s"],
            "peak_MiB": summary["peak_MiB"], "events": summary["events"]}


def conclusions(runs):
    """Exponents, ratios to the factorisation, and speed-up of two ranks."""
    single = [r for r in runs if r["ranks"] == 1]
    growth = {
        f"{a['disc']} to {b['disc']}":
            math.log(b["wall_s"] / a["wall_s"]) / math.log(b["dofs"] / a["dofs"])
        for a, b in zip(single[:-1], single[1:])
    }
    first, last = single[0], single[-1]
    growth[f"{first['disc']} to {last['disc']}, whole"] = (
        math.log(last["wall_s"] / first["wall_s"]) / math.log(last["dofs"] / first["dofs"]))
    ratio = {r["disc"]: r["wall_s"] / r["phases_s"]["factorization"] for r in single}
    by_mumps = {r["disc"]: r["wall_s"] / r["mumps_factorization_s"] for r in single}
    speedup = {r["disc"]: r["wall_s"] / next(q["wall_s"] for q in runs
                                             if q["disc"] == r["disc"] and q["ranks"] == 2)
               for r in single}
    return {"growth_exponent": growth, "whole_over_factorization": ratio,
            "whole_over_factorization_by_MUMPS": by_mumps, "speedup_of_two_ranks": speedup}


def bounds(entry, rate):
    """Lower bounds of one core: operations of the factor by dgemm; one pass over the factor forward
    and one backward for each block solve."""
    factor = 1e-9 * entry["factor_operations"] / rate["dgemm_GFLOP_per_s"]
    one_pass = 16e-9 * entry["factor_entries"] / rate["memory_GB_per_s"]
    return {"factor_s": factor, "block_solve_s": one_pass}


def table(runs, found, rate):
    lines = ["# Reduction over size and ranks", "",
             "366 masters, 100 fixed-interface modes, error estimates included; wall seconds, one "
             "thread for each rank. Written by `benchmarks/reduction/scale.py`.", "",
             f"{rate['machine']['processor']}, {rate['machine']['cores']} cores, commit "
             f"{rate['machine']['commit']}; one core: dgemm "
             f"{rate['dgemm_GFLOP_per_s']:.1f} GFLOP/s, reading memory "
             f"{rate['memory_GB_per_s']:.1f} GB/s.", "",
             "| disc | ranks | DOFs | " + " | ".join(PHASES) + " | whole | peak MiB per rank |",
             "|---" * (len(PHASES) + 5) + "|"]
    for r in runs:
        cells = [f"{r['phases_s'].get(p, 0.0):.2f}" for p in PHASES]
        lines.append(f"| {r['disc']} | {r['ranks']} | {r['dofs']} | " + " | ".join(cells) +
                     f" | {r['wall_s']:.1f} | {r['peak_MiB']:.0f} |")
    lines += ["", "| figure | value |", "|---|---|"]
    for name, values in found.items():
        lines += [f"| {name.replace('_', ' ')}, {key} | {value:.2f} |"
                  for key, value in values.items()]
    lines += ["", "Share of the bound (1 = as fast as the bound allows), one rank:", "",
              "| disc | factor: dgemm rate | block solves: memory rate |", "|---|---|---|"]
    for r in runs:
        if r["ranks"] != 1:
            continue
        bound = bounds(r, rate)
        solves = r["events"]["CMSSolve"]
        lines.append(f"| {r['disc']} | {bound['factor_s'] / r['events']['CMSFactor']['wall_s']:.2f} "
                     f"| {bound['block_solve_s'] * solves['count'] / solves['wall_s']:.2f} |")
    return "\n".join(lines) + "\n"


def draw(runs, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    single = [r for r in runs if r["ranks"] == 1]
    dofs = [r["dofs"] for r in single]
    for phase in ["assembly", "factorization", "fixed-interface modes", "constraint modes",
                  "projection", "error estimates"]:
        axes.loglog(dofs, [r["phases_s"][phase] for r in single], "o-", label=phase)
    axes.loglog(dofs, [r["wall_s"] for r in single], "ks-", label="whole, 1 rank")
    double = [r for r in runs if r["ranks"] == 2]
    axes.loglog([r["dofs"] for r in double], [r["wall_s"] for r in double], "ks--",
                label="whole, 2 ranks")
    axes.set_xlabel("degrees of freedom")
    axes.set_ylabel("wall time, s")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    names = [name for name in SIZES if not (arguments.quick and name == "1M")]
    rate = {**rates(), "machine": run.machine()}
    with tempfile.TemporaryDirectory() as folder:
        runs = [measure(pathlib.Path(folder), name, ranks) for name in names for ranks in (1, 2)]
    found = conclusions(runs)
    arguments.output.mkdir(parents=True, exist_ok=True)
    result = {"rates": rate, "runs": runs, "conclusions": found}
    (arguments.output / "reduction_scale.json").write_text(json.dumps(result, indent=1))
    (arguments.output / "reduction_scale.md").write_text(table(runs, found, rate))
    draw(runs, arguments.output / "reduction_scale.png")
    print(table(runs, found, rate))


if __name__ == "__main__":
    main()
