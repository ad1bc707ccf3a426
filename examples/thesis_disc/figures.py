"""Draws the figures of a squeal study. Usage: figures.py SCENE_OUTPUT_DIR [OVERVIEW_DIR]

Reads the *.body.h5 and the *.squeal.h5 in SCENE_OUTPUT_DIR and writes PNG files beside them; the
overview, one picture of the whole path, goes to OVERVIEW_DIR if that is given.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogFormatterSciNotation, MultipleLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

UPPER, LOWER, MARK, GREY = "#b2182b", "#2166ac", "#e08214", "#666666"
plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#e4e4e4",
        "grid.linewidth": 0.6,
        "legend.frameon": False,
        "lines.linewidth": 1.4,
        "figure.constrained_layout.use": True,
    }
)


def only_file(folder, pattern):
    found = sorted(Path(folder).glob(pattern))
    if len(found) != 1:
        sys.exit(f"figures.py: {len(found)} files {pattern} in {folder}, expected one")
    return found[0]


def crest_under_the_pad(body, modes):
    """Displacements of the pair of modes, turned so that a crest is at the first node of the ring.

    The two partners of a pair have the same frequency, so that any combination of them is a mode.
    """
    ring = body["rings"][next(iter(body["rings"]))]
    weights = ring["displacement"][0, modes]
    u = body["picture/displacements"][:, modes] @ weights
    return (u / np.abs(u).max()).reshape(-1, 3)


def draw_mode(ax, body, modes):
    """The surface, displaced by a pair of modes and coloured by its transverse displacement."""
    x = body["picture/positions"][:]
    u = crest_under_the_pad(body, modes)
    cells = body["picture/cells"][:]
    size = np.abs(x).max()
    faces = Poly3DCollection((x + 0.25 * size * u)[cells], linewidths=0.15, edgecolors="#00000030")
    faces.set_facecolor(plt.cm.RdBu_r(0.5 + 0.5 * u[cells, 2].mean(axis=1)))
    faces.set_clip_on(False)
    ax.add_collection3d(faces)
    ax.set(xlim=(-size, size), ylim=(-size, size), zlim=(-0.4 * size, 0.4 * size))
    ax.set_box_aspect((1, 1, 0.4), zoom=1.45)
    ax.view_init(elev=36, azim=-68)
    ax.set_axis_off()
    first, last = modes[0] + 1, modes[-1] + 1
    frequency = body["modes/frequencies"][modes[0]] / (2 * np.pi)
    ax.set_title(f"modes {first} and {last} of the held disc, {frequency:.1f} Hz")


def eigenvalues(squeal):
    """Speeds in units of pi rad/s, growth rates in 1/s, frequencies in Hz."""
    group = squeal["eigenvalues"]
    return (
        group["speeds"][:] / np.pi,
        group["lambda_re"][:],
        group["lambda_im"][:] / (2 * np.pi),
    )


def critical_speed(squeal):
    return squeal["critical/speed"][()] / np.pi if "critical/speed" in squeal else None


def mark_critical_speed(ax, squeal, text=True):
    speed = critical_speed(squeal)
    if speed is None:
        return
    ax.axvline(speed, color=MARK, linewidth=1.0)
    if text:
        ax.annotate(
            rf"critical speed {speed:.3f}$\,\pi$",
            (speed, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(4, -2),
            textcoords="offset points",
            va="top",
            color=MARK,
        )


def draw_pair(ax, squeal, values):
    """Two curves over the speed in the colours of the higher and the lower frequency."""
    speed, _, frequency = eigenvalues(squeal)
    lower, higher = np.argsort(frequency[0])
    ax.plot(speed, values[:, higher], color=UPPER)
    ax.plot(speed, values[:, lower], color=LOWER)
    ax.xaxis.set_major_locator(MultipleLocator(4))
    ax.set_xlabel(r"rotation speed / $\pi$ in rad/s")
    return higher, lower


def name_curve(ax, name, end, colour, offset):
    ax.annotate(
        name, end, xytext=(0, offset), textcoords="offset points", color=colour,
        ha="right", va="bottom" if offset > 0 else "top",
    )  # fmt: skip


def draw_growth_rates(ax, squeal):
    speed, growth, _ = eigenvalues(squeal)
    ax.axhline(0, color=GREY, linewidth=0.8)
    mark_critical_speed(ax, squeal)
    higher, lower = draw_pair(ax, squeal, growth)
    name_curve(ax, "higher frequency", (speed[-1], growth[-1, higher]), UPPER, -10)
    name_curve(ax, "lower frequency", (speed[-1], growth[-1, lower]), LOWER, 8)
    ax.set_ylabel(r"Re $\lambda$ in 1/s")


def draw_frequencies(ax, squeal):
    mark_critical_speed(ax, squeal, text=False)
    draw_pair(ax, squeal, eigenvalues(squeal)[2])
    ax.set_ylabel(r"Im $\lambda$ / 2$\pi$ in Hz")


def draw_growth(ax, squeal):
    """Envelopes of the pad velocity at several speeds, with their growth rates."""
    cases = sorted(squeal["growth"].values(), key=lambda case: case["speed"][()])
    colours = plt.cm.viridis_r(np.linspace(0.12, 1.0, len(cases)))
    for case, colour in zip(cases, colours):
        t, v = case["envelope/t"][:], case["envelope/pad_velocity"][:]
        rate = f"{case['rate'][()]:+.3f}".replace("-", "\N{MINUS SIGN}")
        label = rf"{case['speed'][()] / np.pi:.2f}$\,\pi$,  {rate} 1/s"
        ax.semilogy(t, v, color=colour, label=label)
    ax.yaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(3, 0.5)))
    ax.set(xlabel="time in s", ylabel="envelope of the pad velocity in m/s")
    ax.legend(title="speed in rad/s, growth rate", loc="center left", bbox_to_anchor=(1.0, 0.5))


def draw_envelope(ax, squeal):
    run = squeal["transient"]
    ax.semilogy(run["envelope/t"][:], run["envelope/pad_velocity"][:], color=LOWER)
    if "t_zero_force" in run:
        t = run["t_zero_force"][()]
        ax.axvline(t, color=MARK, linewidth=1.0)
        ax.annotate(
            "a normal force\nreaches zero", (t, 0.04), xycoords=("data", "axes fraction"),
            xytext=(-4, 0), textcoords="offset points", ha="right", color=MARK,
        )  # fmt: skip
    ax.set(xlabel="time in s", ylabel="envelope of the pad velocity in m/s")
    ax.set_title(rf"speed {run['speed'][()] / np.pi:g}$\,\pi$ rad/s")


def last_periods(squeal, n):
    """Time (s, from the end), velocity (m/s) and displacement (m) of the last n periods."""
    tail = squeal["transient/tail"]
    t = tail["t"][:] - tail["t"][-1]
    recent = t >= -n / squeal["limit_cycle/frequency"][()]
    return t[recent], tail["pad_velocity"][recent], tail["pad_displacement"][recent]


def draw_limit_cycle(ax, squeal):
    t, v, _ = last_periods(squeal, 5)
    ax.plot(1e3 * t, v, color=LOWER)
    ax.set(xlabel="time from the end in ms", ylabel="pad velocity in m/s")
    ax.set_title(f"limit cycle at {squeal['limit_cycle/frequency'][()]:.2f} Hz")


def draw_phase_portrait(ax, squeal):
    _, v, z = last_periods(squeal, 40)
    ax.plot(1e3 * z, v, color=LOWER, linewidth=0.8)
    ax.set(xlabel="pad displacement in mm", ylabel="pad velocity in m/s")
    ax.set_title("phase portrait")


def draw_stability_map(ax, squeal):
    """Growth rate over the speed and the second parameter, with the border of stability."""
    group = squeal["stability_map"]
    speed, growth = group["speeds"][:] / np.pi, group["growth"][:]
    limit = np.abs(growth).max()
    colours = ax.pcolormesh(
        speed, group["values"][:], growth, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="nearest"
    )
    if growth.min() < 0 < growth.max():
        ax.contour(speed, group["values"][:], growth, levels=[0], colors="black", linewidths=1.0)
    ax.figure.colorbar(colours, ax=ax, label="largest growth rate in 1/s")
    parameter = group["parameter"].asstr()[()]
    unit = np.bytes_(group["values"].attrs["unit"]).decode()
    ax.set(xlabel=r"rotation speed / $\pi$ in rad/s")
    ax.set_ylabel(parameter if unit == "1" else f"{parameter} in {unit}")


def draw_branch(ax, squeal):
    branch = squeal["limit_cycle_branch"]
    ax.plot(branch["speeds"][:] / np.pi, branch["pad_velocity"][:], color=LOWER)
    ax.set(xlabel=r"rotation speed / $\pi$ in rad/s", ylabel="pad velocity in m/s")
    ax.set_title("limit cycles")


def save(figure, path, dpi=150):
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
    print(path)


def draw_all(body, squeal, folder):
    modes = squeal["limit_cycle/mode_numbers"][:] - 1
    figure, ax = plt.subplots(figsize=(5, 3.4), subplot_kw={"projection": "3d"})
    draw_mode(ax, body, modes)
    save(figure, folder / "mode.png")

    figure, axes = plt.subplots(2, 1, figsize=(5.5, 5.5), sharex=True)
    draw_growth_rates(axes[0], squeal)
    axes[0].set_xlabel("")
    draw_frequencies(axes[1], squeal)
    save(figure, folder / "eigenvalues.png")

    figure, ax = plt.subplots(figsize=(6.5, 3.6))
    draw_growth(ax, squeal)
    save(figure, folder / "growth.png")

    # Only of a study that asks for them.
    for name, draw in (("stability_map", draw_stability_map), ("limit_cycle_branch", draw_branch)):
        if name in squeal:
            figure, ax = plt.subplots(figsize=(5.5, 3.6))
            draw(ax, squeal)
            save(figure, folder / f"{name}.png")

    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2))
    draw_envelope(axes[0], squeal)
    draw_limit_cycle(axes[1], squeal)
    draw_phase_portrait(axes[2], squeal)
    save(figure, folder / "limit_cycle.png")


def draw_overview(body, squeal, path):
    figure = plt.figure(figsize=(10, 3.3))
    grid = figure.add_gridspec(1, 3, width_ratios=(1.15, 1, 1))
    modes = squeal["limit_cycle/mode_numbers"][:] - 1
    draw_mode(figure.add_subplot(grid[0], projection="3d"), body, modes)
    draw_growth_rates(figure.add_subplot(grid[1]), squeal)
    draw_envelope(figure.add_subplot(grid[2]), squeal)
    path.parent.mkdir(parents=True, exist_ok=True)
    save(figure, path, dpi=120)


def main(folder, overview_folder):
    with h5py.File(only_file(folder, "*.body.h5")) as body, h5py.File(
        only_file(folder, "*.squeal.h5")
    ) as squeal:
        draw_all(body, squeal, folder)
        draw_overview(body, squeal, overview_folder / "thesis_disc.png")


if __name__ == "__main__":
    folders = [Path(name) for name in sys.argv[1:]]
    main(folders[0], folders[-1])
