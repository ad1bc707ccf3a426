"""Compares what makes one and the same disc squeal: coupled modes, or friction that falls with speed.

Usage: compare.py SQUEAL_PROGRAM OUTPUT_DIR [FIGURE_DIR [SECONDS]]

Runs the rigid disc of ../rigid_disc with three friction laws, and draws the largest growth rate over
the rotation speed and the motion of the pad in transients of so many seconds (12) at a low and at a high speed.
"""

import json
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np

SCENE = Path(__file__).parents[1] / "rigid_disc/scene.toml"
EPS = 1e-3
LAWS = {
    "constant, 0.6": f"{{ kinetic = 0.6, regularisation = {EPS} }}",
    "0.6, rising to 0.8 at rest": "{ kinetic = 0.6, static = 0.8, decay_speed = 0.5, "
    f"regularisation = {EPS} }}",
    "0.1, rising to 0.3 at rest": "{ kinetic = 0.1, static = 0.3, decay_speed = 0.5, "
    f"regularisation = {EPS} }}",
}
LOW, HIGH = 1.0, 60.0  # rad/s
COLOURS = ("#2166ac", "#b2182b", "#e08214")


def set_key(scene, key, value):
    """The scene with one line `key = ...` replaced."""
    lines = scene.splitlines()
    at = [i for i, line in enumerate(lines) if line.startswith(key + " = ")]
    assert len(at) == 1, f"{key} must stand once in {SCENE}"
    lines[at[0]] = f"{key} = {value}"
    return "\n".join(lines) + "\n"


def run(program, folder, name, changes):
    scene = SCENE.read_text()
    for key, value in changes.items():
        scene = set_key(scene, key, value)
    file = folder / f"{name}.toml"
    file.write_text(set_key(scene, "name", f'"{name}"'))
    summary = folder / f"{name}.json"
    subprocess.run(
        [program, "run", file, "--output", folder, "--json", summary],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return json.loads(summary.read_text()), folder / f"{name}.squeal.h5"


def growth_over_speed(program, folder, i, law):
    changes = {
        "friction": law,
        "analyses": '["eigenvalues"]',
        "speeds": "{ from_rad_s = 0.5, to_rad_s = 62.8, count = 200 }",
    }
    summary, _ = run(program, folder, f"growth_{i}", changes)
    rows = summary["eigenvalues"]
    return (
        np.array([row["speed_rad_s"] for row in rows]),
        np.array([max(re for re, _ in row["lambda"]) for row in rows]),
    )


def motion(program, folder, i, case):
    law, speed, seconds = case
    changes = {
        "friction": law,
        "contact": '"unilateral"',
        "analyses": '["transient"]',
        "transient": f"{{ speed_rad_s = {speed}, duration_s = {seconds}, "
        "initial_pad_displacement = 3e-4, steps_per_period = 40 }",
    }
    _, file = run(program, folder, f"motion_{i}_{speed:.0f}", changes)
    with h5py.File(file) as results:
        envelope = results["transient/envelope"]
        return envelope["t"][:], envelope["pad_velocity"][:]


def main(program, folder, figure_folder, seconds):
    folder.mkdir(parents=True, exist_ok=True)
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.2), layout="constrained")
    for i, (name, law) in enumerate(LAWS.items()):
        speeds, growth = growth_over_speed(program, folder, i, law)
        left.plot(speeds, growth, color=COLOURS[i], label=name)
        for ax, speed in ((middle, LOW), (right, HIGH)):
            t, v = motion(program, folder, i, (law, speed, seconds))
            ax.semilogy(t, v, color=COLOURS[i])
    left.axhline(0.0, color="#666666", lw=0.8)
    left.set(xlabel="speed, rad/s", ylabel="largest growth rate, 1/s", ylim=(-2.0, 1.0))
    left.legend(title="friction coefficient", frameon=False, fontsize=8, title_fontsize=8)
    for ax, speed in ((middle, LOW), (right, HIGH)):
        ax.set(xlabel="time, s", ylabel="envelope of the pad velocity, m/s",
               title=f"at {speed:.0f} rad/s")  # fmt: skip
    for ax in (left, middle, right):
        ax.grid(color="#e4e4e4", lw=0.6)
        ax.spines[["top", "right"]].set_visible(False)
    for target in filter(None, (folder, figure_folder)):
        figure.savefig(target / "mechanisms.png", dpi=130)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]) if len(sys.argv) > 3 else None,
         float(sys.argv[4]) if len(sys.argv) > 4 else 12.0)  # fmt: skip
