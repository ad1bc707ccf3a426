#!/usr/bin/python3
"""How wrong are the frequencies of the reduced disc, and do its certificates know?

usage: accuracy.py [--size 0.009] [--ring 60] [--modes 20 50 100 200] [--programs DIR] [OUTPUT]

For each number of fixed-interface modes, without and with masses on the ring: the frequencies of the reduced disc, clamped
at its hub, against those of the FE model of the same place in the order (`chladni modes`, the same matrices), beside the
estimated error and the bound that the certificate prints for that place. Writes OUTPUT/reduction_accuracy.json, .md and
.png, and fails where a certificate does not hold:
- every estimate of the range, lambda below half of the last fixed-interface one, is at least half of the true error (above the
  round-off of the reference); where an error is large, its estimate may let a frequency pass others, whose estimates are then too large;
- no bound is below the true error, of any mode.
"""
import argparse
import pathlib
import sys
import tempfile

import numpy as np

import run

SUPPORT = '\n[[support]]\ngroup = "hub"\ntype = "clamped"\n[modes]\ncount = COUNT\n'
MASSES = '\n[[mass]]\nat = "track"\nmass = 0.02\n'
LOWEST = 0.5


def scene(folder, arguments, modes, added, count=1):
    path = run.scene(folder, arguments.size, modes=modes)
    text = path.read_text().replace("nodes = 60", f"nodes = {arguments.ring}")
    text = text.replace(f"modes = {modes}\n", f"modes = {modes}\nsylvester = true\n")
    path.write_text(text + added + SUPPORT.replace("COUNT", str(count)))
    return path


def compare(reduced, full, disc):
    """Columns of the table of one reduction, all of frequencies by place."""
    f = np.array(reduced["certified_frequencies_Hz"])
    n = min(len(f), len(full))
    bounds = [0.5 * bound for bound in reduced["bounds"][:n]]
    return {"disc": disc, "modes": reduced["n_modes"], "cutoff_Hz": reduced["frequencies_Hz"][-1],
            "frequencies_Hz": list(f[:n]), "true_error": list(f[:n] / full[:n] - 1),
            "estimates": reduced["estimated_errors"][:n], "bounds": bounds + [None] * (n - len(bounds)),
            "expected": reduced["modes_expected"], "found": reduced["modes_found"]}


def judge(case, noise):
    """What of the claims holds, and the figures for the table."""
    error, estimates = np.array(case["true_error"]), np.array(case["estimates"])
    f = np.array(case["frequencies_Hz"])
    bounds = np.array([np.nan if b is None else b for b in case["bounds"]])
    in_range = f**2 < 0.5 * case["cutoff_Hz"]**2
    measurable = error > 20 * noise  # the reference is 5 % of it or less
    ratio = lambda chosen: estimates[chosen] / error[chosen]
    ends = lambda values: [float(values.min()), float(values.max())] if values.size else []
    effectivity = ratio(in_range & measurable)
    bounded = ~np.isnan(bounds)
    return {"in_range": int(in_range.sum()), "measurable": int((in_range & measurable).sum()),
            "largest_error": float(error[in_range].max()) if in_range.any() else 0.0,
            "effectivity": ends(effectivity), "effectivity_of_all": ends(ratio(measurable)),
            "modes": len(f), "bounded": int(bounded.sum()),
            "bounds_hold": bool(np.all(bounds[bounded] >= error[bounded] - noise)),
            "holds": bool(np.all(effectivity >= LOWEST))}


def table(result):
    lines = ["# How wrong are reduced frequencies, and does the certificate know?", "",
             f"A clamped disc of {result['dofs']} DOFs with {result['masters']} masters, and the same with a mass of 20 g at "
             "each node of the ring: frequencies of the reduced model against those of its FE model, the same matrices and the "
             "same place in the order. Range: lambda below half of that of the last fixed-interface mode. Effectivity: the "
             "estimated error that the certificate prints for a place over the true error there. Bounds: as far up as the count "
             "finds no mode missing. Written by `benchmarks/reduction/accuracy.py`, which fails where one in the range does "
             "not hold; [the figures of all modes](reduction_accuracy.json).", "",
             f"The reference itself is good to {result['noise']:.0e}: so far a reduced frequency falls "
             "below it at most. Smaller errors have no effectivity.", "",
             "| disc | fixed-interface modes | modes compared | in the range, measurable | largest error in it | effectivity in it | "
             "of all modes | modes with a bound | bounds hold |", "|---" * 9 + "|"]
    words = lambda ends: "{:.2f} to {:.2f}".format(*ends) if ends else "-"
    for case in result["cases"]:
        j = case["judgement"]
        lines.append(f"| {case['disc']} | {case['modes']} | {j['modes']} | {j['in_range']}, {j['measurable']} | "
                     f"{j['largest_error']:.1e} | {words(j['effectivity'])} | {words(j['effectivity_of_all'])} | "
                     f"{j['bounded']} | {'yes' if j['bounds_hold'] else 'NO'} |")
    lines += ["", "![Errors and estimates over the frequency](reduction_accuracy.png)"]
    return "\n".join(lines) + "\n"


def draw(result, path):
    """Above the errors, the estimates and the bounds of each reduction; below estimates over errors."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    cases = result["cases"]
    figure, axes = plt.subplots(2, len(cases), figsize=(3.4 * len(cases), 5.6), layout="constrained", sharey="row",
                                squeeze=False, height_ratios=(2, 1))
    for (above, below), case in zip(axes.T, cases):
        f, error = np.array(case["frequencies_Hz"]) / 1000, np.array(case["true_error"])
        estimates = np.array(case["estimates"])
        bounds = [np.nan if b is None else b for b in case["bounds"]]
        above.semilogy(f, bounds, "^", ms=5, mfc="none", color="0.5", label="bound")
        above.semilogy(f, np.where(error > 0, error, np.nan), "o", ms=6, mfc="none", color="C0", label="true error")
        above.semilogy(f, estimates, ".", ms=4, color="C3", label="estimate")
        known = error > 20 * result["noise"]
        below.semilogy(f[known], estimates[known] / error[known], ".", color="C3")
        below.axhline(1.0, color="0.6", lw=0.8)
        for axis in (above, below):
            axis.axvline(np.sqrt(0.5) * case["cutoff_Hz"] / 1000, color="0.6", lw=0.8, ls="--")
            axis.grid(True, alpha=0.3)
        above.set_title(f"{case['disc']}, {case['modes']} modes", fontsize=10)
        below.set_xlabel("frequency, kHz")
    lowest = min(e for case in cases for e in case["estimates"])
    axes[0, 0].set(ylabel="relative error of the frequency", ylim=(lowest / 3, 3))
    axes[1, 0].set(ylabel="estimate / true error", ylim=(0.05, 20))
    axes[0, 0].legend(fontsize=8)
    figure.savefig(path, dpi=120)


def reductions(arguments, disc, modes, added):
    """The cases of one disc."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        reduced = [run.summary(arguments.programs / "chladni", "reduce", scene(folder, arguments, n, added), folder)
                   for n in modes]
        count = max(len(r["certified_frequencies_Hz"]) for r in reduced) + 10
        full = run.summary(arguments.programs / "chladni", "modes", scene(folder, arguments, 1, added, count), folder)
    return reduced[0], [compare(r, np.array(full["frequencies_Hz"]), disc) for r in reduced]


def measure(arguments):
    first, cases = reductions(arguments, "plain", arguments.modes, "")
    cases += reductions(arguments, "with masses", arguments.modes[1:2], MASSES)[1]
    # A Ritz value is never below its eigenvalue: how far it seems so is the reference's error.
    below = -min(min(case["true_error"]) for case in cases)
    noise = max(below, 1e-13)
    for case in cases:
        case["judgement"] = judge(case, noise)
    return {"machine": run.machine(), "dofs": first["n_dofs"], "masters": first["n_masters"], "noise": noise, "cases": cases}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=float, default=0.009)
    parser.add_argument("--ring", type=int, default=60)
    parser.add_argument("--modes", type=int, nargs="+", default=[20, 50, 100, 200])
    parser.add_argument("--programs", type=pathlib.Path, default=run.CHLADNI.parent)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    result = measure(arguments)
    text = table(result)
    print(text)
    if arguments.output:
        run.publish(arguments.output, "reduction_accuracy", result, text)
        draw(result, arguments.output / "reduction_accuracy.png")
    good = [case["judgement"]["holds"] and case["judgement"]["bounds_hold"] and
            case["judgement"]["measurable"] > 0 for case in result["cases"]]
    sys.exit(0 if all(good) else "a certificate does not hold")


if __name__ == "__main__":
    main()
