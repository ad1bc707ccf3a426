"""Figures 5.14 to 5.16 of the source: the air around the squealing disc, surfaces of equal pressure, and spectra at two microphones.

Reads NAME.sound.h5 of `chladni sound` in the Fourier form: p(r, z, phi) = sum_n c_n(r, z) cos(n phi) + s_n(r, z) sin(n phi).
A mesh of one half, z > 0, has the other one by p(r, -z) = -p(r, z).
"""

import h5py
import numpy as np
from matplotlib.tri import LinearTriInterpolator, Triangulation
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from drawing import BLUE, GREY, ORANGE, RED, plt, save
from studies import Entry, Number, run

STEP, N_STEPS = 5e-5, 600  # s and 1: those of the source's acoustic simulation
LEVEL = 0.06  # of the surfaces, over the largest value
HALF = 0.6  # of the edge of the source's cube of air, m
REFERENCE = 20e-6  # Pa


class Field:
    """The first tone at the time of its largest pressure, on both sides of the disc."""

    def __init__(self, sound):
        self.density = sound["medium/density"][()]
        self.parts = []
        for n, group in sound["tones/1/meridian"].items():
            plane = Triangulation(*group["nodes"][:].T, group["triangles"][:])
            amplitudes = [group[f"{name}_re"][:] + 1j * group[f"{name}_im"][:] for name in ("cosine", "sine")]
            self.parts.append((int(n), plane, amplitudes))
        self.is_half = self.parts[0][1].y.min() > -1e-9
        largest = max((a[np.abs(a).argmax()] for _, _, both in self.parts for a in both), key=abs)
        self.turn = np.conj(largest) / abs(largest)

    def at(self, x, y, z):
        """Pa; not a number in the disc and beyond the mesh."""
        r, phi, above = np.hypot(x, y), np.arctan2(y, x), np.abs(z) if self.is_half else z
        p = np.zeros(np.shape(x))
        for n, plane, both in self.parts:
            for amplitude, wave in zip(both, (np.cos(n * phi), np.sin(n * phi))):
                p = p + LinearTriInterpolator(plane, (amplitude * self.turn).real)(r, above).filled(np.nan) * wave
        return np.where(z < 0, -p, p) if self.is_half else p


# A cube as six tetrahedra around its diagonal from corner 0 to corner 7; bit k of a corner's number is its step along axis k.
TETRAHEDRA = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])


def isosurface(axis, values, level):
    """Triangles [n x 3 x 3] on which a field on a cubic grid has this value, by marching tetrahedra."""
    corner = np.array([[i >> k & 1 for k in range(3)] for i in range(8)])
    first = np.stack(np.meshgrid(*[np.arange(len(axis) - 1)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    at = first + corner  # [cubes x 8 x 3]
    v = values[at[..., 0], at[..., 1], at[..., 2]] - level
    crossed = np.isfinite(v).all(1) & (v.min(1) < 0) & (v.max(1) >= 0)
    x, v = axis[at[crossed]][:, TETRAHEDRA].reshape(-1, 4, 3), v[crossed][:, TETRAHEDRA].reshape(-1, 4)
    inside = v >= 0
    triangles = []
    for count in (1, 2, 3):
        own = inside.sum(1) == count
        order = np.argsort(~inside[own], axis=1, kind="stable")  # those inside first
        xs, vs = np.take_along_axis(x[own], order[..., None], 1), np.take_along_axis(v[own], order, 1)
        cut = lambda i, j: xs[:, i] + (vs[:, i] / (vs[:, i] - vs[:, j]))[:, None] * (xs[:, j] - xs[:, i])
        if count == 2:
            a, b, c, d = cut(0, 2), cut(0, 3), cut(1, 3), cut(1, 2)
            triangles += [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
        else:
            alone, others = (0, (1, 2, 3)) if count == 1 else (3, (0, 1, 2))
            triangles.append(np.stack([cut(alone, j) for j in others], 1))
    return np.concatenate(triangles)


def draw_isosurfaces(field, path, quick):
    """The whole field, above and below the disc, and a section through it."""
    axis = np.linspace(-HALF, HALF, 50 if quick else 120)
    grid = np.meshgrid(axis, axis, axis, indexing="ij")
    psi_t = field.at(*grid) / field.density
    level = LEVEL * np.nanmax(np.abs(psi_t))
    figure = plt.figure(figsize=(10, 4.3), layout="none")
    ax = figure.add_axes((0.0, 0.03, 0.45, 0.9), projection="3d")
    for sign, colour in ((1, RED), (-1, BLUE)):
        triangles = isosurface(axis, psi_t, sign * level)
        normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        shade = 0.45 + 0.55 * np.abs(normal @ [0.4, -0.5, 0.77]) / np.maximum(np.linalg.norm(normal, axis=1), 1e-30)
        colours = np.clip(np.array([int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]) * shade[:, None] + 0.12, 0, 1)
        ax.add_collection3d(Poly3DCollection(triangles, facecolors=colours, linewidths=0))
    limits = (-HALF, HALF)
    ax.set(xlim=limits, ylim=limits, zlim=limits, xlabel="x in m", ylabel="y in m", zlabel="z in m")
    ax.set_title(rf"$\partial\psi/\partial t = \pm${level:.3g} m$^2$/s$^2$")
    ax.view_init(elev=22, azim=-55)
    ax.set_box_aspect((1, 1, 1))
    draw_section(figure.add_axes((0.54, 0.12, 0.4, 0.8)), field, level)
    save(figure, path)


def draw_section(ax, field, level):
    fine = np.linspace(-HALF, HALF, 301)
    x, z = np.meshgrid(fine, fine)
    angles = np.linspace(0, np.pi, 61)
    strength = [np.nanmax(np.abs(field.at(x[::8, ::8] * np.cos(a), x[::8, ::8] * np.sin(a), z[::8, ::8]))) for a in angles]
    a = angles[int(np.argmax(strength))]
    psi_t = field.at(x * np.cos(a), x * np.sin(a), z) / field.density
    colours = ax.pcolormesh(x, z, psi_t, cmap="RdBu_r", vmin=-5 * level, vmax=5 * level, shading="nearest")
    ax.contour(x, z, psi_t, levels=[-level, level], colors="black", linewidths=0.7)
    ax.figure.colorbar(colours, ax=ax, label=r"$\partial\psi/\partial t$ in m$^2$/s$^2$")
    ax.set(aspect="equal", xlabel=f"distance along {np.degrees(a):.0f}° in m", ylabel="z in m", title="section where it is loudest")
    ax.grid(False)


def draw_air(sound, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 4))
    group = next(iter(sound["tones/1/meridian"].values()))
    r, z = group["nodes"][:].T
    for ax, limits in zip(axes, ((0, r.max()), (0.145, 0.175))):
        ax.triplot(Triangulation(r, z, group["triangles"][:]), color=GREY, linewidth=0.3)
        ax.set(aspect="equal", xlabel="r in m", ylabel="z in m", xlim=limits)
        ax.grid(False)
    axes[0].set(ylim=(z.min(), z.max()), title="air inside the absorbing layer")
    axes[1].set(ylim=(0, 0.03), title="at the rim of the disc")
    save(figure, path)


def spectrum(sound, microphone):
    """Frequencies (Hz) and amplitudes (Pa) of the pressure over the time of the source's simulation, Hann window."""
    t = STEP * np.arange(N_STEPS)
    amplitudes = sound["microphones/pressure_re"][microphone] + 1j * sound["microphones/pressure_im"][microphone]
    f = sound["frequency"][()]
    p = sum((P * np.exp(2j * np.pi * f * h * t)).real for h, P in enumerate(amplitudes, 1))
    window = np.hanning(N_STEPS)
    padded = 8 * N_STEPS  # lines eight times as dense as the window is long
    return np.fft.rfftfreq(padded, STEP), 2 * np.abs(np.fft.rfft(p * window, padded)) / window.sum()


def peak(f, p):
    """Frequency and amplitude of the largest peak, of the parabola through its three lines."""
    i = int(p.argmax())
    before, at, after = p[i - 1:i + 2]
    shift = 0.5 * (before - after) / (before - 2 * at + after)
    return float(f[i] + shift * (f[1] - f[0])), float(at - 0.25 * (before - after) * shift)


def draw_spectra(sound, path):
    figure, ax = plt.subplots(figsize=(6, 3.4))
    names = sound["microphones/names"].asstr()[:]
    for i, colour in ((0, RED), (1, BLUE)):
        ax.plot(*spectrum(sound, i), color=colour, label=names[i])
    ax.axvline(1700.0, color=ORANGE, linewidth=0.9, linestyle=":")
    ax.set(xlim=(0, 6000), xlabel="frequency in Hz", ylabel="amplitude in Pa", ylim=(0, None))
    ax.legend()
    save(figure, path)


def level_dB(pressure):
    return 20 * np.log10(pressure / REFERENCE)


def study(programs, folder):
    """The sound of the disc whose results lie in `folder`."""
    return run(programs / "chladni", "sound", folder)


def numbers_of(sound):
    """The peak at each microphone against the source's; positions of its microphones are in a figure only."""
    for i, pressure, level in ((0, 230.0, 141.0), (1, 380.0, 145.0)):
        f, p = peak(*spectrum(sound, i))
        name = f"MIC_{i + 1}"
        yield Number(f"{name}, frequency of the peak", "Hz", 1700.0, f)
        yield Number(f"{name}, amplitude of the pressure", "Pa", pressure, p)
        yield Number(f"{name}, level of the amplitude", "dB", level, float(level_dB(p)))


def entries(folder, figures, quick):
    with h5py.File(folder / "disc.sound.h5") as sound:
        field = Field(sound)
        draw_air(sound, figures / "source_5_14.png")
        draw_isosurfaces(field, figures / "source_5_15.png", quick)
        draw_spectra(sound, figures / "source_5_16.png")
        unknowns, elements = (int(sound[f"tones/1/{name}"][()]) for name in ("unknowns", "elements"))
        numbers = tuple(numbers_of(sound))
        where = [tuple(round(float(c), 3) for c in x) for x in sound["microphones/positions"][:2]]
    yield Entry(
        "5.14", "Mesh of the air", ("source_5_14.png",),
        f"A disc that is symmetric about its axis needs the half plane only, one problem for each number of nodal diameters: {elements} elements of order 6 here. "
        "The source meshes the space with about 700,000 elements.",
        (Number("unknowns of the air", "1", 1.7e6, unknowns),))
    yield Entry(
        "5.15", "Surfaces of equal pressure", ("source_5_15.png",),
        "Both sides of the disc at the moment of the largest pressure; the time derivative of the potential is the pressure over the density of air. In the plane of the disc the "
        "source has \"almost no acoustic pressure\"; there it is zero here by symmetry. The air is as wide as the cube of the source, 1.2 m.")
    yield Entry(
        "5.16", "Spectra at the microphones", ("source_5_16.png",),
        f"The positions of the source's microphones stand in a figure alone; ours are at {where[0]} and {where[1]} m, those of the example, so the amplitudes can "
        "be compared in their order of magnitude only. Sampled as the source does, 600 steps of 5e-5 s, with a Hann window.",
        numbers)
