"""Draws speed against error of the integrators and writes it down.

Usage: report.py RESULT.json MODES.json DOCS_DIR

RESULT.json is that of `squeal_work_precision`, MODES.json that of `modes.py`. Writes DOCS_DIR/squeal_benchmarks.md, both
as DOCS_DIR/squeal_benchmarks.json, DOCS_DIR/figures/squeal_work_precision.png with a copy of its figures beside it, and
DOCS_DIR/figures/squeal_modes.png.
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

Written by `benchmarks/squeal/report.py` from the results of `squeal_work_precision` and `modes.py`. Times are processor
times of all threads on the machine that ran it, and compare only with each other; they include the set-up, which is about 1 ms
for `exponential` with 35 modes, a third of its time in the short case below. Growth rates are fitted to the envelope, which leaves
up to 1e-4 1/s. The reference disc has 20 mm thickness and one pad pair (mu = 0.6, k = 6 MN/m, N_0 = 2 kN).

![Speed against error](figures/squeal_work_precision.png)

## Targets

| what | measured | target | |
| --- | --- | --- | --- |
"""
MODES = """
## Critical speed over the number of modes

Each row takes the lowest modes of the body of the thesis disc, one pair or single mode more than the row before (`modes.py`). It has the first speed
at which any motion is unstable, the speed at which the pair with three nodal diameters is, and the growth of this pair at 6 pi rad/s. There is no damping. Time is that of
`squeal run` in CPU seconds, for {count} speeds and the critical one. References in brackets were computed without
this code, from the closed form of the Kirchhoff plate, of which the thin disc has D and mass per area. The iron
disc of 20 mm has shear flexibility, rotary inertia and lower frequencies; its reference is the pair of the exact Mindlin plate.
Largest difference from a reference: {difference:.1e}.

![Critical speed and time over the number of modes](figures/squeal_modes.png)
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
    axes[-1].legend(frameon=False, fontsize=7, loc="lower left")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)


def target_row(target):
    limit, measured = target["target"], target["measured"]
    least = limit > 1 and target["unit"] == "1"
    wanted = "-" if limit == 0 else f"at least {limit:g}" if least else f"below {limit:g}"
    met = "" if limit == 0 else "met" if (measured >= limit if least else measured < limit) else "**missed**"
    unit = "" if target["unit"] == "1" else " " + target["unit"]
    return f"| {target['name']} | {measured:.3g}{unit} | {wanted}{unit if limit else ''} | {met} |\n"


def name_of(disc):
    return f"{1000 * disc['thickness_m']:g} mm"


def over_pi(value, reference=None):
    """A critical speed; a reference of it in brackets."""
    return ("none" if value is None else f"{value:.4f} pi") + (f" ({reference:.4f} pi)" if reference else "")


def modes_table(found):
    yield MODES.format(count=found["speeds"], difference=found["largest_difference"])
    for disc in found["discs"]:
        yield f"\n{disc['dofs']:,} DOFs, {name_of(disc)} thick; reduction and body took {disc['reduction_cpu_s']:.1f} s of CPU.\n\n"
        yield ("| modes kept | highest, Hz | first critical speed (reference) | its frequency, Hz | n = 3 critical (reference) | "
               "growth at 6 pi, 1/s | CPU, s |\n| --- | --- | --- | --- | --- | --- | --- |\n")
        for row in disc["rows"]:
            kept = f"{row['modes']}" if row["groups"] else f"{row['modes']}, n = 3 alone"
            frequency = f"{row['critical_Hz']:.1f}" if row["critical_Hz"] else "-"
            has_pair = row["branch_growth_6_pi"] is not None
            branch = over_pi(row["branch_over_pi"], row["branch_reference"]) if has_pair else "-"
            growth = f"{row['branch_growth_6_pi']:.4f}" if has_pair else "-"
            yield (f"| {kept} | {row['highest_Hz']:.1f} | {over_pi(row['critical_over_pi'], row['first_reference'])} | "
                   f"{frequency} | {branch} | {growth} | {row['cpu_s']:.2f} |\n")


def draw_modes(found, path):
    figure, (speed, time) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained", width_ratios=(2, 1))
    for disc, colour in zip(found["discs"], ("#2166ac", "#b2182b")):
        rows = [row for row in disc["rows"] if row["groups"]]
        line = lambda key: ([r["modes"] for r in rows if r[key]], [r[key] for r in rows if r[key]])
        speed.plot(*line("critical_over_pi"), "o-", ms=4, lw=1.2, color=colour, label=f"first of any, {name_of(disc)}")
        speed.plot(*line("branch_over_pi"), "s--", ms=4, lw=1.2, color=colour, label=f"n = 3, {name_of(disc)}")
        alone = disc["rows"][0]
        speed.plot(alone["modes"], alone["branch_over_pi"], "D", ms=6, color=colour, label=f"n = 3 alone, {name_of(disc)}")
        for key in ("branch_reference", "first_reference"):
            known = [r for r in disc["rows"] if r[key]]
            speed.plot([r["modes"] for r in known], [r[key] for r in known], "o", ms=11, mfc="none", mec="black",
                       label="reference" if known and key == "branch_reference" else None)
        time.plot(*line("cpu_s"), "o-", ms=4, lw=1.2, color=colour, label=name_of(disc))
    speed.set(xlabel="modes kept in the body", ylabel="critical speed / (pi rad/s)", xlim=(0, None), ylim=(3.8, 5.3))
    time.set(xlabel="modes kept in the body", ylabel="CPU time of squeal run, s", xlim=(0, None), ylim=(0, None))
    for ax in (speed, time):
        ax.grid(color="#eeeeee")
        ax.legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=120)


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
    yield "\n## Hard cases\n\nWhat they mean and where they end is in [squeal_models.md](../explanation/squeal_models.md).\n\n"
    yield "| case | setting | result | beside it |\n| --- | --- | --- | --- |\n"
    for row in rows:
        yield f"| {row['case']} | {row['setting']} | {row['result']} | {row['reference']} |\n"


def main(result, modes, docs):
    data = json.loads(result.read_text())
    data["modes"] = json.loads(modes.read_text())
    draw(data["cases"], docs / "figures" / "squeal_work_precision.png")
    draw_modes(data["modes"], docs / "figures" / "squeal_modes.png")
    text = HEAD + "".join(target_row(target) for target in data["targets"])
    text += "".join(modes_table(data["modes"]))
    text += "".join(hard_cases_table(data["hard_cases"]))
    text += "".join(discrete_table(data["discrete"]))
    for case in data["cases"]:
        text += "".join(case_table(case))
    (docs / "squeal_benchmarks.md").write_text(text)
    (docs / "squeal_benchmarks.json").write_text(json.dumps(data, indent=1))
    (docs / "figures" / "squeal_work_precision.json").write_text(result.read_text())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:4]))
