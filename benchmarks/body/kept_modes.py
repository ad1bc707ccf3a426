"""Error of displacement, moment and shear force over the number of modes of a body, without and with an interface mode.

Two beams of the examples and a plate strip under a harmonic unit load of Omega = 3 omega_1, where omega_1 is the first elastic
frequency of the free body. Besides the lowest n_h modes of the held body there is no interface mode, or one for the load: an
inertia-relief mode (IRM: Omega_0 = 0) or a frequency-response mode (FRM) at some Omega_0 / omega_1. Errors are those against the
FE model.
"""

import h5py
import numpy as np

import beam as beam_example  # examples/beam
import study as beam_study
from cases import CHLADNI, ROOT, only, run

COUNTS = (1, 2, 3, 4, 5, 7, 10, 15, 20, 30, 40)
RATIOS = (None, 0.0, 0.5, 1.0, 2.5)  # Omega_0 / omega_1 for each count; None: no interface mode
MORE_RATIOS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 2.9)  # with N_VARIED modes
N_VARIED = 5
LOAD_RATIO = 3.0  # Omega / omega_1
STRIP_MODES = 200  # of the reduction of the strip
FORCES = {"M": ("M_x", "M_y", "M_xy"), "Q": ("Q_x", "Q_y")}


def label(ratio):
    return "no interface mode" if ratio is None else "IRM" if ratio == 0 else f"FRM, {ratio:g} omega_1"


def choices(quick):
    """(n_h, Omega_0 / omega_1) of all bodies."""
    if quick:
        return [(n, ratio) for n in (1, 5, 40) for ratio in (None, 0.0, 0.5)]
    return sorted({(n, ratio) for n in COUNTS for ratio in RATIOS} | {(N_VARIED, ratio) for ratio in MORE_RATIOS},
                  key=lambda choice: (choice[0], -1 if choice[1] is None else choice[1]))


def row(n, ratio, errors):
    return {"n_h": n, "omega0_over_omega_1": ratio, "interface_mode": label(ratio), **{k: float(e) for k, e in errors.items()}}


def of_beams(folder, quick):
    """Rows of both beams, in the folder where study.py has reduced them."""
    found = {}
    for case in beam_example.CASES:
        exact = beam_example.full_response(case, beam_example.HIGHEST)
        rows = []
        for n, ratio in choices(quick):
            name = beam_example.body_name(n, ratio)
            if not beam_example.body_file(folder, case, name).exists():
                modes = None if ratio is None else beam_study.interface_mode(case, ratio * beam_example.OMEGA_1_FREE)
                beam_study.make_body(CHLADNI.parent, case, folder, name, {"keep": f"{{ modes = {n} }}", "interface_modes": modes})
            response = beam_example.body_response(beam_example.body_file(folder, case, name), case, beam_example.HIGHEST)
            rows.append(row(n, ratio, dict(zip("wMQ", response.errors(exact)))))
        found[case.title] = rows
    return found


def strip():
    """The strip of the tests without offset, with a finer mesh and more modes, up to its [body]."""
    text = (ROOT / "tests/data/strip.toml").read_text()
    for old, new in (("offset = 0.03\n", ""), ("poisson = 0.0", "poisson = 0.3"), ("element_size = 0.05", "element_size = 0.02"),
                     ("element_order = 2", "element_order = 3"), ("modes = 5", f"modes = {STRIP_MODES}")):
        assert text.count(old) == 1
        text = text.replace(old, new)
    return text[:text.index("[body]")]


def harmonic(path, Omega):
    """Displacement and rotations of R, and each kind of section force, for a unit harmonic force there along z."""
    with h5py.File(path) as file:
        X, omega = file["modes/attachment_displacements"][:], file["modes/frequencies"][:]
        kinds = list(file["resultants/plate/kinds"].asstr()[:])
        q = X[8] / (omega**2 - Omega**2)
        forces = (file["resultants/plate/modes"][:] @ q).reshape(-1, len(kinds))
    return {"w": X[8:9] @ q, **{name: forces[:, [kinds.index(k) for k in some]] for name, some in FORCES.items()}}


def strip_body(n, Omega_0=None):
    mode = "" if Omega_0 is None else ("interface_modes = [{ " + (
        'kind = "irm"' if Omega_0 == 0 else f'kind = "frm", omega0 = {Omega_0!r}') + ', at = "R", dofs = ["z"] }]\n')
    return f'[body]\nfixed = ["L"]\nkeep = {{ modes = {n} }}\n{mode}'


def made(command, folder, text):
    """The summary of a run that must succeed."""
    summary = run(command, folder, text)
    if isinstance(summary, str):
        raise RuntimeError(summary)
    return summary


def of_strip(folder, quick):
    """Rows of the strip; the reference is a reduced system that answers at Omega as the FE model (`space = "full"`)."""
    scene = strip()
    made("run", folder, scene + strip_body(1))
    with h5py.File(only(folder, "*.body.h5")) as file:
        omega_1 = float(file["free_body/frequencies"][int(file["free_body/rigid_modes"][()])])
    Omega = LOAD_RATIO * omega_1
    whole = '[body]\nfixed = ["L"]\nkeep = { up_to_Hz = 1e12 }\n'
    made("reduce", folder / "whole", scene + strip_body(1, Omega).replace(" }]", ', space = "full" }]'))
    made("body", folder / "whole", scene + whole)
    exact = harmonic(only(folder / "whole", "*.body.h5"), Omega)

    def errors():
        found = harmonic(only(folder, "*.body.h5"), Omega)
        return {kind: np.linalg.norm(found[kind] - exact[kind]) / np.linalg.norm(exact[kind]) for kind in exact}

    rows = []
    for n, ratio in choices(quick):
        made("body", folder, scene + strip_body(n, None if ratio is None else ratio * omega_1))
        rows.append(row(n, ratio, errors()))
    made("body", folder, scene + whole)
    return {"plate strip, force at its end": rows}, {k: float(e) for k, e in errors().items()}


def kept_modes(beams, folder, quick):
    strip_rows, strip_floor = of_strip(folder, quick)
    return {"models": {**of_beams(beams, quick), **strip_rows}, "all_modes_of_the_strip": strip_floor}


def figure(models, path):
    """A column for each model, a row for each quantity; errors over the number of modes."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    styles = dict(zip(RATIOS, (("0.35", "o"), ("#e08214", "o"), ("#2166ac", "s"), ("#1b7837", "D"), ("#b2182b", "^"))))
    plots, axes = plt.subplots(3, len(models), figsize=(4.2 * len(models), 8.6), layout="constrained", sharex=True, sharey="row")
    for column, (name, rows) in zip(axes.T, models.items()):
        for axis, quantity in zip(column, "wMQ"):
            for ratio, (colour, marker) in styles.items():
                own = [r for r in rows if r["omega0_over_omega_1"] == ratio]
                size, fill = (9, "none") if ratio == 0 else (4, colour)  # IRM is close to FRM: a ring about its points
                axis.loglog([r["n_h"] for r in own], [r[quantity] for r in own], marker + "-", color=colour, markersize=size,
                            markerfacecolor=fill, linewidth=1, label=label(ratio).replace("omega_1", r"$\omega_1$"))
            axis.grid(True, which="major", alpha=0.3)
        column[0].set_title(name, fontsize=10)
        column[-1].set_xticks(COUNTS[:5:2] + COUNTS[6::2], [str(n) for n in COUNTS[:5:2] + COUNTS[6::2]])
        column[-1].set_xlabel("modes kept, $n_h$")
        column[-1].minorticks_off()
    for axis, quantity in zip(axes[:, 0], ("displacement", "bending moment", "shear force")):
        axis.set_ylabel(f"relative error, {quantity}")
    axes[0][0].legend(fontsize=8)
    plots.savefig(path, dpi=110)
    plt.close(plots)


def frequency_figure(models, path):
    """Errors of N_VARIED modes and one interface mode over its Omega_0."""
    import matplotlib.pyplot as plt
    plots, axes = plt.subplots(1, len(models), figsize=(4.2 * len(models), 3.4), layout="constrained", sharey=True)
    for axis, (name, rows) in zip(axes, models.items()):
        own = [r for r in rows if r["n_h"] == N_VARIED]
        without = next(r for r in own if r["omega0_over_omega_1"] is None)
        own = [r for r in own if r["omega0_over_omega_1"] is not None]
        for quantity, colour, title in zip("wMQ", ("#2166ac", "#1b7837", "#b2182b"), ("displacement", "moment", "shear force")):
            axis.semilogy([r["omega0_over_omega_1"] for r in own], [r[quantity] for r in own], "o-", color=colour, markersize=4,
                          linewidth=1, label=title)
            axis.axhline(without[quantity], color=colour, linestyle=":", linewidth=1)
        axis.set_title(name, fontsize=10)
        axis.set_xlabel(r"$\Omega_0 / \omega_1$ (0: IRM; load at 3)")
        axis.grid(True, which="major", alpha=0.3)
    axes[0].set_ylabel("relative error")
    axes[0].legend(fontsize=8)
    plots.savefig(path, dpi=110)
    plt.close(plots)


def cells(rows):
    """One row for each number of modes, w / M / Q for each kind of interface mode."""
    ratios = sorted({r["omega0_over_omega_1"] for r in rows if r["n_h"] == 1}, key=lambda x: -1 if x is None else x)
    for n in sorted({r["n_h"] for r in rows}):
        own = {r["omega0_over_omega_1"]: r for r in rows if r["n_h"] == n}
        yield {"n_h": n, **{label(ratio): " / ".join(f"{own[ratio][q]:.1e}" for q in "wMQ") for ratio in ratios}}


def varied(models):
    """One row for each Omega_0 with N_VARIED modes, w / M / Q for each model."""
    ratios = [r["omega0_over_omega_1"] for r in next(iter(models.values())) if r["n_h"] == N_VARIED]
    for ratio in ratios:
        own = {name: next(r for r in rows if (r["n_h"], r["omega0_over_omega_1"]) == (N_VARIED, ratio))
               for name, rows in models.items()}
        yield {"interface mode": label(ratio), **{name: " / ".join(f"{r[q]:.1e}" for q in "wMQ") for name, r in own.items()}}


def section(found, table):
    """Of the page; `table` makes one of rows and columns."""
    models = found["models"]
    floor = " / ".join(f"{e:.1e}" for e in found["all_modes_of_the_strip"].values())
    lines = [f"""## How many modes, and which interface mode

Relative errors of displacement, bending moment and shear force (`w / M / Q`) against the FE model, with the lowest `n_h` modes of the held
body and one interface mode for the load, or none. The load is harmonic, at {LOAD_RATIO:g} `omega_1`; `omega_1` is the first elastic
frequency of the free body. **IRM** is an inertia-relief mode, that is `Omega_0 = 0`; **FRM, x omega_1** a frequency-response mode at
`Omega_0 = x omega_1`. Beams: L2 norms over the length, from one mode to {COUNTS[-1]} of 104. Strip: a plate of steel, clamped at one end, a force at
the other one's middle; w is the displacement there, M and Q are all section forces at all Gauss points. Its `n_h` counts modes in the plane and
of torsion too, which this force does not excite, so an error may stay where it is from one `n_h` to the next; all its {STRIP_MODES + 6} modes
leave {floor}, which is the reduction's share: no body made of it is better.

Where so few modes are kept that a neglected frequency lies below the load's, an interface mode need not help, and may harm. The shear force
of the cantilever does not converge with modes alone: their moments are continuous at B, where that of the load jumps.

![errors over the number of modes](figures/body_modes.png)
"""]
    for name, rows in models.items():
        own = list(cells(rows))
        lines += [f"{name[0].upper()}{name[1:]}:", "", table(own, list(own[0]))]
    own = list(varied(models))
    lines += [f"""With {N_VARIED} modes, over `Omega_0` (dotted: no interface mode):

![errors over Omega_0](figures/body_omega0.png)
""", table(own, list(own[0]))]
    return "\n".join(lines)
