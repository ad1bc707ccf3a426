#!/usr/bin/python3
"""Does the automatic choice reach the error that was asked for, and what does it cost beside a choice
by hand?

usage: frontier.py [--quick] OUTPUT

Each scene is reduced and made a body with modes chosen by hand (a sweep) and by tolerance. Its error
is the largest relative distance of the body's frequencies below the range to those of the full model
under the same supports (`chladni modes`). The cost is the CPU time of the whole program. Writes
OUTPUT/end_to_end.json, .md and .png.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "reduction"))
import run  # noqa: E402

CASES = {
    "thesis disc": {"scene": "thesis_disc/scene.toml", "up_to_Hz": 8000.0, "support": "hub",
                    "hand": [20, 50, 100, 200, 300, 400, 500], "loads": "track", "dof": "z"},
    "disc with hat": {"scene": "hat_disc/scene.toml", "up_to_Hz": 4000.0, "support": "hub",
                      "hand": [20, 50, 100, 200, 300, 400], "loads": "track", "dof": "z"},
    "beam": {"scene": "beam/cantilever.toml", "up_to_Hz": 200.0, "support": "A",
             "hand": [2, 4, 6, 8, 12, 20, 40], "loads": "B", "dof": "ry"},
}
TOLERANCES = [1e-2, 1e-3, 1e-4]
MAX_COST = 2.0  # of the automatic choice, over the best choice by hand


def scene_text(case, reduce_line, keep_line):
    """The example's scene with another choice of modes, without [squeal]."""
    text = (run.ROOT / "examples" / case["scene"]).read_text().split("[squeal]")[0]
    text = re.sub(r"\[reduce\]\n.*?(?=\n\[)", f'[reduce]\nmethod = "craig-bampton"\n{reduce_line}\n', text,
                  flags=re.S)
    body = (f'[body]\nfixed = ["{case["support"]}"]\n{keep_line}\ninterface_modes = '
            f'[{{ kind = "frm", at = "{case["loads"]}", dofs = ["{case["dof"]}"], omega0 = "auto" }}]\n')
    return text[:text.index("[body]")] + body


def chladni(command, path, folder):
    done = subprocess.run([str(run.CHLADNI), command, str(path), "--output", str(folder), "--json",
                           str(folder / f"{command}.json")], env=run.ENVIRONMENT, capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"chladni {command} {path}: {done.stderr}")
    return json.loads((folder / f"{command}.json").read_text())


def place(folder, case, text):
    """Writes the scene beside its mesh."""
    source = (run.ROOT / "examples" / case["scene"]).parent
    for mesh in source.glob("*.geo"):
        (folder / mesh.name).write_bytes(mesh.read_bytes())
    path = folder / "scene.toml"
    path.write_text(text)
    return path


def reference(case):
    """Frequencies of the full model below the range, Hz, and its CPU seconds."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for count in (40, 120, 360):
            support = (f'[[support]]\ngroup = "{case["support"]}"\ntype = "clamped"\n'
                       f"[modes]\ncount = {count}\n")
            path = place(folder, case, scene_text(case, "modes = 5", "keep = { modes = 2 }") + support)
            found = chladni("modes", path, folder)
            if found["frequencies_Hz"][-1] > case["up_to_Hz"]:
                break
        return {"frequencies_Hz": found["frequencies_Hz"], "cpu_s": found["cpu_s"],
                "dofs": found["n_dofs"]}


def measure(case, full, reduce_line, keep_line):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        summary = chladni("run", place(folder, case, scene_text(case, reduce_line, keep_line)), folder)
        with h5py.File(next(folder.glob("*.body.h5"))) as file:
            f = file["modes/frequencies"][...] / (2.0 * np.pi)
            kinds = [kind.decode() if isinstance(kind, bytes) else str(kind)
                     for kind in np.ravel(file["modes/kinds"][...])]
    exact = np.array(full["frequencies_Hz"])
    own = np.array([x for x, kind in zip(f, kinds) if kind == "constrained"])
    # Each frequency of the body against the one of its rank, where no mode was left out before it;
    # a selection by tolerance may leave some out, hence the nearest.
    errors = [float(np.min(np.abs(x / exact - 1.0))) for x in own if x <= case["up_to_Hz"]]
    return {"fixed_interface_modes": summary["n_modes"], "size": len(f), "compared": len(errors),
            "error": max(errors), "cpu_s": summary["cpu_s"], "wall_s": summary["wall_s"]}


def study(name, case, tolerances):
    full = reference(case)
    keep = f'keep = {{ up_to_Hz = {case["up_to_Hz"]} }}'
    hand = [{"modes": n, **measure(case, full, f"modes = {n}", keep)} for n in case["hand"]]
    chosen = []
    for tolerance in tolerances:
        asked = f'tolerance = {tolerance}\nup_to_Hz = {case["up_to_Hz"]}'
        kept = f'keep = {{ tolerance = {tolerance}, up_to_Hz = {case["up_to_Hz"]} }}'
        found = measure(case, full, asked, kept)
        enough = [h["cpu_s"] for h in hand if h["error"] <= tolerance]
        found.update(tolerance=tolerance, keeps_promise=found["error"] <= tolerance,
                     cost_over_best_by_hand=found["cpu_s"] / min(enough) if enough else None)
        chosen.append(found)
    return {"case": name, "up_to_Hz": case["up_to_Hz"], "dofs": full["dofs"],
            "full_cpu_s": full["cpu_s"], "by_hand": hand, "by_tolerance": chosen}


def table(result):
    lines = ["# End to end: tolerance asked, error reached, time spent", "",
             "Error: the largest relative distance of the body's frequencies below the range to those of "
             "the full model under the same supports. Cost: CPU seconds of the whole program, from the "
             "mesh to the body. Written by `benchmarks/end_to_end/frontier.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}.", "",
             "![Speed against error of the whole program](figures/end_to_end.png)", "",
             "| scene | DOFs | up to, Hz | tolerance asked | error reached | modes of the reduction | "
             "coordinates of the body | CPU s | over the best by hand | |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for study_ in result["studies"]:
        for c in study_["by_tolerance"]:
            cost = c["cost_over_best_by_hand"]
            good = c["keeps_promise"] and cost is not None and cost <= MAX_COST
            lines.append(
                f"| {study_['case']} | {study_['dofs']} | {study_['up_to_Hz']:g} | "
                f"{c['tolerance']:g} | {c['error']:.1e} | {c['fixed_interface_modes']} | {c['size']} | "
                f"{c['cpu_s']:.1f} | {'none by hand' if cost is None else f'{cost:.2f}'} | "
                f"{'holds' if good else '**does not hold**'} |")
    lines += ["", "## Choices by hand", "", "| scene | modes | error | CPU s |", "|---|---|---|---|"]
    for study_ in result["studies"]:
        lines += [f"| {study_['case']} | {h['modes']} | {h['error']:.1e} | {h['cpu_s']:.1f} |"
                  for h in study_["by_hand"]]
    return "\n".join(lines) + "\n"


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter
    figure, axes = plt.subplots(1, len(result["studies"]), figsize=(4.4 * len(result["studies"]), 4.0),
                                layout="constrained", squeeze=False)
    for axis, study_ in zip(axes[0], result["studies"]):
        hand, chosen = study_["by_hand"], study_["by_tolerance"]
        axis.loglog([h["cpu_s"] for h in hand], [h["error"] for h in hand], "o-", color="0.45",
                    label="modes by hand")
        for h in hand:
            axis.annotate(f" {h['modes']}", (h["cpu_s"], h["error"]), fontsize=7, color="0.45")
        axis.loglog([c["cpu_s"] for c in chosen], [c["error"] for c in chosen], "s", color="#b2182b",
                    label="by tolerance")
        for c in chosen:
            axis.plot([c["cpu_s"]] * 2, [c["error"], c["tolerance"]], color="#b2182b", linewidth=0.8)
            axis.plot(c["cpu_s"], c["tolerance"], "_", color="#b2182b", markersize=10)
        axis.set_title(f"{study_['case']}, to {study_['up_to_Hz']:g} Hz", fontsize=10)
        axis.set_xlabel("CPU time of the whole program, s")
        costs = [c["cpu_s"] for c in hand + chosen]
        axis.set_xlim(0.7 * min(costs), max(1.4 * max(costs), 3.0 * min(costs)))  # noise stays small
        axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.grid(True, which="both", alpha=0.25)
    axes[0][0].set_ylabel("relative error of the frequencies")
    axes[0][-1].legend(fontsize=8)
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="the beam alone")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    names = ["beam"] if arguments.quick else list(CASES)
    result = {"machine": run.machine(),
              "studies": [study(name, CASES[name], TOLERANCES) for name in names]}
    (arguments.output / "figures").mkdir(parents=True, exist_ok=True)
    (arguments.output / "end_to_end.json").write_text(json.dumps(result, indent=1))
    (arguments.output / "end_to_end.md").write_text(table(result))
    draw(result, arguments.output / "figures" / "end_to_end.png")
    print(table(result))


if __name__ == "__main__":
    main()
