"""What does a body cost, and what do a few more modes buy? Writes OUTPUT/body_benchmarks.{json,md} and OUTPUT/figures/body_*.png.

- chain: `chladni body` on reduced systems of 106, 500 and 1500 coordinates;
- beams: the numbers and figures of the thesis beside their references;
- selection: size against error, as `chladni body --json` reports it;
- kept modes: errors of displacement, moment and shear force over the number of modes, without and with an interface mode, of beams
  and a plate strip;
- conditioning: cases that ought to be hard, each solved with its loss of digits or refused with advice.

Usage: run.py [--quick] OUTPUT     with the programs in build/release/bin; --quick leaves the largest sizes out
"""

import argparse
import json
import os
import platform
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "examples/beam"), str(ROOT / "benchmarks/end_to_end")]
import figures as beam_figures  # noqa: E402  (beside the scenes, not a package)
import report as beam_report  # noqa: E402
import responses  # noqa: E402
import study as beam_study  # noqa: E402
from cases import CHLADNI, beam, only, run  # noqa: E402
import kept_modes  # noqa: E402
from conditioning import conditioning  # noqa: E402


def chain(folder, quick):
    """CPU time of each phase and of the whole program, the least of three runs."""
    rows = []
    body = 'fixed = ["A"]\nkeep = { modes = 40 }\ninterface_modes = [{ kind = "frm", at = "B", dofs = ["ry"] }]'
    for elements, modes in [(300, 100), (600, 494), (1800, 1494)][:2 if quick else 3]:
        text = beam(elements, modes, body)
        made = run("reduce", folder / str(modes), text)
        if isinstance(made, str):
            sys.exit(made)
        runs = [run("body", folder / str(modes), text) for _ in range(3)]
        rows.append({"n_FE": made["n_masters"] + made["n_modes"],
                     **{phase: min(one["phases_cpu_s"][phase] for one in runs) for phase in ("read", "body", "write")},
                     "program": min(one["cpu_s"] for one in runs)})
    for a, b in zip(rows, rows[1:]):
        b["growth"] = float(np.log(b["body"] / a["body"]) / np.log(b["n_FE"] / a["n_FE"]))
    return rows


def thesis_beams(folder, figures):
    """The beam examples beside their references; two of their figures."""
    beam_study.main(CHLADNI.parent, folder)
    beam_figures.main(folder)
    for name in ("cantilever", "supported"):
        shutil.copy(folder / f"{name}_harmonic.png", figures / f"beam_{name}.png")
    rows = [{"figure": row.name, "computed": row.computed, "reference": row.reference,
             "ratio - 1": row.ratio() - 1, "allowed": row.within} for row in beam_report.figures(folder)]
    return {"rows": rows, "selections": [vars(one) | {"good": bool(one.is_good())} for one in beam_report.selections(folder)]}


def error_anew(folder, load, component, table):
    """Largest error of the body's responses to `component` of the set `load` over the range, without the program."""
    held = responses.read_held(only(folder, "*.reduced.h5"), table["support"], load, component)
    reduced = responses.modes(held)
    spread = np.linspace(0.01, 1, 200) * table["up_to_Hz"]
    near = np.outer((0.99, 1, 1.01), responses.frequencies_Hz(held, min(60, len(held.K)))).ravel()
    Omega = 2 * np.pi * np.concatenate([spread, near[near <= table["up_to_Hz"]]])
    columns = np.arange(len(held.loads))
    body = responses.body_modes(only(folder, "*.body.h5"), load, component)
    return responses.largest_difference(responses.responses(body, Omega, columns), responses.responses(reduced, Omega, columns))


def selection(folder):
    """Steps of the beam at its thesis accuracy, and of a disc loaded on its track."""
    found = {}
    tolerance = 'fixed = ["A"]\nkeep = { tolerance = 1e-2, up_to_Hz = 11.0 }\n' \
                'interface_modes = [{ kind = "frm", at = "B", dofs = ["ry"] }]'
    found["beam"] = run("run", folder / "beam", beam(body=tolerance))["selection"] | {"support": "A"}
    disc = (ROOT / "tests/data/coarse_disc.toml").read_text()
    disc = disc[:disc.index("[body]")].replace("modes = 20", "modes = 60")
    disc += '[body]\nfixed = ["hub"]\nkeep = { tolerance = 1e-3, up_to_Hz = 5000.0 }\n'
    found["disc"] = run("run", folder / "disc", disc)["selection"] | {"support": "hub"}
    for name, load, component in (("beam", "B", 4), ("disc", "track", 2)):
        found[name]["error_anew"] = error_anew(folder / name, load, component, found[name])
    return found


def chosen(selections):
    """What the tolerances chose: sizes that the two paths needed, error as the program has it and as computed anew."""
    for name, one in selections.items():
        alone, mixed = one["modes_only"][-1], one["with_interface_modes"][-1]
        size = lambda step: step["modes"] + step["interface_modes"]
        yield {"scene": name, "up to, Hz": one["up_to_Hz"], "tolerance": one["tolerance"], "modes alone": size(alone),
               "error, modes alone": alone["error"], "with interface modes": size(mixed),
               "error with interface modes": mixed["error"], "error of the body, computed anew": one["error_anew"]}


def figure(found, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plots, axes = plt.subplots(1, len(found), figsize=(10, 4), layout="constrained")
    for axis, (name, table) in zip(axes, found.items()):
        for key, marker, label in (("modes_only", "o-", "modes alone"),
                                   ("with_interface_modes", "s-", "with interface modes")):
            steps = table[key]
            axis.semilogy([s["modes"] + s["interface_modes"] for s in steps], [s["error"] for s in steps], marker,
                          markersize=4, label=label)
        axis.axhline(table["tolerance"], color="0.5", linestyle="--", linewidth=1, label="tolerance")
        axis.set(title=f"{name}, up to {table['up_to_Hz']:g} Hz", xlabel="size of the body",
                 ylabel="largest relative error of the responses")
        axis.grid(True, which="major", alpha=0.3)
        axis.legend()
    plots.savefig(path, dpi=110)


def number(x):
    return "" if x is None else f"{x:.3g}" if isinstance(x, float) else str(x)


def table(rows, columns):
    lines = ["| " + " | ".join(columns) + " |", "| " + " | ".join("---" for _ in columns) + " |"]
    lines += ["| " + " | ".join(number(row.get(column, "")).replace("|", "\\|").replace("\n", " ") for column in columns)
              + " |" for row in rows]
    return "\n".join(lines) + "\n"


def report(found):
    selected = list(chosen(found["selection"]))
    return f"""# Bodies: cost, size against error, hard cases

Written by `benchmarks/body/run.py` from `body_benchmarks.json`; {found['machine']}.

## The chain

CPU seconds of `chladni body` on the beam of the examples, 40 modes and one FRM, its phases and the `program` from start to end;
`growth` is the exponent of the size in the time of the phase `body`. Everything is dense: cubic growth is what there is to expect.

{table(found['chain'], ['n_FE', 'read', 'body', 'write', 'program', 'growth'])}
## The beams of the thesis

Steinbrecher (2015, section 4.3): each number of `examples/beam` beside its reference of 60 digits; w, M and Q are errors of displacement,
bending moment and shear force against the FE model under a load of three times `omega_1`, the first elastic frequency of the free beam; IRM is
an inertia-relief mode (`Omega_0 = 0`), `FRM at x omega_1` a frequency-response mode at that `Omega_0`. `allowed` is what the test `integration.beam` takes for |ratio - 1|.

![cantilever](figures/beam_cantilever.png)

![simply supported beam](figures/beam_supported.png)

{table(found['beams']['rows'], ['figure', 'computed', 'reference', 'ratio - 1', 'allowed'])}
For the accuracy of five modes and one FRM a tolerance chose:

{table(found['beams']['selections'], ['name', 'tolerance', 'error', 'size'])}
## Modes by a tolerance

Each step of the choice, its size against its error as the program has it; and the error of the body that was chosen, computed anew
from the two files on another grid of frequencies, against the complete reduced system.

![size against error](figures/body_selection.png)

{table(selected, list(selected[0]))}
{kept_modes.section(found['kept_modes'], table)}
## Hard cases

`digits_lost`: of sixteen, in the first five frequencies, against the same problem in a harmless form.

`condition` is cond(Q_dd) of the mode shifting in m and rad, `unit rows` the same with rows of unit length: units alone cost nothing,
dependent supports do.

{table(found['conditioning'], ['case', 'outcome', 'condition', 'unit rows', 'value', 'digits_lost', 'message'])}"""


def main(quick, output):
    (output / "figures").mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found = {"machine": f"{platform.machine()}, {os.cpu_count()} cores",
                 "chain": chain(folder / "chain", quick),
                 "beams": thesis_beams(folder / "beams", output / "figures"), "selection": selection(folder / "selection"),
                 "kept_modes": kept_modes.kept_modes(folder / "beams", folder / "strip", quick), "conditioning": conditioning(folder / "hard")}
    text = json.dumps(found, indent=1).replace(name, "...")
    (output / "body_benchmarks.json").write_text(text + "\n")
    found = json.loads(text)
    (output / "body_benchmarks.md").write_text(report(found))
    figure(found["selection"], output / "figures/body_selection.png")
    kept_modes.figure(found["kept_modes"]["models"], output / "figures/body_modes.png")
    kept_modes.frequency_figure(found["kept_modes"]["models"], output / "figures/body_omega0.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=Path)
    arguments = parser.parse_args()
    main(arguments.quick, arguments.output)
