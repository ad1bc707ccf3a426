"""Draws the figures of the beam example. Usage: figures.py OUT

Reads what study.py left in OUT and writes PNG files beside it, one for each figure of Steinbrecher
2015, section 4.3; the order is that of the section.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np

import beam

FULL, ONE, TWO, GREY = "#222222", "#2166ac", "#b2182b", "#666666"
plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 9,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#e4e4e4",
        "grid.linewidth": 0.6,
        "legend.frameon": False,
        "lines.linewidth": 1.2,
        "figure.constrained_layout.use": True,
    }
)


def save(figure, path):
    figure.savefig(path, dpi=130)
    plt.close(figure)
    print(path)


def draw_shapes(x, shapes, titles, columns=4):
    """Small pictures of modes, each scaled to 1."""
    n_rows = -(-shapes.shape[1] // columns)
    figure, axes = plt.subplots(
        n_rows, columns, figsize=(2.4 * columns, 1.5 * n_rows), sharex=True, sharey=True, squeeze=False
    )
    for ax, shape, title in zip(axes.flat, shapes.T, titles):
        ax.axhline(0, color=GREY, linewidth=0.6)
        ax.plot(x, shape / np.abs(shape).max(), color=ONE)
        ax.set(title=title, ylim=(-1.2, 1.2), yticks=(-1, 0, 1), xticks=(0, 1 / 3, 1))
        ax.set_xticklabels(("A", "B", "C"))
    for ax in list(axes.flat)[shapes.shape[1] :]:
        ax.set_axis_off()
    return figure


def frequencies(file):
    with h5py.File(file) as body:
        return body["modes/frequencies"][:]


def draw_support(ax, x, clamped):
    """Hatched wall, or triangle."""
    if clamped:
        ax.plot([x, x], [-0.12, 0.12], color=FULL, linewidth=2)
        for y in np.linspace(-0.12, 0.08, 6):
            ax.plot([x - 0.03, x], [y, y + 0.04], color=FULL, linewidth=0.7)
    else:
        ax.fill([x - 0.025, x + 0.025, x], [-0.1, -0.1, -0.01], facecolor="white", edgecolor=FULL)


def draw_load(ax, case):
    """Moment or force at B."""
    x = case.load_dof() // 2 / beam.N_ELEMENTS
    if case.load == "ry":
        arrow = dict(arrowstyle="->", color=TWO, linewidth=1.4, connectionstyle="arc3,rad=0.9")
        ax.annotate("", (x - 0.035, 0.06), (x - 0.035, -0.06), arrowprops=arrow)
        ax.text(x - 0.09, 0.12, r"$M \cos\,\Omega t$", color=TWO)
    else:
        ax.annotate("", (x, 0.01), (x, 0.22), arrowprops=dict(arrowstyle="->", color=TWO, linewidth=1.4))
        ax.text(x + 0.015, 0.16, r"$F \cos\,\Omega t$", color=TWO)


def draw_problems(folder):
    """The two beams with their master DOFs, from the scenes' reduced systems."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 2.2))
    for ax, case in zip(axes, beam.CASES):
        with h5py.File(folder / case.name / f"{case.name}.reduced.h5") as reduced:
            x = reduced["attachment/node_positions"][:, 0]
            masters = list(zip(reduced["masters/node"][:], reduced["masters/component"][:]))
        ax.plot([0, 1], [0, 0], color=ONE, linewidth=3)
        for dof in case.fixed:
            draw_support(ax, dof // 2 / beam.N_ELEMENTS, (dof ^ 1) in case.fixed)
        draw_load(ax, case)
        for node, name in enumerate("ABC"):
            numbers = [str(i + 1) for i, (n, _) in enumerate(masters) if n == node]
            ax.plot(x[node], 0, "o", color=FULL, markersize=4)
            ax.text(x[node] + 0.015, -0.22, f"{name}: {', '.join(numbers)}")
        ax.set(title=case.title + ": nodes and their master DOFs", xlim=(-0.1, 1.15), ylim=(-0.3, 0.3))
        ax.set_axis_off()
    save(figure, folder / "problems.png")


def draw_reduction(folder):
    case = beam.CASES[0]
    file = folder / case.name / f"{case.name}.reduced.h5"
    x, shapes = beam.modes_at_nodes(file)
    with h5py.File(file) as reduced:
        names = [f"{'w' if c == 2 else 'theta'} at {'ABC'[n]}" for n, c in
                 zip(reduced["masters/node"][:], reduced["masters/component"][:])]  # fmt: skip
        omega = reduced["fixed_interface_frequencies"][:8]
    save(draw_shapes(x, shapes[:, :6], names, columns=3), folder / "static_modes.png")
    titles = [rf"$\omega$ = {value:.2f}" for value in omega]
    save(draw_shapes(x, shapes[:, 6:14], titles), folder / "fixed_interface_modes.png")


def draw_body_modes(folder, case, name, chosen, path, titles=None):
    file = beam.body_file(folder, case, name)
    x, shapes = beam.modes_at_nodes(file)
    titles = titles or [rf"$\omega$ = {value:.3f}" for value in frequencies(file)[chosen]]
    save(draw_shapes(x, shapes[:, chosen], titles, columns=min(4, shapes[:, chosen].shape[1])), path)


def frequency_errors(folder, case):
    """Of the constrained modes against the full model, relative."""
    omega = frequencies(beam.body_file(folder, case, "all"))
    return omega / np.array(beam.REFERENCE[case.name]["omega"])[: len(omega)] - 1


def draw_frequency_errors(folder, case, path):
    error = np.abs(frequency_errors(folder, case))
    figure, ax = plt.subplots(figsize=(5, 3))
    ax.semilogy(np.arange(1, len(error) + 1), np.maximum(error, 1e-12), ".", color=ONE, markersize=4)
    ax.axhline(0.01, color=TWO, linewidth=0.8)
    ax.set(xlabel="constrained mode", ylabel="relative error of the frequency", title=case.title)
    save(figure, path)


def draw_interface_modes(folder, case, path):
    figure, axes = plt.subplots(1, len(beam.SIZES), figsize=(8, 2.6), sharey=True)
    for ax, n in zip(axes, beam.SIZES):
        for ratio, colour in zip(beam.FRM_RATIOS, plt.cm.viridis(np.linspace(0, 0.85, 4))):
            x, shapes = beam.modes_at_nodes(beam.body_file(folder, case, beam.body_name(n, ratio)))
            shape = shapes[:, -1]  # the interface mode has the highest frequency
            shape = shape / shape[np.abs(shape).argmax()]
            label = rf"$\Omega_0$ = {ratio:g} $\omega_1^e$"
            ax.plot(x, shape, color=colour, label=label)
        ax.set(title=f"{case.title}: {n} modes", xlabel="x / L")
    axes[0].legend()
    save(figure, path)


def draw_response(axes, response, colour, label, style="-"):
    ends = np.repeat(response.x, 2)[1:-1]
    axes[0].plot(response.x, response.w, style, color=colour, label=label)
    axes[1].plot(ends, response.M.ravel(), style, color=colour)
    axes[2].plot(ends, np.repeat(response.Q, 2), style, color=colour)


def draw_harmonic(folder, case, path):
    """Displacement, moment and shear: modes alone on the left, with one FRM on the right."""
    figure, axes = plt.subplots(3, 2, figsize=(9, 7), sharex=True, sharey="row")
    exact = beam.full_response(case, beam.HIGHEST)
    for column, ratio in zip(axes.T, (None, 0.5)):
        draw_response(column, exact, FULL, "full model, 602 DOFs")
        for n, colour, style in zip(beam.SIZES, (TWO, ONE), ("--", "-.")):
            file = beam.body_file(folder, case, beam.body_name(n, ratio))
            response = beam.body_response(file, case, beam.HIGHEST)
            label = f"{n} modes" + ("" if ratio is None else " and one FRM")
            draw_response(column, response, colour, label, style)
        column[0].legend()
        column[2].set_xlabel("x / L")
    for ax, label in zip(axes[:, 0], ("displacement w", "bending moment $M_y$", "shear force $Q_z$")):
        ax.set_ylabel(label)
    axes[0, 0].set_title(f"{case.title}, at three times the first free frequency")
    save(figure, path)


def draw_selection(folder, case, path):
    figure, ax = plt.subplots(figsize=(5, 3))
    with h5py.File(beam.body_file(folder, case, "selected")) as body:
        for name, colour in (("modes_only", TWO), ("with_interface_modes", ONE)):
            steps = body[f"selection/{name}"]
            size = steps["modes"][:] + steps["interface_modes"][:]
            ax.semilogy(size, steps["error"][:], ".-", color=colour, label=name.replace("_", " "))
        ax.axhline(body["selection/tolerance"][()], color=GREY, linewidth=0.8)
    ax.set(xlabel="size of the body", ylabel="largest error of the response", title=case.title)
    ax.legend()
    save(figure, path)


def main(folder):
    draw_problems(folder)
    draw_reduction(folder)
    first = beam.CASES[0]
    draw_body_modes(folder, first, "free", slice(0, 2), folder / "rigid_modes.png", ["rigid"] * 2)
    draw_body_modes(folder, first, "free", slice(2, 10), folder / "free_modes.png")
    for case in beam.CASES:
        stem = folder / case.name
        draw_body_modes(folder, case, "all", slice(0, 8), Path(f"{stem}_constrained_modes.png"))
        draw_frequency_errors(folder, case, Path(f"{stem}_frequency_errors.png"))
        draw_interface_modes(folder, case, Path(f"{stem}_interface_modes.png"))
        draw_harmonic(folder, case, Path(f"{stem}_harmonic.png"))
        draw_selection(folder, case, Path(f"{stem}_selection.png"))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
