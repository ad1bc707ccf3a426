"""Draws the sound of a disc. Usage: sound_figures.py SCENE_OUTPUT_DIR [FIGURE_DIR]

Reads the *.sound.h5 in SCENE_OUTPUT_DIR; writes sound_field.png, sound_directivity.png and, when the
scene asks for further speeds, sound_levels.png, to FIGURE_DIR or beside it.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import LinearTriInterpolator, Triangulation

WITHOUT, WITH, GREY = "#b2182b", "#2166ac", "#666666"
plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titlelocation": "left",
        "legend.frameon": False,
        "figure.constrained_layout.use": True,
    }
)


def only_file(folder):
    found = sorted(Path(folder).glob("*.sound.h5"))
    if len(found) != 1:
        sys.exit(f"sound_figures.py: {len(found)} files *.sound.h5 in {folder}, expected one")
    return found[0]


class Meridian:
    """The first tone in the meridian plane: p(r, z, phi) of all circumferential harmonics."""

    def __init__(self, sound):
        self.parts = []
        for n, group in sound["tones/1/meridian"].items():
            plane = Triangulation(*group["nodes"][:].T, group["triangles"][:])
            cos = group["cosine_re"][:] + 1j * group["cosine_im"][:]
            sin = group["sine_re"][:] + 1j * group["sine_im"][:]
            self.parts.append((int(n), plane, cos, sin))

    def pressure(self, phi):
        """At the nodes of the plane at the angle phi."""
        return sum(c * np.cos(n * phi) + s * np.sin(n * phi) for n, _, c, s in self.parts)

    def plane(self):
        return self.parts[0][1]

    def at(self, r, z, phi):
        """Interpolated; not a number in the body."""
        p = np.zeros(r.shape, complex)
        for n, plane, cos, sin in self.parts:
            for amplitude, wave in ((cos, np.cos(n * phi)), (sin, np.sin(n * phi))):
                re = LinearTriInterpolator(plane, amplitude.real)(r, z)
                im = LinearTriInterpolator(plane, amplitude.imag)(r, z)
                p += (re.filled(np.nan) + 1j * im.filled(np.nan)) * wave
        return p


def loudest_angle(field):
    """Where the field is strongest around the axis."""
    angles = np.linspace(0, np.pi, 181)
    return angles[np.argmax([np.abs(field.pressure(a)).max() for a in angles])]


def draw_section(ax, field, phi, limit):
    """Real part of the pressure in the half plane at phi, and its opposite below."""
    plane, p = field.plane(), field.pressure(phi).real
    half = plane.y.min() > -1e-9
    for sign in (1, -1) if half else (1,):
        mirrored = Triangulation(plane.x, sign * plane.y, plane.triangles)
        colours = ax.tripcolor(
            mirrored, sign * p, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="gouraud"
        )
    ax.set(aspect="equal", xlabel="r in m", ylabel="z in m")
    ax.set_title("pressure in the meridian plane in Pa")
    return colours


def draw_plane(ax, field, z, limit):
    """Real part of the pressure at the height z."""
    R = np.hypot(field.plane().x, field.plane().y).max()
    x = np.linspace(-R, R, 401)
    X, Y = np.meshgrid(x, x)
    r = np.hypot(X, Y)
    p = field.at(r, np.full_like(r, z), np.arctan2(Y, X)).real
    p[np.hypot(r, z) > 0.995 * R] = np.nan
    colours = ax.pcolormesh(X, Y, p, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="nearest")
    ax.set(aspect="equal", xlabel="x in m", ylabel="y in m")
    ax.set_title(f"in the plane {1e3 * z:.0f} mm above the middle of the disc")
    return colours


def draw_field(sound, path):
    field = Meridian(sound)
    phi = loudest_angle(field)
    limit = 0.6 * np.abs(field.pressure(phi)).max()
    figure, axes = plt.subplots(1, 2, figsize=(8.5, 4), width_ratios=(0.62, 1))
    draw_section(axes[0], field, phi, limit)
    colours = draw_plane(axes[1], field, 0.05, limit)
    figure.colorbar(colours, ax=axes, label="Pa", extend="both")
    save(figure, path)


def draw_directivity(sound, path):
    """Level at 1 m if it were far away, over the polar angle at the loudest and quietest azimuth."""
    theta, phi = sound["directivity/polar"][:], sound["directivity/azimuth"][:]
    rms = sound["directivity/rms"][:]
    level = 20 * np.log10(np.maximum(rms, 1e-12) / 20e-6)
    figure, axes = plt.subplots(1, 2, figsize=(8, 4), subplot_kw={"projection": "polar"})
    strength = (rms**2).sum(axis=0)
    bottom = level.max() - 40
    for i, colour, name in (
        (strength.argmax(), WITHOUT, "loudest"),
        (strength.argmin(), WITH, "quietest"),
    ):
        both = np.concatenate([theta, 2 * np.pi - theta[::-1]])
        line = np.maximum(np.concatenate([level[:, i], level[::-1, i]]), bottom)
        axes[0].plot(both, line, color=colour, label=f"{name} azimuth, {np.degrees(phi[i]):.0f}°")
    axes[0].set_theta_zero_location("N")
    axes[0].set_title("dB at 1 m over the angle from the axis", pad=16)
    axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, -0.28))
    row = (rms**2).sum(axis=1).argmax()
    closed = np.append(phi, phi[0] + 2 * np.pi)
    axes[1].plot(closed, np.append(level[row], level[row, 0]), color=GREY)
    axes[1].set_title(f"dB at 1 m over the azimuth, {np.degrees(theta[row]):.0f}° from the axis", pad=16)
    for ax in axes:
        ax.set_rlim(bottom, level.max() + 1)
        ax.set_rlabel_position(22)
    save(figure, path)


def draw_levels(sound, path):
    """Level at the first microphone and radiated power over the speed."""
    figure, axes = plt.subplots(1, 2, figsize=(8, 3.3))
    for name, colour, label in (
        ("without_radiation", WITHOUT, "without radiation damping"),
        ("with_radiation", WITH, "with radiation damping"),
    ):
        group = sound[f"loudness/{name}"]
        if group["speeds"].size == 0:
            continue
        speed = group["speeds"][:] / np.pi
        axes[0].plot(speed, group["levels"][:, 0], "o-", ms=3, color=colour, label=label)
        axes[1].plot(speed, group["power"][:], "o-", ms=3, color=colour)
    microphone = sound["microphones/names"].asstr()[0]
    axes[0].set(ylabel=f"level at {microphone} in dB")
    axes[1].set(ylabel="radiated power in W")
    axes[0].legend()
    for ax in axes:
        ax.set(xlabel=r"rotation speed / $\pi$ in rad/s")
        ax.grid(color="#e4e4e4", linewidth=0.6)
        ax.spines[["top", "right"]].set_visible(False)
    save(figure, path)


def save(figure, path):
    figure.savefig(path, dpi=130)
    plt.close(figure)
    print(path)


def main(folder, figures):
    figures.mkdir(parents=True, exist_ok=True)
    with h5py.File(only_file(folder)) as sound:
        if "tones/1/meridian" in sound:
            draw_field(sound, figures / "sound_field.png")
        draw_directivity(sound, figures / "sound_directivity.png")
        if "loudness" in sound:
            draw_levels(sound, figures / "sound_levels.png")


if __name__ == "__main__":
    folders = [Path(name) for name in sys.argv[1:]]
    main(folders[0], folders[-1])
