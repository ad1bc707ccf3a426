"""Figures 5.2, 5.7 to 5.11 of the source: the flexible disc, its mesh, its eigenvalues and its motion in time.

The disc of examples/thesis_disc with the pair of modes with three nodal diameters, once as in the source's FE model and
once, for its analytical solution, a hundredth as thick with the same D and mass per area, which is a Kirchhoff plate.
"""

import sys

import h5py
import numpy as np
from matplotlib.ticker import MaxNLocator

from drawing import BLUE, GREY, ORANGE, RED, mark, plt, save
from studies import ROOT, Entry, Number, replaced, run

sys.path.insert(0, str(ROOT / "benchmarks/squeal"))
import modes  # noqa: E402

PI = np.pi
AIR = 0.85  # radius of the air, m: the cube of the source with its 1.2 m, but for its corners


def thin_disc(programs, folder, quick):
    """Eigenvalues and critical speed of the pair with Kirchhoff's mode and frequency."""
    text = modes.scene(modes.THINNER, *((0.02, 20, 2500.0) if quick else (0.009, 150, 2500.0)))
    text = replaced(text, r"speeds = \{.*", f"speeds = {{ from_rad_s = {PI!r}, to_rad_s = {20 * PI!r}, count = 96 }}")
    run(programs / "chladni", "run", folder, text)
    return {"summary": run(programs / "squeal", "run", folder), **eigenvalues(folder / "disc.squeal.h5")}


def eigenvalues(file):
    with h5py.File(file) as results:
        group = results["eigenvalues"]
        return {"speeds": (group["speeds"][:] / PI).tolist(), "growth": group["lambda_re"][:].tolist(),
                "omega": group["lambda_im"][:].tolist()}


def study(programs, folder, quick):
    """Runs both discs; the results of the thick one stay in `folder`/thick for the sound."""
    text = (ROOT / "examples/thesis_disc/scene.toml").read_text()
    text = replaced(text, r"# At 4.5, 5, 6(.|\n)*", f"inner_radius = {AIR!r}\n")  # in place of further speeds and a sound file
    if quick:
        text = replaced(text, r"element_size = .*", "element_size = 0.02")
        text = replaced(text, r"modes = 100", "modes = 40")
        text = replaced(text, r"keep = .*", "keep = { modes = 20 }")
    thick = folder / "thick"
    reduction = run(programs / "chladni", "run", thick, text)
    summary = run(programs / "squeal", "run", thick)
    return {"thin": thin_disc(programs, folder / "thin", quick), "reduction": reduction, "squeal": summary,
            "thick": eigenvalues(thick / "disc.squeal.h5"), **mesh_of(thick / "disc.body.h5")}


def mesh_of(body):
    with h5py.File(body) as file:
        ring = file["rings/track"]
        return {"vertices": len(file["picture/positions"]), "cells": len(file["picture/cells"]),
                "triangles": int(sum(len(set(cell)) == 3 for cell in file["picture/cells"][:].tolist())),
                "ring_nodes": len(ring["nodes"])}


def draw_mesh(body, path):
    figure, ax = plt.subplots(figsize=(4.2, 4.2))
    x, cells = body["picture/positions"][:], body["picture/cells"][:]
    for cell in cells:
        ring = [*cell, cell[0]]
        ax.plot(x[ring, 0], x[ring, 1], color=GREY, linewidth=0.4)
    track = body["rings/track"]
    angles, radius = track["angles"][:], track["radius"][()]
    ax.plot(radius * np.cos(angles), radius * np.sin(angles), "o", color=RED, ms=2.5)
    ax.plot([0], [0], "o", color=RED, ms=2.5)
    ax.set(aspect="equal", xlabel="x in m", ylabel="y in m")
    ax.grid(False)
    save(figure, path)


def draw_eigenvalues(found, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4))
    for name, style, label in (("thin", "-", "Kirchhoff plate"), ("thick", "--", "FE model")):
        one = found[name]
        omega, growth = np.array(one["omega"]), np.array(one["growth"])
        for colour, j in zip((RED, BLUE), np.argsort(-omega[0])):
            axes[0].plot(omega[:, j] / 1e3, growth[:, j], style, color=colour)
            axes[1].plot(one["speeds"], growth[:, j], style, color=colour, label=f"{label}, {'higher' if colour == RED else 'lower'} frequency")
            if name == "thin":
                mark(axes[0], omega[0, j] / 1e3, growth[0, j], "A")
                mark(axes[0], omega[-1, j] / 1e3, growth[-1, j], "B", (-12, 5))
            if name == "thin" and colour == RED:
                critical = found["thin"]["summary"]["critical_speed_rad_s"] / PI
                mark(axes[0], np.interp(critical, one["speeds"], omega[:, j]) / 1e3, 0.0, "C")
    for ax in axes:
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.set_ylabel("real part in 1/s")
    axes[0].set_xlabel("imaginary part in 1000/s")
    axes[0].xaxis.set_major_locator(MaxNLocator(6))
    axes[1].set_xlabel(r"$\Omega_0 / \pi$ in rad/s")
    axes[1].legend()
    save(figure, path)


def draw_growth(squeal, path):
    cases = sorted(squeal["growth"].values(), key=lambda case: case["speed"][()])
    figure, axes = plt.subplots(2, 3, figsize=(9, 4.6))
    for ax, case in zip(axes.flat, cases):
        t, v = case["envelope/t"][:], case["envelope/pad_velocity"][:]
        ax.plot(t, 1e3 * v, color=BLUE)
        ax.set(title=rf"{case['speed'][()] / PI:.1f}$\,\pi$ rad/s, {case['rate'][()]:+.3f} 1/s", ylim=(0, None))
    for ax in axes[1]:
        ax.set_xlabel("time in s")
    for ax in axes[:, 0]:
        ax.set_ylabel("pad velocity in mm/s")
    save(figure, path)


def draw_transient(squeal, path):
    run, cycle = squeal["transient"], squeal["limit_cycle"]
    figure, axes = plt.subplots(1, 3, figsize=(9.5, 3.2))
    t, v = run["history/t"][:], run["history/pad_velocity"][:]
    some = (t > 1.0) & (t < 1.02)
    axes[0].plot(t[some], 1e3 * v[some], color=GREY, linewidth=0.6)
    te, ve = run["envelope/t"][:], run["envelope/pad_velocity"][:]
    near = (te > 0.999) & (te < 1.021)
    axes[0].plot(te[near], 1e3 * ve[near], color=BLUE, linewidth=2)
    axes[0].set(title="vibration and envelope (5.9)", xlabel="time in s", ylabel="pad velocity in mm/s")
    axes[1].plot(te, ve, color=BLUE)
    axes[1].axvline(cycle["t_99"][()], color=ORANGE, linewidth=0.9)
    axes[1].set(title="envelope (5.11a)", xlabel="time in s", ylabel="pad velocity in m/s")
    tail = run["tail"]
    last = tail["t"][:] - tail["t"][-1]
    some = last > -5 / cycle["frequency"][()]
    axes[2].plot(1e3 * last[some], tail["pad_velocity"][:][some], color=BLUE)
    axes[2].set(title="limit cycle (5.11b)", xlabel="time from the end in ms", ylabel="pad velocity in m/s")
    save(figure, path)


def growth_numbers(found):
    """The largest speed at which a simulation decays, and the smallest at which it grows, over pi."""
    rates = [(case["speed_rad_s"] / PI, case["measured_growth_1_s"]) for case in found["squeal"]["growth"]]
    return max(s for s, rate in rates if rate < 0), min(s for s, rate in rates if rate > 0)


def entries(found, folder, figures):
    thick = folder / "thick"
    with h5py.File(thick / "disc.body.h5") as body, h5py.File(thick / "disc.squeal.h5") as squeal:
        draw_mesh(body, figures / "source_5_8.png")
        draw_growth(squeal, figures / "source_5_10.png")
        draw_transient(squeal, figures / "source_5_11.png")
        settled, cycle_Hz = float(squeal["limit_cycle/t_99"][()]), float(squeal["limit_cycle/frequency"][()])
    draw_eigenvalues(found, figures / "source_5_2.png")
    thin = found["thin"]["summary"]["critical_speed_rad_s"] / PI
    critical = found["squeal"]["critical_speed_rad_s"] / PI
    decays, grows = growth_numbers(found)
    yield Entry(
        "5.2, table 5.1", "Eigenvalues of the flexible disc", ("source_5_2.png",),
        "A at pi, B at 20 pi, C where the motion becomes unstable. The analytical solution of the source takes Kirchhoff's mode and frequency; the FE model, with "
        f"shear flexibility and the Coriolis forces of the rotary inertia, is unstable from {critical:.4f} pi.",
        (Number("critical speed over pi, Kirchhoff plate", "rad/s", 4.269, thin),))
    yield Entry(
        "5.7, 5.8", "Mesh of the disc and its masters", ("source_5_8.png",),
        f"The source takes elements of order 2, we take order 3 with {found['reduction']['n_dofs']} DOFs. Edges are drawn straight between corners.",
        (Number("masters on the circle of the pads", "1", 60, found["ring_nodes"]),
         Number("elements", "1", 3909 + 91, found["cells"])))
    yield Entry(
        "5.10", "Pad velocity at several speeds", ("source_5_10.png",),
        f"The source is stable up to 4 pi and grows from 4.2 pi on, \"does not decay any more\"; the critical speed of our FE model, {critical:.4f} pi, lies between "
        f"the speeds {decays:.1f} pi and {grows:.1f} pi at which our simulations decay and grow. The rates are fitted to the envelopes.",
        (Number("critical speed over pi; the source simulates at 4 (it decays) and 4.2 (it does not)", "rad/s", 4.2, critical),))
    yield Entry(
        "5.9, 5.11", "The way to the limit cycle at 6 pi", ("source_5_11.png",),
        "The source reads \"from about 4.5 s on\" from its figure. Ours is the time from which the envelope is within 1 % of its last value; it depends on the logarithm "
        "of the first displacement of the pads, which is that of the source, 6.8e-8 m.",
        (Number("frequency of the limit cycle", "Hz", 1696.0, cycle_Hz),
         Number("time at which the limit cycle is reached", "s", 4.5, settled)))
