"""Draws speed against error of the integrators and writes it down.

Usage: report.py RESULT.json DOCS_DIR

Writes DOCS_DIR/squeal_benchmarks.md and DOCS_DIR/figures/squeal_work_precision.png, and a copy of the
results beside the figure.
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {
    "splitting": "#2166ac", "exponential": "#b2182b", "dormand-prince": "#1b7837",
    "generalised-alpha": "#762a83", "cvode-adams": "#999999", "cvode-bdf": "#555555",
}  # fmt: skip
HEAD = """# Squeal: speed against error

Written by `benchmarks/squeal/report.py` from the results of `squeal_work_precision`. Times are processor
times of all threads on the machine that ran it, and compare only with each other; they include the set-up, which is about 1 ms
for `exponential` with 35 modes, a third of its time in the short case below. Growth rates are fitted to the envelope, which leaves
up to 1e-4 1/s. The reference disc has 20 mm thickness and one pad pair (mu = 0.6, k = 6 MN/m, N_0 = 2 kN).

![Speed against error](figures/squeal_work_precision.png)

## Targets

| what | measured | target |
| --- | --- | --- |
"""


def draw(cases, path):
    figure, axes = plt.subplots(1, len(cases), figsize=(4 * len(cases), 3.8), layout="constrained")
    for ax, case in zip(axes, cases):
        for name in dict.fromkeys(point["integrator"] for point in case["points"]):
            points = [p for p in case["points"] if p["integrator"] == name and p["error"] < 10]
            ax.loglog(
                [p["time"] for p in points], [p["error"] for p in points],
                marker="o", markersize=3, linewidth=1.2, color=COLOURS[name], label=name,
            )  # fmt: skip
        ax.axvline(1.0, color="#dddddd", linewidth=1.0, zorder=0)
        ax.set(title=case["name"], xlabel="processor time over real time", ylabel=f"error {case['error']}")
        ax.grid(color="#eeeeee")
    axes[-1].legend(frameon=False, fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)


def target_row(target):
    limit = target["target"]
    wanted = "-" if limit == 0 else f"at least {limit:g}" if limit > 1 and target["unit"] == "1" else f"below {limit:g}"
    unit = "" if target["unit"] == "1" else " " + target["unit"]
    return f"| {target['name']} | {target['measured']:.3g}{unit} | {wanted}{unit if limit else ''} |\n"


def case_table(case):
    yield f"\n## {case['name']}\n\n"
    yield f"{case['modes']} modes, {case['duration_s']:.4g} s. The setting is the number of steps for a period of\n"
    yield "the highest mode, and a tolerance where steps are adaptive (at the growth: the growth error asked for).\n\n"
    yield f"| integrator | setting | error {case['error']} | time over real time | contact evaluations for 1 s |\n"
    yield "| --- | --- | --- | --- | --- |\n"
    for p in case["points"]:
        yield (
            f"| {p['integrator']} | {p['setting']:g} | {p['error']:.1e} | {p['time']:.2g} | "
            f"{p['evaluations']:.2g} |\n"
        )


def discrete_table(series):
    yield "\n## Growth rates by the eigenvalues of one step\n\n"
    yield "Largest error of all growth rates at 4.28 pi rad/s in 1/s, over the steps for a period of the highest mode: what `auto`\n"
    yield "chooses the steps by. `exponential` has none.\n\n"
    steps = [point[0] for point in series[0]["points"]]
    yield "| modes | integrator | " + " | ".join(str(n) for n in steps) + " |\n"
    yield "| --- | --- |" + " --- |" * len(steps) + "\n"
    for row in series:
        yield f"| {row['modes']} | {row['integrator']} | " + " | ".join(f"{e:.1e}" for _, e in row["points"]) + " |\n"


def hard_cases_table(rows):
    yield "\n## Hard cases\n\nWhat they mean and where they end is in [squeal_models.md](squeal_models.md).\n\n"
    yield "| case | setting | result | beside it |\n| --- | --- | --- | --- |\n"
    for row in rows:
        yield f"| {row['case']} | {row['setting']} | {row['result']} | {row['reference']} |\n"


def main(result, docs):
    data = json.loads(result.read_text())
    draw(data["cases"], docs / "figures" / "squeal_work_precision.png")
    text = HEAD + "".join(target_row(target) for target in data["targets"])
    text += "".join(hard_cases_table(data["hard_cases"]))
    text += "".join(discrete_table(data["discrete"]))
    for case in data["cases"]:
        text += "".join(case_table(case))
    (docs / "squeal_benchmarks.md").write_text(text)
    (docs / "figures" / "squeal_work_precision.json").write_text(result.read_text())


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
