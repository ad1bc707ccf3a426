"""A thousand variants of a brake in processes of their own, and where they squeal.

Usage: stability_map.py [PICTURE.png] [NUMBER OF FRICTIONS] [NUMBER OF STIFFNESSES]
"""

import sys
import time
from pathlib import Path

import numpy as np

import chladni


def main(picture=None, n_frictions=40, n_stiffnesses=25):
    rigid = chladni.Scene.read(Path(__file__).parents[1] / "rigid_disc/scene.toml").with_keys(
        {"squeal.analyses": ["critical-speed"], "squeal.growth": None, "squeal.transient": None}
    )
    frictions, stiffnesses = np.linspace(0.2, 0.8, int(n_frictions)), np.linspace(3e6, 1e7, int(n_stiffnesses))
    grid = [(mu, k) for k in stiffnesses for mu in frictions]
    start = time.perf_counter()
    critical = np.full(len(grid), np.nan)
    for i, result in enumerate(
        chladni.sweep(rigid, ({"squeal.friction": mu, "squeal.pads[0].stiffness": k} for mu, k in grid))
    ):
        if isinstance(result, Exception):
            raise result
        if "speed" in result.critical:  # else it is stable in the whole range
            critical[i] = result.critical.speed
    critical = critical.reshape(len(stiffnesses), len(frictions))
    print(f"{len(grid)} variants in {time.perf_counter() - start:.1f} s, {np.isfinite(critical).mean():.0%} of them squeal")
    print("lowest critical speed:", np.nanmin(critical).round(3), "rad/s")
    if picture:
        draw(picture, frictions, stiffnesses, critical)


def draw(picture, frictions, stiffnesses, critical):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots()
    colours = axes.pcolormesh(frictions, stiffnesses / 1e6, critical, shading="nearest")
    axes.set(xlabel="friction", ylabel="stiffness of a pad, MN/m", title="Critical speed; white: stable")
    figure.colorbar(colours, label="rad/s")
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":  # processes of the sweep read this file again
    main(*sys.argv[1:])
