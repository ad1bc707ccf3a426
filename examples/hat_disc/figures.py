"""Draws the first modes of a body. Usage: figures.py OUTPUT_DIR

Reads the *.body.h5 in OUTPUT_DIR and writes modes.png beside it.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection


def draw_mode(ax, body, mode):
    """The surface, displaced by a mode and coloured by the size of its displacement."""
    x = body["picture/positions"][:]
    cells = body["picture/cells"][:]
    u = body["picture/displacements"][:, mode].reshape(-1, 3)
    u /= np.abs(u).max()
    size = np.abs(x).max()
    faces = Poly3DCollection((x + 0.15 * size * u)[cells], linewidths=0.1, edgecolors="#00000030")
    faces.set_facecolor(plt.cm.viridis(np.linalg.norm(u[cells], axis=2).mean(axis=1)))
    ax.add_collection3d(faces)
    ax.set(xlim=(-size, size), ylim=(-size, size), zlim=(-0.2 * size, 0.5 * size))
    ax.set_box_aspect((1, 1, 0.35), zoom=1.35)
    ax.view_init(elev=40, azim=-70)
    ax.set_axis_off()
    ax.set_title(f"mode {mode + 1}, {body['modes/frequencies'][mode] / (2 * np.pi):.1f} Hz", size=9)


def main(folder):
    fig = plt.figure(figsize=(10, 5.4), layout="constrained")
    with h5py.File(next(folder.glob("*.body.h5"))) as body:
        for place, mode in enumerate((0, 1, 3, 4, 6, 8), start=1):
            draw_mode(fig.add_subplot(2, 3, place, projection="3d"), body, mode)
    fig.savefig(folder / "modes.png", dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
