"""Figures 2.1 to 2.3 of the source are drawings of three minimal models; here is where each of them squeals.

The scenes examples/two_masses (Shin et al.), examples/oscillator (Popp et al.) and examples/tilting_block (Brommundt):
growth rates over the velocity of the surface or over the friction, beside the limits in closed form.
"""

import h5py
import numpy as np

from drawing import BLUE, GREY, ORANGE, RED, plt, save
from studies import ROOT, Entry, Number, replaced, run

RADIUS = 0.13  # of the surface in all three scenes, m


def law(text):
    """mu(v) of the table `friction` of a scene, and its slope."""
    import tomllib
    friction = tomllib.loads(text)["squeal"]["friction"]
    mu, rise, v_s = friction["kinetic"], friction["static"] - friction["kinetic"], friction["decay_speed"]
    return (lambda v: mu + rise * np.exp(-v / v_s)), (lambda v: -rise / v_s * np.exp(-v / v_s))


def growth_over_speed(programs, folder, name):
    """Largest growth rate over the velocity of the surface, and the intervals of it in which sliding is unstable."""
    text = (ROOT / f"examples/{name}/scene.toml").read_text()
    text = replaced(text, r"analyses = .*", 'analyses = ["eigenvalues", "critical-speed"]')
    run(programs / "squeal", "run", folder, text)
    with h5py.File(folder / f"{name}.squeal.h5") as file:
        found = {"V": (RADIUS * file["eigenvalues/speeds"][:]).tolist(), "growth": file["eigenvalues/lambda_re"][:].max(1).tolist()}
        edges = file["critical/unstable"]
        return {**found, "from": (RADIUS * edges["from/values"][:]).tolist(), "to": (RADIUS * edges["to/values"][:]).tolist()}


def growth_over_friction(programs, folder, name):
    """Largest growth rate over the friction at one speed, and the friction at which stability is lost."""
    text = (ROOT / f"examples/{name}/scene.toml").read_text()
    text = replaced(text, r"growth = .*\n", "")
    text = replaced(text, r"analyses = .*", 'analyses = ["stability-map", "critical-values"]\n'
                    'map = { parameter = "friction", from = 0.01, to = 0.6, count = 119 }\n'
                    'critical = [{ parameter = "friction", speed_rad_s = 20.0, from = 0.01, to = 0.6 }]')
    run(programs / "squeal", "run", folder, text)
    with h5py.File(folder / f"{name}.squeal.h5") as file:
        group = file["stability_map"]
        return {"friction": group["values"][:].tolist(), "growth": group["growth"][:, len(group["speeds"]) // 2].tolist(),
                "critical": float(file["critical_values/1/value"][()])}


def study(programs, folder):
    return {"two_masses": growth_over_speed(programs, folder / "two_masses", "two_masses"),
            "tilting_block": growth_over_speed(programs, folder / "tilting_block", "tilting_block"),
            "oscillator": growth_over_friction(programs, folder / "oscillator", "oscillator")}


def draw_law(ax, name, V):
    mu, _ = law((ROOT / f"examples/{name}/scene.toml").read_text())
    ax.plot(V, mu(np.array(V)), color=ORANGE)
    ax.set(ylim=(0, None), ylabel=r"$\mu(V)$")


def draw(found, path):
    figure, axes = plt.subplots(2, 3, figsize=(10, 4.6), height_ratios=(0.6, 1))
    for j, name in ((0, "two_masses"), (2, "tilting_block")):
        one = found[name]
        draw_law(axes[0, j], name, one["V"])
        axes[1, j].plot(one["V"], one["growth"], color=RED)
        axes[1, j].set(xlabel="velocity of the surface in m/s")
        for V in set(one["from"] + one["to"]) - {one["V"][0], one["V"][-1]}:
            axes[1, j].axvline(V, color=BLUE, linewidth=0.8, linestyle=":")
    one = found["oscillator"]
    axes[1, 1].plot(one["friction"], one["growth"], color=RED)
    axes[1, 1].axvline(one["critical"], color=BLUE, linewidth=0.8, linestyle=":")
    axes[1, 1].set(xlabel=r"constant $\mu$")
    axes[0, 1].set_axis_off()
    for ax, title in zip((axes[0, 0], axes[1, 1], axes[0, 2]), ("Shin et al., falling friction", "Popp et al., constant friction", "Brommundt, rising friction")):
        ax.set_title(title)
    for ax in axes[1]:
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.set_ylabel("largest growth rate in 1/s")
    save(figure, path)


def closed_form():
    """V up to which N_0 |mu'(V)| exceeds d_1 d_2 / (d_1 + d_2) of the two masses."""
    import tomllib
    scene = tomllib.loads((ROOT / "examples/two_masses/scene.toml").read_text())["squeal"]
    m, friction = scene["two_masses"], scene["friction"]
    limit = m["pad_damping"] * m["disc_damping"] / (m["pad_damping"] + m["disc_damping"])
    rise, v_s = friction["static"] - friction["kinetic"], friction["decay_speed"]
    return -v_s * np.log(limit * v_s / (m["preload"] * rise))


def entries(found, figures):
    draw(found, figures / "source_2_1.png")
    two, tilting = found["two_masses"], found["tilting_block"]
    V = tilting["from"][0]
    mu, slope = law((ROOT / "examples/tilting_block/scene.toml").read_text())
    yield Entry(
        "2.1, 2.2, 2.3", "The minimal models of chapter 2", ("source_2_1.png",),
        "The source shows drawings of them. Here are [models of these kinds](../explanation/rigid_disc.md#a-still-smaller-model) with parameters of ours. Falling friction alone makes pad and disc unstable below the velocity "
        f"at which its slope is that of the dampers in series, {closed_form():.4f} m/s by the closed form without the regularisation of the scene. With constant friction two modes of one mass "
        f"couple. The tilting block squeals from {V:.3f} m/s on, where the coefficient is {mu(V):.3f} and still rises by {slope(V):.3f} s/m.",
        (Number("two masses: velocity below which they squeal", "m/s", None, two["to"][-1]),
         Number("oscillator: friction above which it squeals", "1", None, found["oscillator"]["critical"]),
         Number("tilting block: velocity above which it squeals", "m/s", None, V)))
