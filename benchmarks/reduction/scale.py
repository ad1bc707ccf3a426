#!/usr/bin/python3
"""Time and memory of the reduction over DOFs and ranks: 366 masters, 100 modes, with certificate.

usage: scale.py [--quick] OUTPUT      (--quick leaves the disc of a million DOFs out)

Writes OUTPUT/reduction_scale.json, .md and .png. The bounds of bounds.py stand beside each phase: what one core has to
do at least, at rates that are measured in the same run.
"""
import argparse
import json
import math
import pathlib
import re
import tempfile

import bounds
import run

SIZES = {"73k": 0.009, "300k": 0.0041, "1M": 0.00225}
PHASES = ["mesh", "assembly", "partition", "factorization", "fixed-interface modes",
          "constraint modes", "projection", "error estimates", "residuals", "condition", "pictures", "write"]


def entries_of(folder, name):
    """Stored entries of K and M of a disc, of a reduction with one mode."""
    views = ("-cms_view_stiffness", "::ascii_info", "-cms_view_mass", "::ascii_info")
    found = run.reduce(folder, run.scene(folder, SIZES[name], modes=1), 1, views)
    K, M = map(int, re.findall(r"total: nonzeros=(\d+)", found["printed"]))
    return {"K_entries": K, "M_entries": M}


def measure(folder, name, ranks):
    path = run.scene(folder / name, SIZES[name])
    summary = run.reduce(folder / name, path, ranks)
    phases = summary["phases"]
    entry = {"disc": name, "ranks": ranks, "dofs": summary["n_dofs"], "phases_s": phases,
             "factor_operations": summary["factor_operations"], "factor_entries": summary["factor_entries"],
             "wall_s": summary["wall_s"], "cpu_s": summary["cpu_s"], "peak_MiB": summary["peak_MiB"], "events": summary["events"]}
    if ranks > 1:
        return entry
    sizes = {"slaves": summary["n_dofs"] - summary["n_masters"], "masters": summary["n_masters"], "modes": summary["n_modes"],
             "pairs": len(summary["eta2"]), "file_bytes": (folder / name / "disc.reduced.h5").stat().st_size, **entries_of(folder / f"{name}-entries", name)}
    return {**entry, "sizes": sizes}


def conclusions(runs):
    """Exponents, and speed-up of two ranks."""
    single = [r for r in runs if r["ranks"] == 1]
    growth = {
        f"{a['disc']} to {b['disc']}":
            math.log(b["wall_s"] / a["wall_s"]) / math.log(b["dofs"] / a["dofs"])
        for a, b in zip(single[:-1], single[1:])
    }
    first, last = single[0], single[-1]
    if first is not last:
        growth[f"{first['disc']} to {last['disc']}, whole"] = (
            math.log(last["wall_s"] / first["wall_s"]) / math.log(last["dofs"] / first["dofs"]))
    speedup = {r["disc"]: r["wall_s"] / next(q["wall_s"] for q in runs
                                             if q["disc"] == r["disc"] and q["ranks"] == 2)
               for r in single}
    return {"growth_exponent": growth, "speedup_of_two_ranks": speedup}


def bounded(runs, rate):
    """The runs on one rank with their bounds."""
    own = lambda r: {"bounds_s": bounds.phases(r, rate), "event_bounds_s": bounds.events(r, rate), "bound_MiB": bounds.memory_MiB(r)}
    return [{**r, **own(r)} if r["ranks"] == 1 else r for r in runs]


def shares(runs):
    """Tables of each phase and each event against its bound."""
    single = [r for r in runs if r["ranks"] == 1]
    names = " | ".join(f"{r['disc']}: s, bound, share" for r in single)
    lines = ["", "## Each phase against its bound", "",
             "One rank: measured seconds, the least that one core could need, and its share (1 = as fast as the bound "
             "allows). n are the slaves, m the masters, k the fixed-interface modes, p the pairs with an estimate, l the entries "
             "of the factor, V the vectors of the eigen-solve (`benchmarks/reduction/bounds.py`).", "",
             f"| phase | {names} | bound |", "|---" * (len(single) + 2) + "|"]
    cell = lambda seconds, bound: f"{seconds:.2f}, {bound:.2f}, {bound / seconds:.2f}" if bound else f"{seconds:.2f}, -, -"
    for phase, meaning in bounds.MEANING.items():
        cells = [cell(r["phases_s"].get(phase, 0.0), r["bounds_s"].get(phase)) for r in single]
        lines.append(f"| {phase} | {' | '.join(cells)} | {meaning} |")
    whole = [cell(r["wall_s"], sum(r["bounds_s"].values())) for r in single]
    lines += [f"| whole | {' | '.join(whole)} | sum of the bounds |", "",
              "Below the phases, over all of them:", "", f"| part | {names} | bound |", "|---" * (len(single) + 2) + "|"]
    for event, meaning in bounds.EVENTS.items():
        cells = [cell(r["events"][event]["wall_s"], r["event_bounds_s"][event]) for r in single]
        lines.append(f"| {event[3:]} | {' | '.join(cells)} | {meaning} |")
    memory = [f"{r['peak_MiB']:.0f}, {r['bound_MiB']:.0f}, {r['bound_MiB'] / r['peak_MiB']:.2f}" for r in single]
    names = " | ".join(f"{r['disc']}: MiB, bound, share" for r in single)
    return [*lines, "", f"| memory | {names} | bound |", "|---" * (len(single) + 2) + "|",
            f"| peak | {' | '.join(memory)} | K and M with 12 bytes an entry, the factor, and of half of n rows V, or m + k |",
            "", "![Time and memory over degrees of freedom](reduction_scale.png)"]


def table(runs, found, rate):
    lines = ["# Reduction over size and ranks", "",
             "366 masters, 100 fixed-interface modes, error estimates included; wall seconds, one "
             "thread for each rank. Written by `benchmarks/reduction/scale.py`.", "",
             f"{rate['machine']['processor']}, {rate['machine']['cores']} cores, commit "
             f"{rate['machine']['commit']}; one core: dgemm "
             f"{rate['dgemm_GFLOP_per_s']:.1f} GFLOP/s, reading memory "
             f"{rate['memory_GB_per_s']:.1f} GB/s, writing "
             f"it {rate['memory_write_GB_per_s']:.1f} GB/s, {rate['memory_fresh_GB_per_s']:.1f} GB/s where it was never touched, "
             f"a file {rate['file_GB_per_s']:.1f} GB/s.", "",
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
    return "\n".join(lines + shares(runs)) + "\n"


def draw(runs, path):
    """Time of the phases with their bounds, time of the whole, memory."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, NullLocator, StrMethodFormatter
    figure, (phases, whole, memory) = plt.subplots(1, 3, figsize=(13, 4.8), layout="constrained", width_ratios=(1.6, 1, 1))
    single, double = ([r for r in runs if r["ranks"] == n] for n in (1, 2))
    line = lambda axis, some, value, *style, **more: axis.loglog([r["dofs"] for r in some], [value(r) for r in some], *style, **more)
    for i, phase in enumerate(["assembly", "factorization", "fixed-interface modes", "constraint modes", "projection",
                               "error estimates"]):
        line(phases, single, lambda r: r["phases_s"][phase], "o-", color=f"C{i}", ms=4, label=phase)
        line(phases, single, lambda r: r["bounds_s"][phase], ":", color=f"C{i}", lw=1.2)
    phases.plot([], [], "k:", lw=1.2, label="bound of each")
    line(whole, single, lambda r: r["wall_s"], "ks-", ms=4, label="1 rank")
    line(whole, double, lambda r: r["wall_s"], "k^--", ms=4, label="2 ranks")
    line(whole, single, lambda r: sum(r["bounds_s"].values()), "k:", label="sum of the bounds, one core")
    line(memory, single, lambda r: r["peak_MiB"] / 1024, "ks-", ms=4, label="1 rank")
    line(memory, double, lambda r: r["peak_MiB"] / 1024, "k^--", ms=4, label="2 ranks, each")
    line(memory, single, lambda r: r["bound_MiB"] / 1024, "k:", label="matrices, factor, vectors")
    for axis, title, unit in ((phases, "phases, 1 rank", "wall time, s"), (whole, "whole program", "wall time, s"),
                              (memory, "peak memory", "GiB")):
        axis.set(title=title, xlabel="degrees of freedom", ylabel=unit)
        axis.grid(True, which="both", alpha=0.3)
        axis.xaxis.set_major_locator(FixedLocator([r["dofs"] for r in single]))
        axis.xaxis.set_minor_locator(NullLocator())
        axis.xaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if axis is not phases else (1,)))
        axis.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.yaxis.set_minor_formatter(NullFormatter())
        axis.legend(fontsize=8, **({"loc": "center left", "bbox_to_anchor": (1.0, 0.5)} if axis is phases else {}))
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=SIZES, help="these discs")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    names = arguments.only or [name for name in SIZES if not (arguments.quick and name == "1M")]
    with tempfile.TemporaryDirectory() as folder:
        rate = {**bounds.rates(folder), "machine": run.machine()}
        runs = [measure(pathlib.Path(folder), name, ranks) for name in names for ranks in (1, 2)]
    runs, found = bounded(runs, rate), conclusions(runs)
    arguments.output.mkdir(parents=True, exist_ok=True)
    result = {"rates": rate, "runs": runs, "conclusions": found}
    (arguments.output / "reduction_scale.json").write_text(json.dumps(result, indent=1))
    (arguments.output / "reduction_scale.md").write_text(table(runs, found, rate))
    draw(runs, arguments.output / "reduction_scale.png")
    print(table(runs, found, rate))


if __name__ == "__main__":
    main()
