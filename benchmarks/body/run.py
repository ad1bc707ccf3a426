"""What does a body cost, and what do a few more modes buy? Writes OUTPUT/body_benchmarks.{json,md} and OUTPUT/figures/body_*.png.

- chain: `chladni body` on reduced systems of 106, 500 and 1500 coordinates;
- beams: the numbers and figures of the thesis beside their references;
- selection: size against error, as `chladni body --json` reports it;
- forces: displacement, moments and shear forces of a shell with and without a frequency-response mode;
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

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples/beam"))
import figures as beam_figures  # noqa: E402  (beside the scenes, not a package)
import report as beam_report  # noqa: E402
import study as beam_study  # noqa: E402
from cases import CHLADNI, beam, only, run  # noqa: E402
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


def selection(folder):
    """Steps of the beam at its thesis accuracy, and of a disc loaded on its track."""
    found = {}
    tolerance = 'fixed = ["A"]\nkeep = { tolerance = 1e-2, up_to_Hz = 11.0 }\n' \
                'interface_modes = [{ kind = "frm", at = "B", dofs = ["ry"] }]'
    found["beam"] = run("run", folder / "beam", beam(body=tolerance))["selection"]
    disc = (ROOT / "tests/data/coarse_disc.toml").read_text()
    disc = disc[:disc.index("[body]")].replace("modes = 20", "modes = 60")
    disc += '[body]\nfixed = ["hub"]\nkeep = { tolerance = 1e-3, up_to_Hz = 5000.0 }\n'
    found["disc"] = run("run", folder / "disc", disc)["selection"]
    return found


def strip():
    """The strip of the tests without offset, with a finer mesh and more modes, up to its [body]."""
    text = (ROOT / "tests/data/strip.toml").read_text()
    for old, new in (("offset = 0.03\n", ""), ("poisson = 0.0", "poisson = 0.3"), ("element_size = 0.05", "element_size = 0.02"),
                     ("element_order = 2", "element_order = 3"), ("modes = 5", "modes = 60")):
        assert text.count(old) == 1
        text = text.replace(old, new)
    return text[:text.index("[body]")]


def harmonic(path, Omega):
    """Displacement of R along z, and each kind of section force, for a unit harmonic force there."""
    with h5py.File(path) as file:
        X, omega = file["modes/attachment_displacements"][:], file["modes/frequencies"][:]
        kinds = list(file["resultants/plate/kinds"].asstr()[:])
        q = X[8] / (omega**2 - Omega**2)
        forces = (file["resultants/plate/modes"][:] @ q).reshape(-1, len(kinds))
    return {"displacement": X[6:] @ q, "moments": forces[:, [kinds.index(k) for k in ("M_x", "M_y", "M_xy")]],
            "shear forces": forces[:, [kinds.index(k) for k in ("Q_x", "Q_y")]]}


def forces(folder):
    """Errors of the harmonic response against the complete reduced system at twice the first held frequency."""
    scene = strip()
    whole = run("run", folder, scene + '[body]\nfixed = ["L"]\nkeep = { up_to_Hz = 1e9 }\n')
    Omega = 2 * 2 * np.pi * whole["frequencies_Hz"][0]
    exact = harmonic(only(folder, "*.body.h5"), Omega)
    rows = []
    for n_h in (3, 5, 10, 20):
        for frm in (False, True):
            body = f'[body]\nfixed = ["L"]\nkeep = {{ modes = {n_h} }}\n'
            if frm:
                body += f'interface_modes = [{{ kind = "frm", at = "R", dofs = ["z"], omega0 = {0.5 * Omega} }}]\n'
            run("body", folder, scene + body)
            found = harmonic(only(folder, "*.body.h5"), Omega)
            rows.append({"n_h": n_h, "frm": int(frm), **{
                kind: float(np.linalg.norm(found[kind] - exact[kind]) / np.linalg.norm(exact[kind])) for kind in exact}})
    return rows


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
    return f"""# Bodies: cost, size against error, hard cases

Written by `benchmarks/body/run.py` from `body_benchmarks.json`; {found['machine']}.

## The chain

CPU seconds of `chladni body` on the beam of the examples, 40 modes and one FRM, its phases and the `program` from start to end;
`growth` is the exponent of the size in the time of the phase `body`. Everything is dense: cubic growth is what there is to expect.

{table(found['chain'], ['n_FE', 'read', 'body', 'write', 'program', 'growth'])}
## The beams of the thesis

Steinbrecher (2015, section 4.3): each number of `examples/beam` beside its reference of 60 digits; w, M and Q are errors of displacement,
bending moment and shear force against the FE model. `allowed` is what the test `integration.beam` takes for |ratio - 1|.

![cantilever](figures/beam_cantilever.png)

![simply supported beam](figures/beam_supported.png)

{table(found['beams']['rows'], ['figure', 'computed', 'reference', 'ratio - 1', 'allowed'])}
For the accuracy of five modes and one FRM a tolerance chose:

{table(found['beams']['selections'], ['name', 'tolerance', 'error', 'size'])}
## Modes by a tolerance

![size against error](figures/body_selection.png)

## Moments and shear forces of a shell

A strip of steel, clamped at one end, a harmonic force at the other at twice the first frequency: relative errors of all
displacements there and of all section forces, against the complete reduced system, with `n_h` modes, without and with one FRM.

{table(found['forces'], ['n_h', 'frm', 'displacement', 'moments', 'shear forces'])}
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
                 "forces": forces(folder / "forces"), "conditioning": conditioning(folder / "hard")}
    text = json.dumps(found, indent=1).replace(name, "...")
    (output / "body_benchmarks.json").write_text(text + "\n")
    found = json.loads(text)
    (output / "body_benchmarks.md").write_text(report(found))
    figure(found["selection"], output / "figures/body_selection.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=Path)
    arguments = parser.parse_args()
    main(arguments.quick, arguments.output)
