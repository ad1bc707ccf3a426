"""Three mechanisms on one flexible disc: coupled modes, falling friction, stick and slip of a pad.

Usage: on_the_disc.py SQUEAL_PROGRAM BODY_FILE OUTPUT_DIR [FIGURE_DIR]

BODY_FILE is the body of ../thesis_disc (`chladni run scene.toml`). Its pads get plates of 0.3 kg that
can also move along the disc, on springs. For three friction laws the script draws the largest growth
rate over the rotation speed, the speed of sliding of the upper pad in a transient at a low and at a high
speed, and writes what it found to mechanisms_on_the_disc.json.
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

SCENE = Path(__file__).parents[1] / "thesis_disc/scene.toml"
RADIUS, EPS = 0.13, 2e-3
PAD = (
    "[{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0, body = { mass = 0.3, "
    "tangential = { stiffness = 2e6, damping = 40.0 } } }]"
)
LAWS = {
    "constant, 0.6": f"{{ kinetic = 0.6, regularisation = {EPS} }}",
    "0.6, rising to 0.8 at rest": "{ kinetic = 0.6, static = 0.8, decay_speed = 0.3, "
    f"regularisation = {EPS} }}",
    "0.1, rising to 0.3 at rest": "{ kinetic = 0.1, static = 0.3, decay_speed = 0.3, "
    f"regularisation = {EPS} }}",
}
LOW, HIGH = 1.0, 30.0  # rad/s
COLOURS = ("#2166ac", "#b2182b", "#e08214")
LINES = ("-", "--", "-")  # two of the curves lie on each other where friction does not fall


def set_key(scene, key, value):
    """The scene with its first line `key = ...` replaced; `name` stands again at the hub."""
    lines = scene.splitlines()
    at = [i for i, line in enumerate(lines) if line.startswith(key + " = ")]
    assert at, f"{key} must stand in {SCENE}"
    lines[at[0]] = f"{key} = {value}"
    return "\n".join(lines) + "\n"


def run(program, body, folder, name, changes):
    scene = SCENE.read_text()
    for key, value in ({"pads": PAD, "contact": '"unilateral"'} | changes).items():
        scene = set_key(scene, key, value)
    file = folder / f"{name}.toml"
    file.write_text(set_key(scene, "name", f'"{name}"'))
    summary = folder / f"{name}.json"
    subprocess.run(
        [program, "run", file, "--body", body, "--output", folder, "--json", summary],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return json.loads(summary.read_text()), folder / f"{name}.squeal.h5"


def growth_over_speed(start, i, law):
    changes = {
        "friction": law,
        "analyses": '["eigenvalues"]',
        "speeds": "{ from_rad_s = 0.5, to_rad_s = 40.0, count = 160 }",
    }
    summary, _ = run(*start, f"growth_{i}", changes)
    rows = summary["eigenvalues"]
    return (
        np.array([row["speed_rad_s"] for row in rows]),
        np.array([max(re for re, _ in row["lambda"]) for row in rows]),
    )


def ranges(speeds, unstable):
    """[first, last] of each range of neighbours among the speeds at which it is."""
    ends = np.flatnonzero(np.diff(np.concatenate(([0], unstable.astype(int), [0]))))
    return [[float(speeds[i]), float(speeds[j - 1])] for i, j in ends.reshape(-1, 2)]


def sliding(start, i, case):
    """The last hundredth of a second: times and speeds of sliding of the upper pad."""
    law, speed = case
    # A pad that sticks is a damper of mu N_0 / EPS: stiff.
    how = (
        'duration_s = 0.25, initial_pad_displacement = 1e-7, integrator = "generalised-alpha", '
        "steps_per_period = 80"
        if speed == LOW
        else "duration_s = 2.0, initial_pad_displacement = 2e-4"
    )
    changes = {
        "friction": law,
        "analyses": '["transient"]',
        "transient": f"{{ speed_rad_s = {speed}, {how} }}",
    }
    _, file = run(*start, f"motion_{i}_{speed:.0f}", changes)
    with h5py.File(file) as results:
        tail = results["transient/tail"]
        t, slip = tail["t"][:], tail["slip_speed"][:]
        velocity = np.abs(tail["pad_velocity"][:]).max()
        integrator = results["transient/integrator"].asstr()[()]
    last = t > t[-1] - 0.01
    return t[last] - t[last][0], slip[last], velocity, integrator


def motion_of(slip, speed):
    """In words: what the pad does to the disc."""
    swing = 0.5 * (slip.max() - slip.min()) / (RADIUS * speed)
    if np.mean(slip < 3.0 * EPS) > 0.05:
        return "sticks and slips"
    return "slides" if swing < 0.02 else "vibrates while it slides"


def main(program, body, folder, figure_folder):
    folder.mkdir(parents=True, exist_ok=True)
    start, found = (program, body, folder), []
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.2), layout="constrained")
    for i, (name, law) in enumerate(LAWS.items()):
        speeds, growth = growth_over_speed(start, i, law)
        axes[0].plot(speeds, growth, LINES[i], color=COLOURS[i], label=name)
        row = {"friction": name, "unstable_rad_s": ranges(speeds, growth > 1e-2)}
        for ax, speed in zip(axes[1:], (LOW, HIGH)):
            t, slip, velocity, integrator = sliding(start, i, (law, speed))
            ax.plot(1e3 * t, slip / (RADIUS * speed), LINES[i], color=COLOURS[i], lw=1.0)
            row[f"at_{speed:.0f}_rad_s"] = {
                "motion": motion_of(slip, speed),
                "part_of_time_sticking": float(np.mean(slip < 3.0 * EPS)),
                "pad_velocity_m_s": float(velocity),
                "integrator": integrator,
            }
        found.append(row)
    axes[0].axhline(0.0, color="#666666", lw=0.8)
    axes[0].set(xlabel="speed, rad/s", ylabel="largest growth rate, 1/s")
    axes[0].set_yscale("symlog", linthresh=1.0)
    axes[0].legend(title="friction coefficient", frameon=False, fontsize=8, title_fontsize=8)
    for ax, speed in zip(axes[1:], (LOW, HIGH)):
        ax.set(xlabel="time, ms", ylabel="sliding / speed of the disc",
               title=f"at {speed:.0f} rad/s", ylim=(0.0, None))  # fmt: skip
    for ax in axes:
        ax.grid(color="#e4e4e4", lw=0.6)
        ax.spines[["top", "right"]].set_visible(False)
    for target in filter(None, (folder, figure_folder)):
        figure.savefig(target / "mechanisms_on_the_disc.png", dpi=130)
    (folder / "mechanisms_on_the_disc.json").write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]), Path(sys.argv[4]) if len(sys.argv) > 4 else None)
